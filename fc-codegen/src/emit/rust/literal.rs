//! Literals of Rust: strings and numbers.

use crate::package::digits::grouped;
use crate::package::literal::quoted;
use fc_spec::model::{Number, is_hidden};

/// Returns a string literal. The literal is raw if that avoids escapes.
pub fn literal(text: &str) -> String {
    let needs_escape = |c: char| c.is_control() || is_hidden(c);
    // Lead bytes of all characters that need an escape, and of some that do not.
    let suspect = |byte| {
        matches!(
            byte,
            0..=0x1F | b'"' | b'\\' | 0x7F | 0xC2 | 0xD8 | 0xE2 | 0xEF | 0xF3
        )
    };
    if !text.bytes().any(suspect) {
        return ["\"", text, "\""].concat();
    }
    if text.contains(['"', '\\']) && !text.contains(needs_escape) {
        let mut hashes = String::new();
        while text.contains(&format!("\"{hashes}")) {
            hashes.push('#');
        }
        return ["r", &hashes, "\"", text, "\"", &hashes].concat();
    }
    quoted(text, '"', &[], |out, c| out.extend(c.escape_unicode()))
}

pub fn number(number: &Number) -> String {
    match number {
        Number::Int(value) => grouped(*value),
        Number::Float(value) => format!("{value:?}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn string_literals() {
        for (text, expected) in [
            ("站点", "\"站点\""),
            (r#"{"a":1}"#, r##"r#"{"a":1}"#"##),
            (r##"a"#b"##, r###"r##"a"#b"##"###),
            ("a\n\"b\"", r#""a\n\"b\"""#),
            ("a\u{202e}b", r#""a\u{202e}b""#),
            (r"\d", r#"r"\d""#),
        ] {
            assert_eq!(literal(text), expected);
        }
    }
}
