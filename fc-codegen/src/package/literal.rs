//! String literals of the languages.

use fc_spec::model::is_hidden;

/// Returns `text` in quotes. Quotes, backslashes and the `marks` of a language have a backslash.
///
/// `hidden` spells a character that cannot be printed.
pub fn quoted(
    text: &str,
    quote: char,
    marks: &[char],
    hidden: impl Fn(&mut String, char),
) -> String {
    let mut out = String::with_capacity(text.len() + 2);
    out.push(quote);
    for character in text.chars() {
        match character {
            '\n' => out.push_str("\\n"),
            '\r' => out.push_str("\\r"),
            '\t' => out.push_str("\\t"),
            c if c == quote || c == '\\' || marks.contains(&c) => out.extend(['\\', c]),
            c if c.is_control() || is_hidden(c) => hidden(&mut out, c),
            c => out.push(c),
        }
    }
    out.push(quote);
    out
}
