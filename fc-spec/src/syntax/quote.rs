//! Texts in quotes.

/// A text as it is written in quotes: in double ones, or in single ones where those would need escapes.
pub(crate) fn quoted(text: &str) -> String {
    if text.contains(['"', '\\']) {
        format!("'{}'", text.replace('\'', "''"))
    } else {
        format!("\"{text}\"")
    }
}
