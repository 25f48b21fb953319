//! Settings from environment variables.

use crate::fault::Fault;

/// Returns the number in an environment variable, or `default` if the variable is not set.
pub fn number(name: &str, default: usize) -> Result<usize, Fault> {
    match std::env::var(name) {
        Ok(text) => text
            .parse()
            .map_err(|_| format!("{name} is no number: {text}").into()),
        Err(_) => Ok(default),
    }
}
