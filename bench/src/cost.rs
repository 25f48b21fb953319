//! CPU time, allocations and peak memory of this process.

use crate::twin;
use cpu_time::ProcessTime;

/// Measures CPU time and allocations since its start.
#[derive(Clone, Copy)]
pub struct Meter {
    cpu: ProcessTime,
    allocations: usize,
}

impl Meter {
    /// Starts a measurement.
    pub fn start() -> Self {
        Self { cpu: ProcessTime::now(), allocations: allocations() }
    }

    /// Returns the CPU seconds of all threads since the start.
    pub fn cpu(&self) -> f64 {
        self.cpu.elapsed().as_secs_f64()
    }

    /// Returns the allocations since the start, or 0 if this process is not the [`twin`].
    pub fn allocations(&self) -> usize {
        allocations() - self.allocations
    }
}

fn allocations() -> usize {
    let counted = twin::allocations();
    counted.new + counted.resized
}

/// Returns the peak memory of this process in MiB, or `NaN` if the system does not report it.
pub fn peak_memory() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kilobytes = line.and_then(|line| line.split_whitespace().next()?.parse::<f64>().ok());
    kilobytes.map_or(f64::NAN, |kilobytes| kilobytes / 1024.0)
}
