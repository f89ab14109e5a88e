//! See `pulloff_fuzz::script`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| pulloff_fuzz::script(bytes));
