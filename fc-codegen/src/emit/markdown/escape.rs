//! Escapes texts of the spec for Markdown in tables, in `VitePress` and elsewhere.
//!
//! The texts are Markdown, so their code spans, emphasis and links stay. They cannot affect other parts of a page. `<`
//! would open a Vue component, two braces a Vue expression, and one brace the attributes of `VitePress`'s Markdown. `|`
//! and a line break would end the table cell. `VitePress` also obeys `<!--@include: …-->` in front matter and code.
//! Invisible characters are written like `\u202e`.

use fc_spec::model::{has_unprintable, is_hidden};
use std::borrow::Cow;
use std::fmt::Write as _;

/// The part of a page that a text goes into.
#[derive(Clone, Copy, Debug)]
pub(super) enum Slot<'a> {
    /// A line, outside of tables.
    Line,
    /// A table cell.
    Cell,
    /// The label of a link, also in a table.
    Label,
    /// Paragraphs and lists. Fenced code in them is kept.
    Prose,
    /// A code span outside of tables. An empty text gives nothing, because Markdown has no empty code span.
    Code,
    /// A code span in a table cell.
    CodeCell,
    /// A fenced code block with this language.
    Fence(&'a str),
    /// A line of a diagram in a fence.
    Diagram,
    /// A string of the YAML front matter.
    FrontMatter,
    /// An attribute of HTML, between double quotes.
    Attribute,
    /// The target of a link.
    Target,
    /// A string of a JSON file.
    Data,
}

/// Returns a text in the spelling of the slot. Every text of a page passes through here.
#[must_use]
pub(super) fn write(source: &str, slot: Slot<'_>) -> String {
    let source = &*visible(source);
    match slot {
        Slot::Line => line(source),
        Slot::Cell => cell(source),
        Slot::Label => label(source),
        Slot::Prose => prose(source),
        Slot::Code => code(source),
        Slot::CodeCell => bars_escaped(code(source)),
        Slot::Fence(language) => fence(source, language),
        Slot::Diagram => one_line(source),
        Slot::FrontMatter => front_matter(source),
        Slot::Attribute => html(&one_line(source)),
        Slot::Target => target(source),
        Slot::Data => source.to_owned(),
    }
}

/// Returns a text in which invisible characters and direction marks are written as in JSON.
fn visible(source: &str) -> Cow<'_, str> {
    if !has_unprintable(source) {
        return source.into();
    }
    let mut out = String::with_capacity(source.len());
    for character in source.chars() {
        if is_hidden(character) {
            for unit in character.encode_utf16(&mut [0; 2]) {
                // Writing to a String cannot fail.
                let _ = write!(out, "\\u{unit:04x}");
            }
        } else {
            out.push(character);
        }
    }
    out.into()
}

fn line(source: &str) -> String {
    unmarked_start(inline(&one_line(source)))
}

fn cell(source: &str) -> String {
    let lines = source.trim().lines();
    let mut lines = lines.map(|line| bars_escaped(inline(line.trim())));
    let mut out = lines.next().unwrap_or_default();
    for line in lines {
        out.extend(["<br>", &line]);
    }
    out
}

/// Escapes brackets that belong to no link, because they would end this label.
fn label(source: &str) -> String {
    let mut out = String::with_capacity(source.len());
    for piece in pieces(&cell(source)) {
        match piece {
            Piece::Code(span) => out.push_str(span),
            Piece::Text(text) => {
                let mut escaped = false;
                for character in text.chars() {
                    if matches!(character, '[' | ']') && !escaped {
                        out.push('\\');
                    }
                    escaped = character == '\\' && !escaped;
                    out.push(character);
                }
            }
        }
    }
    out
}

/// Escapes bars, because they would end the cell.
fn bars_escaped(markdown: String) -> String {
    if markdown.contains('|') {
        markdown.replace('|', "\\|")
    } else {
        markdown
    }
}

