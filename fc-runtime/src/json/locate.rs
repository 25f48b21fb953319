//! Finds the path of an offset in a JSON text, for error messages.
//!
//! The reader keeps only offsets. The path is computed from the text after an error, so that valid texts do not pay for
//! it.

use super::error::prefix;
use std::fmt::Write as _;

/// Longest key in a path, in bytes. Keys come from the peer.
const LONGEST_KEY: usize = 64;

enum Level<'a> {
    /// In an object, after this key (without quotes, as sent).
    Object { key: Option<&'a str>, value: bool },
    /// In a list, at this item.
    Array { index: usize },
}

/// Returns the path of the value at `offset`, such as `data.stations[3].x`.
pub(super) fn path(text: &str, offset: usize) -> String {
    let bytes = text.as_bytes();
    let mut levels: Vec<Level<'_>> = Vec::new();
    let mut at = 0;
    while at < offset {
        let Some(&byte) = bytes.get(at) else { break };
        let mut next = at + 1;
        match byte {
            b'{' => levels.push(Level::Object {
                key: None,
                value: false,
            }),
            b'[' => levels.push(Level::Array { index: 0 }),
            b'}' | b']' => {
                levels.pop();
            }
            b',' => match levels.last_mut() {
                Some(Level::Object { key, value }) => {
                    *key = None;
                    *value = false;
                }
                Some(Level::Array { index }) => *index += 1,
                None => {}
            },
            b':' => {
                if let Some(Level::Object { value, .. }) = levels.last_mut() {
                    *value = true;
                }
            }
            b'"' => {
                let end = string_end(bytes, next);
                if end >= offset {
                    break;
                }
                if let Some(Level::Object { key, value: false }) = levels.last_mut() {
                    *key = text.get(next..end);
                }
                next = end + 1;
            }
            _ => {}
        }
        at = next;
    }
    print(&levels)
}

/// Returns the offset of the closing quote of a string whose content starts at `at`.
fn string_end(bytes: &[u8], mut at: usize) -> usize {
    while let Some(&byte) = bytes.get(at) {
        match byte {
            b'"' => return at,
            b'\\' => at += 2,
            _ => at += 1,
        }
    }
    bytes.len()
}

fn print(levels: &[Level<'_>]) -> String {
    let mut path = String::new();
    for level in levels {
        match level {
            Level::Object {
                key: Some(key),
                value: true,
            } => {
                if !path.is_empty() {
                    path.push('.');
                }
                let short = prefix(key, LONGEST_KEY);
                path.push_str(short);
                if short.len() < key.len() {
                    path.push('…');
                }
            }
            Level::Object { .. } => {}
            Level::Array { index } => {
                // Writing to a String cannot fail.
                let _ = write!(path, "[{index}]");
            }
        }
    }
    path
}

#[cfg(test)]
mod tests {
    use super::path;

    #[fc_test::test]
    fn every_place_has_its_path() {
        let text = r#"{"a":1,"b":{"c\"}":[10,{"d":true}]},"e":"x,:{"}"#;
        let cases = [
            ("1", "a"),
            (r#"{"c"#, "b"),
            ("[10", r#"b.c\"}"#),
            ("10", r#"b.c\"}[0]"#),
            (r#"{"d""#, r#"b.c\"}[1]"#),
            ("true", r#"b.c\"}[1].d"#),
            (r#""x,"#, "e"),
            (",:{", "e"),
            (r#""b""#, ""),
        ];
        for (place, expected) in cases {
            let offset = text.find(place).unwrap_or_default();
            assert_eq!(path(text, offset), expected, "{place}");
        }
        assert_eq!(path(text, 0), "");
        assert_eq!(path(text, text.len() + 9), "");
    }

    #[fc_test::test]
    fn a_long_key_is_shortened_between_characters() {
        let text = format!("{{\"{}\":1}}", "号".repeat(100));
        assert_eq!(path(&text, text.len() - 2), format!("{}…", "号".repeat(21)));
    }
}
