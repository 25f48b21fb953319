#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| fc_fuzz::decode(data));
