//! See `pulloff_fuzz::csv`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| pulloff_fuzz::csv(bytes));
