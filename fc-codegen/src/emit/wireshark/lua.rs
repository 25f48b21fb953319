//! Writes Lua tables and strings.

use std::fmt::{self, Display, Write as _};

/// A table with an entry per line.
pub(super) struct Table {
    depth: usize,
    text: String,
}

impl Table {
    /// Creates an empty table inside this number of tables.
    pub(super) fn new(depth: usize) -> Self {
        Self {
            depth,
            text: String::new(),
        }
    }

    /// Adds the next item of a list.
    pub(super) fn push(&mut self, value: impl Display) {
        let indent = "  ".repeat(self.depth + 1);
        // Writing to a String cannot fail.
        let _ = writeln!(self.text, "{indent}{value},");
    }

    /// Adds a key that is a Lua name.
    pub(super) fn set(&mut self, key: &str, value: impl Display) {
        self.push(format_args!("{key} = {value}"));
    }

    /// Adds a key that is a number.
    pub(super) fn set_number(&mut self, key: impl Display, value: impl Display) {
        self.push(format_args!("[{key}] = {value}"));
    }
}

impl Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.text.is_empty() {
            return f.write_str("{}");
        }
        write!(f, "{{\n{}{}}}", self.text, "  ".repeat(self.depth))
    }
}

/// Returns a string literal. Characters that could end it are escaped.
pub(super) fn quoted(text: &str) -> String {
    let mut out = String::from("\"");
    for character in text.chars() {
        match character {
            '"' | '\\' => {
                out.push('\\');
                out.push(character);
            }
            character if character.is_control() => {
                let mut buffer = [0; 4];
                for byte in character.encode_utf8(&mut buffer).bytes() {
                    let _ = write!(out, "\\{byte:03}");
                }
            }
            character => out.push(character),
        }
    }
    out.push('"');
    out
}

/// Returns a string literal of bytes.
pub(super) fn bytes(bytes: &[u8]) -> String {
    let escaped = bytes.iter().map(|byte| format!("\\{byte:03}"));
    format!("\"{}\"", escaped.collect::<String>())
}
