//! From the model to artifacts.

pub mod markdown;
pub mod rust;
pub mod vectors;
