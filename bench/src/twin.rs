//! Allocations are counted by a twin of this program: counting costs time, and what is timed must not
//! pay for it.

use std::path::PathBuf;
use std::process::Command;
use std::sync::OnceLock;

static COUNTER: OnceLock<fn() -> Allocations> = OnceLock::new();
static TWIN: OnceLock<PathBuf> = OnceLock::new();

/// Calls to the allocator so far.
#[derive(Clone, Copy, Debug, Default)]
pub struct Allocations {
    /// New blocks.
    pub new: usize,
    /// Blocks made longer or shorter.
    pub resized: usize,
}

/// Says how the twin counts.
pub fn install(counter: fn() -> Allocations) {
    let _ = COUNTER.set(counter);
}

/// Allocations of this process so far; none unless it is the twin.
pub fn allocations() -> Allocations {
    COUNTER.get().map(|counter| counter()).unwrap_or_default()
}

/// The twin's program, built if need be.
pub fn program() -> PathBuf {
    TWIN.get_or_init(build).clone()
}

fn build() -> PathBuf {
    let cargo = std::env::var("CARGO").unwrap_or_else(|_| "cargo".to_owned());
    let manifest = concat!(env!("CARGO_MANIFEST_DIR"), "/Cargo.toml");
    let status = Command::new(cargo)
        .args(["build", "--quiet", "--release", "--manifest-path", manifest, "--bin", "counting"])
        .status()
        .expect("cargo runs");
    assert!(status.success(), "the program that counts allocations does not build");
    std::env::current_exe().expect("own path").with_file_name("counting")
}
