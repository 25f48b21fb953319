//! Runs git.

use std::path::Path;
use std::process::{Command, Stdio};

/// Runs git in a directory and returns its output. The error is the message for the user.
pub(crate) fn git(directory: &Path, arguments: &[&str]) -> Result<Vec<u8>, String> {
    let output = Command::new("git")
        .arg("-C")
        .arg(directory)
        .args(arguments)
        .stdin(Stdio::null())
        .output()
        .map_err(|error| error.to_string())?;
    if !output.status.success() {
        let why = String::from_utf8_lossy(&output.stderr);
        return Err(why.trim().trim_start_matches("fatal: ").to_owned());
    }
    Ok(output.stdout)
}
