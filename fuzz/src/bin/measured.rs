//! See `pulloff_fuzz::measured`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| pulloff_fuzz::measured(bytes));
