//! The twin: a second program with the same code that counts allocations.
//!
//! Counting takes time, so the program that measures times must not count.

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

/// Sets the function that counts allocations. Only the twin calls this.
pub fn install(counter: fn() -> Allocations) {
    let _ = COUNTER.set(counter);
}

/// Returns the allocations of this process so far, or none if it is not the twin.
pub fn allocations() -> Allocations {
    COUNTER.get().map(|counter| counter()).unwrap_or_default()
}

/// Returns the path of the twin. The first call builds it.
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