fn prose(source: &str) -> String {
    let mut out = String::new();
    let mut open_fence: Option<&str> = None;
    let mut paragraph = String::new();
    let mut fenced = String::new();
    for line in source.trim_end().lines() {
        let start = line.trim_start();
        let marker = ["```", "~~~"]
            .into_iter()
            .find(|marker| start.starts_with(marker));
        if open_fence.is_none() && marker.is_none() {
            paragraph.push_str(line);
            paragraph.push('\n');
            continue;
        }
        out.push_str(&paragraphs(&std::mem::take(&mut paragraph)));
        fenced.push_str(line);
        fenced.push('\n');
        match (open_fence, marker) {
            (None, Some(_)) => open_fence = marker,
            (Some(open), Some(close)) if open == close && is_bare(start) => {
                open_fence = None;
                out.push_str(&block(&std::mem::take(&mut fenced)));
            }
            _ => {}
        }
    }
    out.push_str(&paragraphs(&paragraph));
    // A fence without an end would continue to the end of the page.
    if let Some(open) = open_fence {
        fenced.push_str(open);
        out.push_str(&block(&fenced));
    }
    out.truncate(out.trim_end().len());
    out
}

/// Returns a fence of the author. If `VitePress` would obey its code, returns HTML instead.
fn block(fence: &str) -> String {
    if !is_obeyed(fence) {
        return fence.to_owned();
    }
    let code = fence
        .trim_end()
        .split_once('\n')
        .map_or("", |(_, code)| code);
    let code = code.rsplit_once('\n').map_or("", |(code, _)| code);
    preformatted(code) + "\n"
}

/// Returns paragraphs and lists. Their lines start no other block, such as a heading or a container of `VitePress`.
fn paragraphs(source: &str) -> String {
    let mut out = String::with_capacity(source.len());
    // A code span ends with its paragraph at the latest. A span that continues in the next line becomes text.
    for line in source.lines().map(inline) {
        let start = line.len() - line.trim_start().len();
        let (indent, text) = line.split_at(start);
        out.push_str(indent);
        let begins = [":::", "[[", "#"].iter().any(|mark| text.starts_with(mark));
        let underlines = !text.is_empty()
            && (text.chars().all(|it| it == '=') || text.chars().all(|it| it == '-'));
        let defines = text.starts_with('[') && text.contains("]:");
        if begins || underlines || defines {
            out.push('\\');
        }
        out.push_str(text);
        out.push('\n');
    }
    out
}

/// Returns a line that starts no list, quotation, heading, fence or container.
fn unmarked_start(mut markdown: String) -> String {
    let first_word = markdown.split(' ').next().unwrap_or_default();
    let digits = first_word.trim_start_matches(|it: char| it.is_ascii_digit());
    let is_number = digits.len() < first_word.len() && matches!(digits, "." | ")");
    let is_mark =
        matches!(first_word, "-" | "+" | "*" | "=") || first_word.chars().all(|it| it == '#');
    let begins = [">", ":::", "```", "~~~", "---", "===", "[["]
        .iter()
        .any(|mark| markdown.starts_with(mark));
    if is_number {
        markdown.insert(first_word.len() - 1, '\\');
    } else if !first_word.is_empty() && (is_mark || begins) {
        markdown.insert(0, '\\');
    }
    // Number signs at the end would close a heading.
    let closed = markdown.trim_end_matches('#');
    if closed.len() < markdown.len() && closed.ends_with(' ') {
        let at = closed.len();
        markdown.insert(at, '\\');
    }
    markdown
}

/// Returns `true` if a line consists only of a fence, as a closing one does.
fn is_bare(fence: &str) -> bool {
    let mut characters = fence.trim_end().chars();
    let first = characters.next();
    characters.all(|character| Some(character) == first)
}

