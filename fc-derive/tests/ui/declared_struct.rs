//! Errors are an enum with at least one variant.

use fc_derive::DeclaredError;

#[derive(Clone, Copy, Debug, DeclaredError)]
struct DriveError;

#[derive(Clone, Copy, Debug, DeclaredError)]
enum None {}

fn main() {}
