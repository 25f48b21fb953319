//! The twin of the benchmark, which counts allocations. The benchmark builds and starts it.

use fc_bench::twin::{self, Allocations};
use stats_alloc::{INSTRUMENTED_SYSTEM, StatsAlloc};
use std::alloc::System;
use std::process::ExitCode;

#[global_allocator]
static ALLOCATOR: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

fn main() -> ExitCode {
    twin::install(|| {
        let stats = ALLOCATOR.stats();
        Allocations { new: stats.allocations, resized: stats.reallocations }
    });
    fc_bench::run()
}
