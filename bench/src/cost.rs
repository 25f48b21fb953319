//! What a process has cost so far.

use crate::twin;
use cpu_time::ProcessTime;

/// CPU seconds and calls to the allocator since some start.
#[derive(Clone, Copy)]
pub struct Meter {
    cpu: ProcessTime,
    allocations: usize,
}

impl Meter {
    /// Starts now.
    pub fn start() -> Self {
        Self { cpu: ProcessTime::now(), allocations: allocations() }
    }

    /// CPU seconds of all threads since the start.
    pub fn cpu(&self) -> f64 {
        self.cpu.elapsed().as_secs_f64()
    }

    /// Allocations since the start; 0 unless this is the twin.
    pub fn allocations(&self) -> usize {
        allocations() - self.allocations
    }
}

fn allocations() -> usize {
    let counted = twin::allocations();
    counted.new + counted.resized
}

/// The most memory this process has held, in MiB.
pub fn peak_memory() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kilobytes = line.and_then(|line| line.split_whitespace().next()?.parse::<f64>().ok());
    kilobytes.map_or(f64::NAN, |kilobytes| kilobytes / 1024.0)
}
