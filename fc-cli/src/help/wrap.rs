//! Wraps texts of both languages.

use unicode_width::{UnicodeWidthChar as _, UnicodeWidthStr as _};

/// The characters that cannot start a line.
const CLOSING: &str = "，。、；：？！）》」』”’…,.;:?!)]}";

/// The characters that cannot end a line.
const OPENING: &str = "（《「『“‘([{";

/// Breaks a text into lines of up to `width` columns, at spaces and between Chinese characters. Code between backticks
/// stays on one line. A longer word gets its own line.
pub fn wrap(text: &str, width: usize) -> Vec<String> {
    let mut lines = Vec::new();
    let mut line = String::new();
    for (spaced, word) in words(text) {
        let space = usize::from(spaced && !line.is_empty());
        if !line.is_empty() && line.width() + space + word.width() > width {
            lines.push(std::mem::take(&mut line));
        } else if space > 0 {
            line.push(' ');
        }
        line += word;
    }
    lines.push(line);
    lines
}

/// Returns the unbreakable parts, each with `true` if a space comes before it.
fn words(text: &str) -> Vec<(bool, &str)> {
    let mut words = Vec::new();
    let (mut start, mut spaced) = (0, false);
    let (mut before, mut is_code) = (None, false);
    for (at, now) in text.char_indices() {
        let breaks = before.is_some_and(|before| !is_code && breaks(before, now));
        if breaks && let Some(word) = text.get(start..at) {
            words.push((spaced, word.trim_end_matches(' ')));
            spaced = before == Some(' ');
            start = at;
        }
        if now == '`' {
            is_code = !is_code;
        }
        before = Some(now);
    }
    if let Some(word) = text.get(start..) {
        words.push((spaced, word));
    }
    words
}

/// Returns `true` if a line may end between two characters.
fn breaks(before: char, now: char) -> bool {
    if before == ' ' || now == ' ' {
        return before == ' ' && now != ' ';
    }
    let is_wide = |it: char| it.width() == Some(2);
    (is_wide(before) || is_wide(now)) && !OPENING.contains(before) && !CLOSING.contains(now)
}
