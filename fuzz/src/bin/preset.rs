//! See `pulloff_fuzz::preset`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| pulloff_fuzz::preset(bytes));
