//! Fuzz targets of the FC tools.
//!
//! Each target is a function that takes bytes and panics if a promise is broken. libFuzzer, the fixtures and a debugger
//! all run the same function.

mod bodies;
mod decode;
mod frames;
mod input;
mod memory;
mod session;
#[cfg(feature = "spec")]
mod spec;

pub use bodies::{MESSAGES, bodies};
pub use decode::decode;
pub use frames::frames;
pub use memory::{COUNTING, memory};
pub use session::session;
#[cfg(feature = "spec")]
pub use spec::spec;

/// Start of a line that names the next file of a spec.
pub const SEPARATOR: &str = "=== ";

/// The name of a target, which is also the name of its corpus, and its function.
pub type Target = (&'static str, fn(&[u8]));

/// All targets.
pub const TARGETS: &[Target] = &[
    ("frames", frames),
    ("session", session),
    ("bodies", bodies),
    ("decode", decode),
    ("memory", memory),
    #[cfg(feature = "spec")]
    ("spec", spec),
];
