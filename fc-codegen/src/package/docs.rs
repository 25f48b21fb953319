//! Turns prose of the spec into documentation comments that compilers and documentation tools accept.

use super::style::Comment;
use fc_spec::model::{Lang, Languages, Text, has_unprintable, is_hidden};
use std::borrow::Cow;

/// A documentation comment: paragraphs of the spec's Markdown and of the generator's text.
#[derive(Clone, Debug, Default)]
pub struct Docs<'t>(Vec<Block<'t>>);

/// A part of a comment between empty lines.
#[derive(Clone, Debug)]
enum Block<'t> {
    /// Markdown of the spec, which is escaped and wrapped.
    Prose(Words<'t>),
    /// Text of the generator, which may link to items and is written unchanged.
    Raw(Words<'t>),
}

/// The text of a block, and the languages in which it is emitted.
#[derive(Clone, Debug)]
enum Words<'t> {
    /// A text that does not depend on the language.
    Any(Cow<'t, str>),
    /// A text in one language.
    In(Lang, Cow<'t, str>),
    /// A text that has one form for both languages together.
    Joined {
        zh: Cow<'t, str>,
        en: Cow<'t, str>,
        both: String,
    },
}

impl<'t> Words<'t> {
    fn joined<T: Into<Cow<'t, str>>>(pair: [T; 2], both: String) -> Self {
        let [zh, en] = pair.map(Into::into);
        Self::Joined { zh, en, both }
    }

    /// Returns the text in these languages; `None` if they leave it out.
    fn in_languages(&self, languages: Languages) -> Option<&str> {
        match self {
            Self::Any(text) => Some(text),
            Self::In(language, text) => languages.include(*language).then_some(text),
            Self::Joined { zh, en, both } => Some(match languages {
                Languages::Only(Lang::Zh) => zh,
                Languages::Only(Lang::En) => en,
                Languages::All | Languages::Any => both,
            }),
        }
    }
}

impl<'t> Docs<'t> {
    /// Creates a comment that starts with a text in both languages.
    pub fn titled(text: &'t Text) -> Self {
        let mut docs = Self::default();
        docs.text(text);
        docs
    }

    /// Creates a comment that starts with a Chinese and an English paragraph.
    pub fn said<T: Into<Cow<'t, str>>>(pair: [T; 2]) -> Self {
        let mut docs = Self::default();
        docs.both(pair);
        docs
    }

    /// Creates a comment of one line, with the Chinese text before the English one. It is written unchanged.
    pub fn line<T: Into<Cow<'t, str>>>(pair: [T; 2]) -> Self {
        let mut docs = Self::default();
        docs.sentences(pair);
        docs
    }

    /// Creates a short comment that is written unchanged, links included.
    pub fn linked(text: String) -> Self {
        let mut docs = Self::default();
        docs.raw(text);
        docs
    }

    /// Adds a Chinese and an English paragraph. Adds one paragraph if both are equal.
    pub fn text(&mut self, text: &'t Text) {
        self.both([text.zh.as_str(), text.en.as_str()]);
    }

    /// Adds a text in both languages, if `text` is present.
    pub fn texts(&mut self, text: Option<&'t Text>) {
        if let Some(text) = text {
            self.text(text);
        }
    }

    /// Adds a Chinese and an English paragraph. Adds one paragraph if both are equal, and none that is empty.
    pub fn both<T: Into<Cow<'t, str>>>(&mut self, pair: [T; 2]) {
        self.pair(pair, Block::Prose);
    }

    /// Adds a Chinese and an English text, written unchanged.
    pub fn raw_both<T: Into<Cow<'t, str>>>(&mut self, pair: [T; 2]) {
        self.pair(pair, Block::Raw);
    }

    fn pair<T: Into<Cow<'t, str>>>(&mut self, pair: [T; 2], block: fn(Words<'t>) -> Block<'t>) {
        let [zh, en] = pair.map(Into::into);
        if zh == en {
            return self.add(block, Words::Any(zh));
        }
        self.add(block, Words::In(Lang::Zh, zh));
        self.add(block, Words::In(Lang::En, en));
    }

    /// Adds a paragraph in one language, written unchanged, unless it is empty.
    pub fn raw_in(&mut self, language: Lang, text: impl Into<Cow<'t, str>>) {
        self.add(Block::Raw, Words::In(language, text.into()));
    }

    /// Adds a Chinese and an English sentence on one line, written unchanged.
    pub fn sentences<T: Into<Cow<'t, str>>>(&mut self, pair: [T; 2]) {
        let pair = pair.map(Into::into);
        let both = pair.concat();
        self.add(Block::Raw, Words::joined(pair, both));
    }

    /// Adds a Chinese line and an English line as one paragraph, written unchanged.
    pub fn raw_lines<T: Into<Cow<'t, str>>>(&mut self, pair: [T; 2]) {
        let pair = pair.map(Into::into);
        let both = pair.join("\n");
        self.add(Block::Raw, Words::joined(pair, both));
    }

    /// Adds a paragraph in Chinese, in English, or in the form for both languages.
    pub fn joined(&mut self, [zh, en, both]: [String; 3]) {
        self.add(Block::Prose, Words::joined([zh, en], both));
    }

    /// Adds a paragraph like [`joined`](Self::joined), written unchanged.
    pub fn raw_joined(&mut self, [zh, en, both]: [String; 3]) {
        self.add(Block::Raw, Words::joined([zh, en], both));
    }

    /// Adds a paragraph that does not depend on the language, unless it is empty.
    pub fn paragraph(&mut self, text: impl Into<Cow<'t, str>>) {
        self.add(Block::Prose, Words::Any(text.into()));
    }

    /// Adds a short paragraph unchanged, links included, unless it is empty.
    pub fn raw(&mut self, text: impl Into<Cow<'t, str>>) {
        self.add(Block::Raw, Words::Any(text.into()));
    }

    fn add(&mut self, block: fn(Words<'t>) -> Block<'t>, words: Words<'t>) {
        let is_empty = match &words {
            Words::Any(text) | Words::In(_, text) => text.trim().is_empty(),
            Words::Joined { .. } => false,
        };
        if !is_empty {
            self.0.push(block(words));
        }
    }

    /// Passes each line of the comment to `line`, without comment marks. Leaves out texts in other languages.
    ///
    /// Lines have at most `width` columns where a space allows a break. Chinese is not broken, because a line break in
    /// it would show as a space.
    ///
    /// A title in both languages forms one paragraph, because documentation tools list only the first paragraph.
    pub fn lines(
        &self,
        languages: Languages,
        comment: &Comment,
        width: usize,
        mut line: impl FnMut(&str),
    ) {
        let blocks = self.0.iter().filter_map(|block| {
            let (Block::Prose(words) | Block::Raw(words)) = block;
            Some((block, words.in_languages(languages)?))
        });
        let blocks: Vec<_> = blocks.collect();
        for (index, (block, text)) in blocks.iter().enumerate() {
            if index > 1 || index == 1 && !starts_with_a_title(&blocks, width) {
                line("");
            }
            match block {
                Block::Prose(_) => prose(text.trim(), comment, width, &mut line),
                // Names and keys of the spec must not end the comment either.
                Block::Raw(_) => (text.lines()).for_each(|text| {
                    line(&(comment.code)(&clean(text)));
                }),
            }
        }
    }
}

