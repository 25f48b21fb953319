//! JSON with a comment that explains each key.

use super::rows::Row;
use fc_spec::model::Value;

/// Returns the value, indented, with the meaning of each key after its first occurrence. Messages have no comments.
pub(super) fn commented(value: &Value, rows: &[Row]) -> String {
    let mut lines = Lines {
        out: String::new(),
        rows,
        told: Vec::new(),
    };
    lines.value(value, "", 0, "", "");
    lines.out
}

struct Lines<'r> {
    out: String,
    rows: &'r [Row],
    /// The paths that already have a comment.
    told: Vec<String>,
}

impl Lines<'_> {
    /// Writes a value. `head` precedes it on its line, and `tail` follows its end.
    fn value(&mut self, value: &Value, path: &str, depth: usize, head: &str, tail: &str) {
        match value {
            Value::Object(entries) if !entries.is_empty() => {
                self.line(depth, &[head, "{"], path);
                for (index, (key, value)) in entries.iter().enumerate() {
                    let dot = if path.is_empty() { "" } else { "." };
                    let comma = comma(index, entries.len());
                    let name = Value::String(key.clone()).to_string();
                    let path = [path, dot, key].concat();
                    let head = [&name, ": "].concat();
                    self.value(value, &path, depth + 1, &head, comma);
                }
                self.line(depth, &["}", tail], "");
            }
            // Arrays of numbers and strings are on one line.
            Value::Array(items) if items.iter().any(is_nested) => {
                self.line(depth, &[head, "["], path);
                for (index, item) in items.iter().enumerate() {
                    let path = [path, "[]"].concat();
                    let comma = comma(index, items.len());
                    self.value(item, &path, depth + 1, "", comma);
                }
                self.line(depth, &["]", tail], "");
            }
            leaf => self.line(depth, &[head, &leaf.to_string(), tail], path),
        }
    }

    fn line(&mut self, depth: usize, text: &[&str], path: &str) {
        self.out.extend(std::iter::repeat_n("  ", depth));
        self.out.extend(text.iter().copied());
        if let Some(comment) = self.comment(path) {
            self.out.push_str(" // ");
            self.out.push_str(&comment);
        }
        self.out.push('\n');
    }

    fn comment(&mut self, path: &str) -> Option<String> {
        if path.is_empty() || self.told.iter().any(|told| told == path) {
            return None;
        }
        self.told.push(path.to_owned());
        let row = self.rows.iter().find(|row| row.path() == path)?;
        Some(plain(row.text()))
    }
}

fn comma(index: usize, length: usize) -> &'static str {
    if index + 1 < length { "," } else { "" }
}

fn is_nested(value: &Value) -> bool {
    matches!(value, Value::Object(_) | Value::Array(_))
}

/// Returns a sentence of Markdown as plain text on one line: links as their labels, code without backticks.
fn plain(source: &str) -> String {
    let mut out = String::with_capacity(source.len());
    let mut rest = source;
    while let Some((before, inside)) = rest.split_once('[') {
        let link = inside
            .split_once("](")
            .and_then(|(words, href)| Some((words, href.split_once(')')?.1)));
        out.push_str(before);
        match link {
            Some((words, after)) if !words.contains(']') => {
                out.push_str(words);
                rest = after;
            }
            _ => {
                out.push('[');
                rest = inside;
            }
        }
    }
    out.push_str(rest);
    out.replace('`', "")
        .split_whitespace()
        .collect::<Vec<_>>()
        .join(" ")
}

#[cfg(test)]
mod tests {
    use super::plain;

    #[test]
    fn markdown_as_plain_text() {
        for (source, expected) in [
            ("序列号", "序列号"),
            (
                "see [`get_map`](commands/get_map.md), then `x`",
                "see get_map, then x",
            ),
            ("an array [i32] and\nmore", "an array [i32] and more"),
        ] {
            assert_eq!(plain(source), expected);
        }
    }
}