/// Returns a code span.
///
/// Vue also interprets braces in code spans, and `VitePress` interprets comments. Where one begins, the span is split
/// in two with an invisible comment between them.
fn code(source: &str) -> String {
    let source = one_line(source);
    let mut out = String::with_capacity(source.len() + 2);
    if !source.is_empty() && !has_any(&source, b"{<`") {
        out.extend(["`", &source, "`"]);
        return out;
    }
    let mut rest = source.as_str();
    while let Some(at) = [rest.find("{{"), rest.find("<!--")]
        .into_iter()
        .flatten()
        .min()
    {
        let (span, behind) = rest.split_at(at + 1);
        push_span(&mut out, span);
        out.push_str("<!-- -->");
        rest = behind;
    }
    if !rest.is_empty() {
        push_span(&mut out, rest);
    }
    out
}

fn push_span(out: &mut String, source: &str) {
    let ticks = std::iter::repeat_n("`", longest_run(source) + 1);
    let at_edge = source.starts_with('`') || source.ends_with('`');
    let pad = if at_edge || source.trim().is_empty() {
        " "
    } else {
        ""
    };
    out.extend(ticks.clone());
    out.extend([pad, source, pad]);
    out.extend(ticks);
}

fn fence(source: &str, language: &str) -> String {
    let source = source.trim_end_matches('\n');
    if is_obeyed(source) {
        return preformatted(source);
    }
    let ticks = "`".repeat((longest_run(source) + 1).max(3));
    format!("{ticks}{language}\n{source}\n{ticks}")
}

/// Returns `true` if `VitePress` would put a file in place of a part of the text, also in a fence.
fn is_obeyed(source: &str) -> bool {
    let mut comments = source.split("<!--").skip(1);
    comments.any(|comment| comment.trim_start().starts_with("@include"))
}

/// Returns code as HTML, where `<` has another spelling.
fn preformatted(source: &str) -> String {
    format!("<pre v-pre><code>{}</code></pre>", html(source))
}

fn html(source: &str) -> String {
    let source = source.replace('&', "&amp;").replace('<', "&lt;");
    source.replace('>', "&gt;").replace('"', "&quot;")
}

/// Returns a JSON string, which is also YAML. `VitePress` writes it into a script, where a tag would end the script. So
/// `<` becomes a wide character.
fn front_matter(source: &str) -> String {
    let source = one_line(source);
    let mut out = String::with_capacity(source.len());
    let mut characters = source.chars().peekable();
    while let Some(character) = characters.next() {
        let next = characters.peek();
        let opens =
            next.is_some_and(|it| it.is_ascii_alphabetic() || matches!(it, '/' | '!' | '?'));
        out.push(if character == '<' && opens {
            '＜'
        } else {
            character
        });
    }
    fc_spec::model::Value::String(out).to_string()
}

/// Returns the target of a link. Characters that could end the link are escaped in hexadecimal.
fn target(source: &str) -> String {
    let mut out = String::with_capacity(source.len());
    for character in source.chars() {
        if character.is_alphanumeric() || "/#.-_~:?=+,@!$;".contains(character) {
            out.push(character);
        } else {
            for byte in character.encode_utf8(&mut [0; 4]).bytes() {
                // Writing to a String cannot fail.
                let _ = write!(out, "%{byte:02X}");
            }
        }
    }
    out
}

fn one_line(source: &str) -> String {
    let mut out = String::with_capacity(source.len());
    for line in source.split(['\n', '\r']).map(str::trim) {
        if !line.is_empty() && !out.is_empty() {
            out.push(' ');
        }
        out.push_str(line);
    }
    out
}

