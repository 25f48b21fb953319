//! The path of a place in a JSON text.
//!
//! Reading notes offsets alone; the path is worked out from the text once something is wrong.

use std::fmt::Write as _;

/// Longest part of a path, in bytes: keys come from the peer.
const LONGEST_KEY: usize = 64;

enum Level<'t> {
    /// In an object, behind this key (without quotes, as sent).
    Object { key: Option<&'t str>, value: bool },
    /// In a list, at this item.
    List { index: usize },
}

/// The path of the value at `offset`, such as `data.stations[3].x`.
pub(crate) fn path(text: &str, offset: usize) -> String {
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
            b'[' => levels.push(Level::List { index: 0 }),
            b'}' | b']' => {
                levels.pop();
            }
            b',' => match levels.last_mut() {
                Some(Level::Object { key, value }) => {
                    *key = None;
                    *value = false;
                }
                Some(Level::List { index }) => *index += 1,
                None => {}
            },
            b':' => {
                if let Some(Level::Object { value, .. }) = levels.last_mut() {
                    *value = true;
                }
            }
            b'"' => {
                let end = string_end(bytes, next);
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

/// Where the quote is that closes a string whose content starts at `at`.
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
                let whole = |end: &usize| key.is_char_boundary(*end);
                let end = (0..=LONGEST_KEY.min(key.len())).rev().find(whole);
                let short = key.get(..end.unwrap_or(0)).unwrap_or_default();
                path.push_str(short);
                if short.len() < key.len() {
                    path.push('…');
                }
            }
            Level::Object { .. } => {}
            Level::List { index } => {
                // Writing to a String cannot fail.
                let _ = write!(path, "[{index}]");
            }
        }
    }
    path
}
