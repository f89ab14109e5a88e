//! See `pulloff_fuzz::formula`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| pulloff_fuzz::formula(bytes));
