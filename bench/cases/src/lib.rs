//! The material of the benchmarks: messages of three sizes, their frames for all languages, and synthetic specs.

pub mod frames;
pub mod messages;
pub mod synthetic;
