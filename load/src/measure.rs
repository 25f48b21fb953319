//! Memory of processes, a description of the machine, and quantiles.

use crate::fault::Fault;
use std::time::Duration;

/// Returns the resident memory of a process, in KiB.
pub fn resident(process: u32) -> Result<usize, Fault> {
    memory(process, "VmRSS:")
}

/// Returns the largest resident memory of a process since the last [`forget_peak`], in KiB.
pub fn peak(process: u32) -> Result<usize, Fault> {
    memory(process, "VmHWM:")
}

/// Resets the peak of a process to its current memory.
pub fn forget_peak(process: u32) -> Result<(), Fault> {
    Ok(std::fs::write(format!("/proc/{process}/clear_refs"), "5")?)
}

fn memory(process: u32, which: &str) -> Result<usize, Fault> {
    let status = std::fs::read_to_string(format!("/proc/{process}/status"))?;
    let line = status.lines().find_map(|line| line.strip_prefix(which));
    let text = line.and_then(|line| line.split_whitespace().next());
    Ok(text.ok_or_else(|| format!("no {which}"))?.parse()?)
}

/// Returns the number of cores and the load average, for the heading of a table.
pub fn machine() -> String {
    let cores = std::thread::available_parallelism().map_or(0, usize::from);
    let load = std::fs::read_to_string("/proc/loadavg").unwrap_or_default();
    let load = load.split_whitespace().next().unwrap_or("?").to_owned();
    format!("{cores} cores, load average {load}")
}

/// Sorts the times and returns the value below which `share` of them lie.
pub fn quantile(times: &mut [Duration], share: f64) -> Duration {
    times.sort_unstable();
    let index = (times.len() as f64 * share) as usize;
    times
        .get(index.min(times.len().saturating_sub(1)))
        .copied()
        .unwrap_or_default()
}
