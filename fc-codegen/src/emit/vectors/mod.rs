//! Golden frames.
