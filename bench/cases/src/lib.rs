//! What is measured: messages of three sizes, their frames for all languages, and specs of any size.

pub mod frames;
pub mod messages;
pub mod synthetic;
