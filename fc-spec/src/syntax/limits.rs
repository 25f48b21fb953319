//! The limits of a spec. Larger input is not read or kept, and each limit has its own error.

/// The maximum size of a file, in bytes.
pub const FILE_BYTES: usize = 8 << 20;
/// The maximum size of all files together, in bytes.
pub const SPEC_BYTES: usize = 64 << 20;
/// The maximum number of files.
pub const FILES: usize = 1024;
/// The maximum nesting of mappings and lists.
pub const DEPTH: usize = 64;
/// The maximum length of a scalar's text, in bytes.
pub const SCALAR_BYTES: usize = 1 << 20;
/// The maximum number of nodes in a file.
pub const NODES: usize = 2_000_000;
