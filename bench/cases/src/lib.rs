//! What is measured: messages of three sizes, and specs of any size.

pub mod messages;
pub mod synthetic;
