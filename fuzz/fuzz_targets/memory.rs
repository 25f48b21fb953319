#![no_main]

#[global_allocator]
static ALLOCATOR: peak_alloc::PeakAlloc = fc_fuzz::COUNTING;

libfuzzer_sys::fuzz_target!(|data: &[u8]| fc_fuzz::memory(data));
