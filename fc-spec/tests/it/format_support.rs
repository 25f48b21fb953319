//! Rewrites a spec file in another layout with the same meaning.

use fc_spec::diagnostic::Faults;
use fc_spec::source::FileId;
use fc_spec::syntax::{Node, NodeKind, Style, parse};
use std::fmt::Write as _;

/// Changes that a mutation may make. The layout undoes some of them and keeps the others.
#[derive(Clone, Copy, Debug, Default)]
#[allow(clippy::struct_excessive_bools, reason = "each may be there or not")]
pub struct Mutations {
    /// Shuffles the keys of mappings that have `zh` and `en`.
    pub order: bool,
    /// Adds comments, above lines and at their ends.
    pub comments: bool,
    /// Writes blocks as brackets, and brackets as blocks.
    pub brackets: bool,
    /// Writes strings in other quotes, folded, or as blocks, and null as `~`.
    pub texts: bool,
    /// Adds blank lines.
    pub blanks: bool,
    /// Ends lines with CRLF.
    pub crlf: bool,
}

/// Rewrites a file with these mutations, and with other indentation and white space. `seed` decides every detail.
pub fn mutate(text: &str, mutations: Mutations, seed: u64) -> String {
    let mut faults = Faults::new();
    let tree = parse(FileId(0), text, &mut faults).expect("a file of the spec");
    let mut writer = Writer {
        text,
        mutations,
        seed: seed | 1,
        out: String::new(),
        comments: 0,
        behind_block: false,
    };
    if let Some(head) = text.strip_prefix('#').and_then(|_| text.find("\n\n")) {
        writer.out.push_str(&text[..head]);
        writer.out.push_str("\n\n");
    }
    writer.block(tree.root(), 0, false);
    writer.noise(0, false);
    if mutations.crlf {
        writer.out.replace('\n', "\r\n")
    } else {
        writer.out
    }
}

struct Writer<'t> {
    text: &'t str,
    mutations: Mutations,
    seed: u64,
    out: String,
    comments: usize,
    /// `true` after a block scalar, where an indented comment would become part of its text.
    behind_block: bool,
}

