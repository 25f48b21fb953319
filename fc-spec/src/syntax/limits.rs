//! How much a spec may be. Nothing is read, kept or nested beyond these; each has its own fault.

/// Longest file, in bytes.
pub const FILE_BYTES: usize = 8 << 20;
/// Longest spec, all files together, in bytes.
pub const SPEC_BYTES: usize = 64 << 20;
/// Most files.
pub const FILES: usize = 1024;
/// Deepest nesting of mappings and lists.
pub const DEPTH: usize = 64;
/// Longest scalar, in bytes of its text.
pub const SCALAR_BYTES: usize = 1 << 20;
/// Most nodes of one file.
pub const NODES: usize = 2_000_000;