enum Piece<'s> {
    /// A code span with its backticks.
    Code(&'s str),
    Text(&'s str),
}

/// Splits a text into code spans and the parts between them. An escaped or unclosed backtick is text.
fn pieces(source: &str) -> Vec<Piece<'_>> {
    let mut pieces = Vec::new();
    let (mut from, mut at) = (0, 0);
    let get = |from: usize, to: usize| source.get(from..to).unwrap_or_default();
    while let Some(found) = source.get(at..).and_then(|rest| rest.find(['`', '\\'])) {
        let start = at + found;
        let rest = get(start, source.len());
        if rest.starts_with('\\') {
            at = start + 1 + rest.chars().nth(1).map_or(0, char::len_utf8);
            continue;
        }
        let ticks = rest.len() - rest.trim_start_matches('`').len();
        at = start + ticks;
        if let Some(end) = closing(get(at, source.len()), ticks) {
            pieces.push(Piece::Text(get(from, start)));
            at += end;
            pieces.push(Piece::Code(get(start, at)));
            from = at;
        }
    }
    pieces.push(Piece::Text(get(from, source.len())));
    pieces
}

/// Escapes the parts outside of code spans.
fn inline(source: &str) -> String {
    if !has_any(source, b"{\\<&!`") {
        return source.to_owned();
    }
    let mut out = String::with_capacity(source.len());
    for piece in pieces(source) {
        match piece {
            Piece::Code(span) => out.push_str(&code(span.trim_matches('`').trim())),
            Piece::Text(text) => push_text(&mut out, text),
        }
    }
    out
}

/// Returns the end of a code span that `ticks` backticks opened, after its closing backticks.
pub(super) fn closing(inside: &str, ticks: usize) -> Option<usize> {
    let mut position = 0;
    loop {
        let rest = inside.get(position..)?;
        let run_start = position + rest.find('`')?;
        let run = inside.get(run_start..)?;
        let run_len = run.len() - run.trim_start_matches('`').len();
        position = run_start + run_len;
        if run_len == ticks {
            return Some(position);
        }
    }
}

/// Escapes a text without code spans.
fn push_text(out: &mut String, source: &str) {
    // `true` if the last visible character is a brace.
    let mut after_brace = false;
    let mut characters = source.chars().peekable();
    while let Some(character) = characters.next() {
        let next = characters.peek().copied();
        let is_brace = match (character, next) {
            ('{', _) => true,
            // An escape of the author.
            ('\\', Some('{')) => {
                characters.next();
                true
            }
            _ => false,
        };
        if is_brace {
            // The comment prevents Vue from seeing two braces. Readers do not see it.
            out.push_str(if after_brace { "<!-- -->\\{" } else { "\\{" });
            after_brace = true;
            continue;
        }
        after_brace = false;
        match (character, next) {
            ('<', _) => out.push_str("&lt;"),
            ('\\', Some('<')) => {
                characters.next();
                out.push_str("&lt;");
            }
            // A backslash at the end would escape the next character of the page.
            ('\\', None | Some('\n')) => out.push_str("\\\\"),
            ('\\', Some(escaped)) if escaped.is_ascii_punctuation() => {
                characters.next();
                out.extend(['\\', escaped]);
            }
            // An entity could produce braces, and an image could include any file.
            ('&', Some(next)) if next == '#' || next.is_ascii_alphabetic() => out.push_str("&amp;"),
            ('!', Some('[')) => out.push_str("\\!"),
            // A backtick would start or end a code span of the page.
            ('`', _) => out.push_str("\\`"),
            (plain, _) => out.push(plain),
        }
    }
}

/// Returns `true` if the text contains one of the ASCII marks. Most texts contain none.
#[allow(
    clippy::needless_bitwise_bool,
    reason = "without branches it becomes vector instructions"
)]
fn has_any(text: &str, marks: &[u8]) -> bool {
    let mut bytes = text.as_bytes().chunks(64);
    bytes.any(|chunk| {
        let has = |mark: &u8| {
            chunk
                .iter()
                .fold(false, |found, byte| found | (byte == mark))
        };
        marks.iter().any(has)
    })
}

fn longest_run(source: &str) -> usize {
    let mut longest = 0;
    let mut run = 0;
    for byte in source.bytes() {
        run = if byte == b'`' { run + 1 } else { 0 };
        longest = longest.max(run);
    }
    longest
}

#[cfg(test)]
mod tests;
