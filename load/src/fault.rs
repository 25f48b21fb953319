//! What can go wrong while measuring.

use std::error::Error;

/// Whatever keeps a measurement from going on.
pub type Fault = Box<dyn Error + Send + Sync>;