/// Returns `true` if the first two paragraphs are a one-line Chinese title and its English translation.
fn starts_with_a_title(blocks: &[(&Block<'_>, &str)], width: usize) -> bool {
    let [
        (Block::Prose(Words::In(Lang::Zh, _)), zh),
        (Block::Prose(Words::In(Lang::En, _)), en),
        ..,
    ] = blocks
    else {
        return false;
    };
    let is_short = |text: &str, lines: usize| {
        let text = text.trim();
        !text.contains('\n') && !starts_block(text) && columns_of(text) <= lines * width
    };
    is_short(zh, 1) && is_short(en, 2)
}

/// Writes one block of Markdown. Fenced code stays unchanged, other text is escaped, and paragraphs are wrapped.
fn prose(block: &str, comment: &Comment, width: usize, out: &mut impl FnMut(&str)) {
    let mut fence: Option<&str> = None;
    for line in block.lines() {
        let line = clean(line);
        let trimmed = line.trim_start();
        let mark = ["```", "~~~"]
            .into_iter()
            .find(|mark| trimmed.starts_with(mark));
        match (fence, mark) {
            (Some(open), Some(mark)) if open == mark => {
                fence = None;
                out(mark);
            }
            (Some(_), _) => out(&(comment.code)(line.trim_end())),
            (None, Some(mark)) => {
                fence = Some(mark);
                let language = trimmed.trim_start_matches(['`', '~']).trim();
                out(&format!("{mark}{}", (comment.fence)(language)));
            }
            (None, None) => prose_line(&line, comment, width, out),
        }
    }
    if let Some(open) = fence {
        out(open);
    }
}

/// Writes one line of prose. Caps the indentation at three, because four columns start a code block.
fn prose_line(line: &str, comment: &Comment, width: usize, out: &mut impl FnMut(&str)) {
    let text = line.trim_start();
    let indent = "   ".get(..line.len() - text.len()).unwrap_or("   ");
    let text = (comment.prose)(text.trim_end());
    let marker = list_marker(&text);
    if marker > 0 {
        let (marker, item) = text.split_at(marker);
        let first = format!("{indent}{marker}");
        let further = " ".repeat(first.len());
        wrap(item, width, &first, &further, out);
    } else if indent.is_empty() && !starts_block(&text) {
        wrap(&text, width, "", "", out);
    } else {
        out(&format!("{indent}{text}"));
    }
}

/// Returns the length of the leading `- ` or `1. `; 0 if the line is no list item.
fn list_marker(text: &str) -> usize {
    let digits = text.bytes().take_while(u8::is_ascii_digit).count();
    let rest = text.get(digits..).unwrap_or_default();
    let marked = if digits == 0 {
        rest.starts_with("- ") || rest.starts_with("* ") || rest.starts_with("+ ")
    } else {
        rest.starts_with(". ") || rest.starts_with(") ")
    };
    if marked { digits + 2 } else { 0 }
}

/// Returns `true` if such a line opens a list, a heading, a quote or a table.
fn starts_block(text: &str) -> bool {
    let digits = text.bytes().take_while(u8::is_ascii_digit).count();
    text.starts_with(['-', '+', '*', '#', '>', '|', '='])
        || digits > 0
            && text
                .get(digits..)
                .is_some_and(|rest| rest.starts_with(['.', ')']))
}

/// Breaks the text at spaces, except before a word that would open a list or a quote.
///
/// The first line starts with `first`, the others with `further`.
fn wrap(text: &str, width: usize, first: &str, further: &str, out: &mut impl FnMut(&str)) {
    let has_gap = |text: &str| text.as_bytes().windows(2).any(|pair| pair == b"  ");
    if first.is_empty() && columns_of(text) <= width && !has_gap(text) && text.trim() == text {
        return out(text);
    }
    let mut line = String::with_capacity(text.len().min(2 * width) + first.len());
    line.push_str(first);
    let mut columns = 0;
    for word in text.split(' ').filter(|word| !word.is_empty()) {
        let length = columns_of(word);
        if columns > 0 && first.len() + columns + 1 + length > width && !starts_block(word) {
            out(&line);
            line.clear();
            line.push_str(further);
            columns = 0;
        }
        if columns > 0 {
            line.push(' ');
            columns += 1;
        }
        line.push_str(word);
        columns += length;
    }
    out(&line);
}

/// Returns the width on a terminal. A Chinese character takes two columns.
pub fn columns_of(text: &str) -> usize {
    if text.is_ascii() {
        return text.len();
    }
    let wide = |c: &char| ('\u{1100}'..='\u{115F}').contains(c) || *c >= '\u{2E80}';
    text.chars().map(|c| if wide(&c) { 2 } else { 1 }).sum()
}

/// Removes characters that a comment must not contain: carriage returns, controls and text direction marks.
fn clean(line: &str) -> Cow<'_, str> {
    if !has_unprintable(line) {
        return Cow::Borrowed(line);
    }
    let unclean = |c: char| c.is_control() || is_hidden(c);
    let line = line.replace('\t', "    ");
    Cow::Owned(line.chars().filter(|&c| !unclean(c)).collect())
}

/// Escapes links and HTML outside code spans, and puts addresses into angle brackets.
pub fn escape_links(text: &str) -> Cow<'_, str> {
    let marks = |byte| matches!(byte, b'<' | b'[' | b']');
    let has_address = text.contains(':') && text.contains("://");
    if !has_address && !text.bytes().any(marks) {
        return Cow::Borrowed(text);
    }
    let mut out = String::with_capacity(text.len() + 8);
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let taken = match first {
            '`' => code_span(rest, &mut out),
            'h' if is_address(rest) => {
                let (address, _) = rest.split_at(address_length(rest));
                out.extend(["<", address, ">"]);
                address.len()
            }
            '<' => {
                let inner = rest.get(1..).unwrap_or_default();
                if is_address(inner) {
                    let (address, after) = inner.split_at(address_length(inner));
                    out.extend(["<", address, ">"]);
                    1 + address.len() + usize::from(after.starts_with('>'))
                } else {
                    out.push_str("\\<");
                    1
                }
            }
            '[' | ']' => {
                out.extend(['\\', first]);
                1
            }
            '\\' => {
                // Keeps an escape of the spec.
                let length = rest.chars().take(2).map(char::len_utf8).sum();
                let (pair, _) = rest.split_at(length);
                out.push_str(pair);
                length
            }
            other => {
                out.push(other);
                other.len_utf8()
            }
        };
        (_, rest) = rest.split_at(taken);
    }
    Cow::Owned(out)
}

/// Copies a code span, or lone backticks that open none. Returns the number of bytes taken.
fn code_span(text: &str, out: &mut String) -> usize {
    let ticks = text.bytes().take_while(|&byte| byte == b'`').count();
    let (mark, inner) = text.split_at(ticks);
    let length = match inner.find(mark) {
        Some(end) => ticks + end + ticks,
        None => ticks,
    };
    let (span, _) = text.split_at(length);
    out.push_str(span);
    length
}

fn is_address(text: &str) -> bool {
    text.starts_with("http://") || text.starts_with("https://")
}

/// Returns the length of the address at the start of `text`.
fn address_length(text: &str) -> usize {
    let end = text
        .find(|c: char| !c.is_ascii() || c.is_whitespace() || "<>()[]\"`".contains(c))
        .unwrap_or(text.len());
    let (address, _) = text.split_at(end);
    address
        .trim_end_matches(['.', ',', ';', ':', '!', '?'])
        .len()
}

#[cfg(test)]
mod tests;
