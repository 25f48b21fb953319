//! Turns names of operations in the spec's sentences into links to their pages.

use super::book::Book;
use super::links::{Anchor, Page};

/// Links every operation name in a sentence, bare or in a code span, except the operation of this page. A sentence that
/// already has links stays unchanged.
pub(super) fn linked(book: &Book<'_>, page: Page<'_>, source: &str) -> String {
    if source.contains("](") {
        return source.to_owned();
    }
    let link = |name: &str| {
        // A name of one word may be an ordinary word.
        let operation = name.contains('_').then(|| book.operation(name)).flatten()?;
        let here = matches!(page, Page::Operation(own) if own.name == operation.name);
        let href = page.link((Page::Operation(operation), Anchor::none()));
        (!here).then(|| format!("[`{name}`]({href})"))
    };
    let mut out = String::with_capacity(source.len());
    // Odd parts are between backticks.
    let mut parts = source.split('`').peekable();
    let mut in_code = false;
    while let Some(part) = parts.next() {
        let closed = parts.peek().is_some();
        if in_code && closed {
            out.push_str(&link(part).unwrap_or_else(|| format!("`{part}`")));
        } else if in_code {
            out.push('`');
            out.push_str(part);
        } else {
            words(part, &link, &mut out);
        }
        in_code = !in_code;
    }
    out
}

/// Links the words of a text without code.
fn words(text: &str, link: &dyn Fn(&str) -> Option<String>, out: &mut String) {
    let is_word = |character: char| character.is_ascii_alphanumeric() || character == '_';
    let mut rest = text;
    while let Some(start) = rest.find(is_word) {
        let (before, from_word) = rest.split_at(start);
        let end = from_word
            .find(|character| !is_word(character))
            .unwrap_or(from_word.len());
        let (word, after) = from_word.split_at(end);
        out.push_str(before);
        // The word is part of a path or of a longer name.
        let joined = before.ends_with(['/', '.', '-']) || after.starts_with(['/', '-']);
        match link(word).filter(|_| !joined) {
            Some(link) => out.push_str(&link),
            None => out.push_str(word),
        }
        rest = after;
    }
    out.push_str(rest);
}
