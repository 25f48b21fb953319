//! What is said by variables of the environment.

use crate::fault::Fault;

/// The number that a variable says, if it is there.
pub fn number(name: &str, default: usize) -> Result<usize, Fault> {
    match std::env::var(name) {
        Ok(text) => text
            .parse()
            .map_err(|_| format!("{name} is no number: {text}").into()),
        Err(_) => Ok(default),
    }
}
