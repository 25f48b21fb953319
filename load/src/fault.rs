//! Errors of a measurement.

use std::error::Error;

/// Any error that ends a measurement.
pub type Fault = Box<dyn Error + Send + Sync>;
