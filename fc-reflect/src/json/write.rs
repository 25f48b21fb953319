//! The canonical text of values.

use std::fmt::Write as _;

/// Writes a string, escaping what JSON requires and nothing more.
pub(crate) fn write_string(out: &mut String, text: &str) {
    out.push('"');
    for character in text.chars() {
        match character {
            '"' => out.push_str("\\\""),
            '\\' => out.push_str("\\\\"),
            '\n' => out.push_str("\\n"),
            '\r' => out.push_str("\\r"),
            '\t' => out.push_str("\\t"),
            '\u{8}' => out.push_str("\\b"),
            '\u{C}' => out.push_str("\\f"),
            control @ '\0'..' ' => {
                // Writing to a String cannot fail.
                let _ = write!(out, "\\u{:04x}", u32::from(control));
            }
            other => out.push(other),
        }
    }
    out.push('"');
}

/// Writes a finite float in the shortest form that reads back as the same.
pub(crate) fn write_f64(out: &mut String, value: f64) {
    out.push_str(zmij::Buffer::new().format_finite(value));
}

/// Writes a finite float in the shortest form that reads back as the same `f32`.
pub(crate) fn write_f32(out: &mut String, value: f32) {
    out.push_str(zmij::Buffer::new().format_finite(value));
}
