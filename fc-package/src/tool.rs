//! Runs the tools of the ecosystems.

use crate::error::PackError;
use std::ffi::OsStr;
use std::io::ErrorKind;
use std::path::Path;
use std::process::Command;

/// The number of lines that an error quotes from a failed tool.
const QUOTED: usize = 30;

/// A program that builds packages.
pub struct Tool {
    /// The name of the program.
    pub name: &'static str,
    /// The command or page to get it.
    pub get: &'static str,
}

impl Tool {
    /// Runs the tool in a directory and returns its output.
    pub fn run<A: AsRef<OsStr>>(
        &self,
        directory: &Path,
        arguments: impl IntoIterator<Item = A>,
    ) -> Result<String, PackError> {
        let mut command = Command::new(self.name);
        self.finish(command.args(arguments).current_dir(directory))
    }

    /// Runs a prepared command of the tool and returns its output.
    pub fn finish(&self, command: &mut Command) -> Result<String, PackError> {
        let &Self { name, get } = self;
        let output = command.output().map_err(|error| match error.kind() {
            ErrorKind::NotFound => PackError::NoTool { name, get },
            _ => PackError::Tool { name, error },
        })?;
        let printed = String::from_utf8_lossy(&output.stdout);
        if output.status.success() {
            return Ok(printed.into_owned());
        }
        let errors = String::from_utf8_lossy(&output.stderr);
        let lines: Vec<&str> = printed.lines().chain(errors.lines()).collect();
        let lines = lines.get(lines.len().saturating_sub(QUOTED)..);
        let command = std::iter::once(command.get_program()).chain(command.get_args());
        let command: Vec<_> = command.map(OsStr::to_string_lossy).collect();
        Err(PackError::Failed {
            command: command.join(" "),
            lines: lines.unwrap_or_default().join("\n"),
        })
    }
}

/// Unpacks archives of npm, Python and Cargo.
const TAR: Tool = Tool {
    name: "tar",
    get: "apt install tar",
};

/// Unpacks a `.tar.gz` into an existing directory.
pub fn unpack(archive: &Path, into: &Path) -> Result<(), PackError> {
    TAR.run(into, ["-xzf".as_ref(), archive.as_os_str()])?;
    Ok(())
}
