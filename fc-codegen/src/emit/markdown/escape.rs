//! From the spec's texts to Markdown that is safe in a table, in `VitePress` and on its own.
//!
//! The spec's texts are Markdown themselves, so code spans, emphasis and links in them stay. What
//! they cannot do is break out of their place: `<` would open a Vue component, two braces a Vue
//! expression, one brace the attributes of `VitePress`'s Markdown, `|` and a line break the next cell.

/// Text within a line, outside of tables.
#[must_use]
pub fn text(source: &str) -> String {
    inline(&one_line(source))
}

/// Text in a table cell.
#[must_use]
pub fn cell(source: &str) -> String {
    let lines = source.trim().lines();
    let mut lines = lines.map(|line| bars_escaped(inline(line.trim())));
    let mut out = lines.next().unwrap_or_default();
    for line in lines {
        out.extend(["<br>", &line]);
    }
    out
}

/// A bar would end the cell.
fn bars_escaped(markdown: String) -> String {
    if markdown.contains('|') {
        markdown.replace('|', "\\|")
    } else {
        markdown
    }
}

/// Paragraphs and lists; fenced code in them stays as it is.
#[must_use]
pub fn prose(source: &str) -> String {
    let mut out = String::new();
    let mut open_fence: Option<&str> = None;
    let mut paragraph = String::new();
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
        out.push_str(&inline(&std::mem::take(&mut paragraph)));
        out.push_str(line);
        out.push('\n');
        match (open_fence, marker) {
            (None, Some(_)) => open_fence = marker,
            (Some(open), Some(close)) if open == close && is_bare(start) => open_fence = None,
            _ => {}
        }
    }
    out.push_str(&inline(&paragraph));
    // A fence that its author forgot to close would swallow the rest of the page.
    out.push_str(open_fence.unwrap_or_default());
    out.truncate(out.trim_end().len());
    out
}

/// Whether a line is nothing but a fence, as a closing one is.
fn is_bare(fence: &str) -> bool {
    let mut characters = fence.trim_end().chars();
    let first = characters.next();
    characters.all(|character| Some(character) == first)
}

/// A code span, outside of tables. Empty for an empty text: Markdown has no empty code span.
///
/// Vue looks for its braces in code spans too, so two braces that meet end one span and begin
/// another, with a comment between them that nobody sees.
#[must_use]
pub fn code(source: &str) -> String {
    let source = one_line(source);
    let mut out = String::with_capacity(source.len() + 2);
    let mut rest = source.as_str();
    while let Some(brace) = rest.find("{{") {
        let (span, behind) = rest.split_at(brace + 1);
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

/// A code span in a table cell.
#[must_use]
pub fn code_cell(source: &str) -> String {
    bars_escaped(code(source))
}

/// A fenced code block.
#[must_use]
pub fn fence(source: &str, language: &str) -> String {
    let ticks = "`".repeat((longest_run(source) + 1).max(3));
    format!(
        "{ticks}{language}\n{}\n{ticks}",
        source.trim_end_matches('\n')
    )
}

/// A string of a YAML front matter: JSON strings are YAML.
#[must_use]
pub fn yaml(source: &str) -> String {
    fc_spec::model::Value::String(one_line(source)).to_string()
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

/// Escapes what stands outside of code spans.
fn inline(source: &str) -> String {
    let mut out = String::with_capacity(source.len());
    let mut rest = source;
    while let Some(start) = rest.find('`') {
        let (before, from_ticks) = rest.split_at(start);
        let ticks = from_ticks.len() - from_ticks.trim_start_matches('`').len();
        let (opening, inside) = from_ticks.split_at(ticks);
        push_outside_code(&mut out, before);
        rest = if let Some(end) = closing(inside, ticks) {
            let (span, after) = inside.split_at(end);
            let content = span.strip_suffix(opening).unwrap_or(span);
            out.push_str(&code(content.trim()));
            after
        } else {
            out.push_str(opening);
            inside
        };
    }
    push_outside_code(&mut out, rest);
    out
}

/// Where the code span that `ticks` backticks opened ends, its closing backticks included.
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

fn push_outside_code(out: &mut String, source: &str) {
    let mut rest = source;
    while let Some(at) = rest.find(['<', '{', '\\']) {
        let (plain, from) = rest.split_at(at);
        let (special, behind) = from.split_at(1);
        let before_brace = behind.starts_with('{');
        out.push_str(plain);
        out.push_str(match special {
            "<" => "&lt;",
            // The comment keeps Vue from seeing two braces; a reader of the page sees none.
            "{" if before_brace => "\\{<!-- -->",
            "{" => "\\{",
            // What the author escaped himself stays escaped once.
            _ if before_brace => "",
            backslash => backslash,
        });
        rest = behind;
    }
    out.push_str(rest);
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
mod tests {
    use super::*;

    #[test]
    fn texts_stay_in_their_place() {
        for (source, expected) in [
            ("a <b> c", "a &lt;b> c"),
            ("`a <b>` c", "`a <b>` c"),
            ("{x} {{ y }}", "\\{x} \\{<!-- -->\\{ y }}"),
            ("\\{x}", "\\{x}"),
            ("`{{ y }}`", "`{`<!-- -->`{ y }}`"),
            ("`{{{`", "`{`<!-- -->`{`<!-- -->`{`"),
            ("a ` b <c>", "a ` b &lt;c>"),
            ("``a ` b``", "``a ` b``"),
            ("one\n  two\n", "one two"),
        ] {
            assert_eq!(text(source), expected, "{source}");
        }
    }

    #[test]
    fn cells_hold_one_line_and_no_bar() {
        assert_eq!(cell("a|b\n`c|d`"), "a\\|b<br>`c\\|d`");
        assert_eq!(code_cell("a|b"), "`a\\|b`");
    }

    #[test]
    fn code_spans_outlast_their_backticks() {
        assert_eq!(code("a"), "`a`");
        assert_eq!(code("a`b"), "``a`b``");
        assert_eq!(code("`"), "`` ` ``");
        assert_eq!(code(" "), "");
        assert_eq!(fence("```", "text"), "````text\n```\n````");
    }

    #[test]
    fn prose_keeps_its_fences() {
        let source = "a {b}\n\n```text\n{{ c }} <d>\n```\n\n<e>\n";
        let expected = "a \\{b}\n\n```text\n{{ c }} <d>\n```\n\n&lt;e>";
        assert_eq!(prose(source), expected);
        assert_eq!(prose("```\n<a>"), "```\n<a>\n```");
        assert_eq!(prose("~~~\n```x\n~~~\n<a>"), "~~~\n```x\n~~~\n&lt;a>");
    }
}
