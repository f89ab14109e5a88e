//! See `pulloff_fuzz::value`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| pulloff_fuzz::value(bytes));