impl Writer<'_> {
    /// Returns a pseudorandom number below `end`.
    fn dice(&mut self, end: usize) -> usize {
        self.seed ^= self.seed << 13;
        self.seed ^= self.seed >> 7;
        self.seed ^= self.seed << 17;
        usize::try_from(self.seed >> 33).unwrap_or_default() % end.max(1)
    }

    fn spaces(&mut self, count: usize) {
        self.out.extend(std::iter::repeat_n(' ', count));
    }

    fn comment(&mut self) {
        let kinds = [
            "",
            " 说明：第",
            " # \" ' { [ ",
            "! - a: b |",
            " with\ta tab and spaces  ",
        ];
        let kind = kinds[self.dice(kinds.len())];
        self.comments += 1;
        write!(self.out, "#{kind}{}", self.comments).expect("a string");
        if self.dice(8) == 0 {
            self.out.push_str("  ");
        }
    }

    /// Writes blank lines and comments above a line. `has_blank`: the original has a blank line here.
    fn noise(&mut self, indent: usize, has_blank: bool) {
        let adds = self.mutations.blanks && self.dice(6) == 0;
        if has_blank || adds {
            for _ in 0..=self.dice(3) {
                let spaces = if self.behind_block { 0 } else { self.dice(3) };
                self.spaces(spaces);
                self.out.push('\n');
            }
        }
        if self.mutations.comments && self.dice(9) == 0 {
            for _ in 0..=self.dice(2) {
                let further = if self.behind_block { 1 } else { 5 };
                let column = self.dice(indent + further);
                self.spaces(column);
                self.comment();
                self.out.push('\n');
                if self.dice(4) == 0 {
                    self.out.push('\n');
                }
            }
        }
    }

    fn end(&mut self) {
        if self.mutations.comments && self.may_comment() && self.dice(9) == 0 {
            let spaces = 1 + self.dice(3);
            self.spaces(spaces);
            self.comment();
        }
        self.out.push('\n');
        self.behind_block = false;
    }

    /// Returns `true` if a comment may follow here. After an unquoted string, it would be an error.
    fn may_comment(&self) -> bool {
        let line = self.out.rsplit('\n').next().unwrap_or_default();
        let last = line.split(' ').next_back().unwrap_or_default();
        let is_number = last.starts_with(|it: char| it.is_ascii_digit())
            && last.chars().all(|it| it.is_ascii_alphanumeric());
        is_number || last.ends_with([':', '"', '\'', ']', '}', '{', '[', ',', '|', '-', '+'])
    }

    fn blank_above(&self, node: Node<'_>) -> bool {
        let above = self.text[..node.span().start].trim_end_matches([' ', '-']);
        above.ends_with("\n\n")
    }

    /// Writes the entries and items of a node. `shared`: the first one continues a line.
    fn block(&mut self, node: Node<'_>, indent: usize, mut shared: bool) {
        let mut entries: Vec<_> = node.entries().collect();
        let is_declared = ["zh", "en"]
            .iter()
            .all(|key| node.get(key).is_some_and(|text| text.as_str().is_some()));
        if self.mutations.order && is_declared {
            for index in (1..entries.len()).rev() {
                let other = self.dice(index + 1);
                entries.swap(index, other);
            }
        }
        for entry in entries {
            if !std::mem::take(&mut shared) {
                let blank = self.blank_above(entry.key);
                self.noise(indent, blank);
                self.spaces(indent);
            }
            self.scalar(entry.key, indent, false);
            self.out.push(':');
            let is_text = matches!(entry.name(), "zh" | "en");
            self.value(entry.value, indent, is_text, false);
        }
        for item in node.items() {
            if !std::mem::take(&mut shared) {
                let blank = self.blank_above(item);
                self.noise(indent, blank);
                self.spaces(indent);
            }
            self.out.push('-');
            self.value(item, indent, false, true);
        }
    }

    fn value(&mut self, node: Node<'_>, indent: usize, is_text: bool, is_item: bool) {
        let inner = indent + 1 + self.dice(5);
        let is_empty = node.items().count() + node.entries().count() == 0;
        if node.as_scalar().is_some() || node.is_null() || is_empty {
            return self.leaf(node, indent, inner, is_text);
        }
        let source = &self.text[node.span().start..];
        let first = node.items().next();
        let begins = first.is_none_or(|first| first.span().start > node.span().start);
        let mut flow = source.starts_with(['{', '[']) && begins;
        if self.mutations.brackets && self.dice(5) == 0 {
            flow = !flow && may_close(node);
        }
        if flow {
            let spaces = 1 + self.dice(2);
            self.spaces(spaces);
            self.flow(node, inner);
            self.end();
        } else if is_item && self.dice(4) > 0 {
            let spaces = 1 + self.dice(3);
            self.spaces(spaces);
            self.block(node, indent + 1 + spaces, true);
        } else {
            self.end();
            let is_list = node.as_sequence().is_some() && !is_item;
            let indent = if is_list && self.dice(2) == 0 {
                indent
            } else {
                inner
            };
            self.block(node, indent, false);
        }
    }

    fn flow(&mut self, node: Node<'_>, indent: usize) {
        let is_list = node.as_sequence().is_some();
        self.out.push(if is_list { '[' } else { '{' });
        let mut first = true;
        let children = node.items().map(|item| (None, item));
        let children: Vec<_> = children
            .chain(node.entries().map(|entry| (Some(entry.key), entry.value)))
            .collect();
        for (key, value) in children {
            if !std::mem::take(&mut first) {
                self.out.push(',');
            }
            self.gap(indent);
            if let Some(key) = key {
                self.scalar(key, indent, false);
                self.out.push_str(": ");
            }
            let is_empty = value.items().count() + value.entries().count() == 0;
            if value.as_scalar().is_some() || value.is_null() || is_empty {
                self.scalar(value, indent, false);
            } else {
                self.flow(value, indent);
            }
        }
        self.gap(indent);
        self.out.push(if is_list { ']' } else { '}' });
    }

    /// Writes white space inside brackets.
    fn gap(&mut self, indent: usize) {
        let may_comment = self.may_comment();
        let spaces = 1 + self.dice(2);
        self.spaces(spaces);
        let comments = self.mutations.comments && self.mutations.brackets;
        if comments && may_comment && self.dice(20) == 0 {
            self.comment();
            self.out.push('\n');
            self.spaces(indent);
        } else if self.dice(8) == 0 {
            self.out.push('\n');
            self.spaces(indent);
        }
    }

    fn leaf(&mut self, node: Node<'_>, indent: usize, inner: usize, is_text: bool) {
        let scalar = node.as_scalar();
        if node.is_null() {
            if self.mutations.texts && self.dice(2) == 0 {
                self.out.push_str(" ~");
            }
            return self.end();
        }
        let is_block = scalar.is_some_and(|scalar| scalar.style == Style::Block);
        let text = scalar.map(|scalar| scalar.text).unwrap_or_default();
        let could_be_block = self.mutations.texts && is_text && self.dice(6) == 0;
        let is_line = !text.is_empty() && !text.contains('\n') && text.trim() == text;
        if is_block || (could_be_block && is_line) {
            self.block_text(text, indent, inner);
            return;
        }
        let spaces = 1 + self.dice(2);
        self.spaces(spaces);
        self.scalar(node, inner, is_text);
        self.end();
    }

    fn block_text(&mut self, text: &str, indent: usize, inner: usize) {
        let body = text.trim_end_matches('\n');
        let chomp = match text.len() - body.len() {
            0 => "-",
            1 => "",
            _ => "+",
        };
        let digit = if body.starts_with(' ') || self.dice(6) == 0 {
            (inner - indent).to_string()
        } else {
            String::new()
        };
        write!(self.out, " |{digit}{chomp}").expect("a string");
        self.end();
        let lines = if chomp == "+" { text } else { body };
        let lines = lines.strip_suffix('\n').unwrap_or(lines);
        for line in lines.split('\n') {
            if !line.is_empty() {
                self.spaces(inner);
                self.out.push_str(line);
            }
            self.out.push('\n');
        }
        self.behind_block = true;
    }

    /// Writes a key or a scalar. `is_text`: the meaning is the same in quotes.
    fn scalar(&mut self, node: Node<'_>, indent: usize, is_text: bool) {
        let span = node.span();
        let written = &self.text[span.start..span.end];
        let Some(scalar) = node.as_scalar().filter(|it| !it.text.contains('\n')) else {
            self.out.push_str(written);
            return;
        };
        let is_quoted = scalar.style == Style::Quoted;
        if !self.mutations.texts || !(is_quoted || (is_text && self.dice(4) == 0)) {
            self.out.push_str(written);
            return;
        }
        let quoted = match self.dice(3) {
            0 if !scalar.text.contains(['"', '\\']) => format!("\"{}\"", scalar.text),
            1 => format!("'{}'", scalar.text.replace('\'', "''")),
            _ if is_quoted => written.to_owned(),
            _ => format!("'{}'", scalar.text.replace('\'', "''")),
        };
        // A single space may become a line break.
        let fold = quoted.match_indices(' ').map(|(at, _)| at).find(|at| {
            let around = (&quoted[..*at], &quoted[at + 1..]);
            !around.0.ends_with([' ', '\'', '"', '\\', '#', ':'])
                && !around.1.starts_with([' ', '\'', '"', '#', '-'])
        });
        match fold.filter(|_| is_text && self.dice(4) == 0) {
            Some(at) => {
                self.out.push_str(&quoted[..at]);
                self.out.push('\n');
                self.spaces(indent);
                self.out.push_str(&quoted[at + 1..]);
            }
            None => self.out.push_str(&quoted),
        }
    }
}

/// Returns `true` if the node has the same meaning inside brackets.
fn may_close(node: Node<'_>) -> bool {
    let is_plain = |text: &str| {
        !text.contains(|it: char| ",[]{}?#:&*!|>'\"%@`\n".contains(it)) && !text.is_empty()
    };
    match node.kind() {
        NodeKind::Null => false,
        NodeKind::Scalar(scalar) => match scalar.style {
            Style::Plain => is_plain(scalar.text),
            Style::Quoted => !scalar.text.contains('\n'),
            Style::Block => false,
        },
        NodeKind::Sequence(mut items) => items.all(|item| may_close(item)),
        NodeKind::Mapping(mut entries) => {
            entries.all(|it| may_close(it.key) && may_close(it.value))
        }
    }
}
