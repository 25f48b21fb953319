//! Fuzz targets of the FC tools. Each is a function from bytes to nothing that panics where a
//! promise is broken, so that libFuzzer, the fixtures and a debugger run the very same code.

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

/// What opens the line that names the next file of a spec.
pub const SEPARATOR: &str = "=== ";

/// A target: its name, which is also that of its corpus, and its function.
pub type Target = (&'static str, fn(&[u8]));

/// Every target.
pub const TARGETS: &[Target] = &[
    ("frames", frames),
    ("session", session),
    ("bodies", bodies),
    ("decode", decode),
    ("memory", memory),
    #[cfg(feature = "spec")]
    ("spec", spec),
];
