//! Extracts the English text of a file: prose, comments, literals and names of tests.

use std::path::Path;

/// Returns the paragraphs, items and cells of Markdown, without code and headings.
pub fn prose(text: &str) -> Vec<String> {
    let mut blocks = vec![String::new()];
    let mut fence: Option<&str> = None;
    let text = text.strip_prefix("---\n").map_or(text, |rest| {
        rest.split_once("\n---\n").map_or(rest, |(_, text)| text)
    });
    for line in text.lines() {
        let trimmed = line.trim();
        let mark = ["```", "~~~"]
            .into_iter()
            .find(|it| trimmed.starts_with(it));
        match (fence, mark) {
            (Some(open), Some(mark)) if open == mark => fence = None,
            (None, Some(mark)) => fence = Some(mark),
            _ => {}
        }
        let is_kept = fence.is_none() && mark.is_none() && !trimmed.starts_with(['#', '<']);
        if !is_kept || trimmed.is_empty() {
            blocks.push(String::new());
        } else if trimmed.starts_with('|') {
            let cells = trimmed.split('|').flat_map(|cell| cell.split("<br>"));
            blocks.extend(cells.map(plain));
            blocks.push(String::new());
        } else {
            let is_item = trimmed.starts_with(['-', '*', '>'])
                || trimmed.starts_with(|c: char| c.is_ascii_digit());
            let text = plain(trimmed.trim_start_matches(['-', '*', '>', ' ']));
            match blocks.last_mut().filter(|_| !is_item) {
                Some(block) => block.push_str(&(" ".to_owned() + &text)),
                None => blocks.push(text),
            }
        }
    }
    blocks
}

/// Removes links, tags and emphasis.
fn plain(text: &str) -> String {
    let mut out = String::new();
    let mut rest = text;
    while let Some(at) = rest.find(['[', ']', '<', '*']) {
        let (before, from) = rest.split_at(at);
        out.push_str(before);
        let end = match from.as_bytes()[0] {
            b']' if from.starts_with("](") => from.find(')').map_or(1, |end| end + 1),
            b'<' => from.find('>').map_or(1, |end| end + 1),
            _ => 1,
        };
        rest = &from[end..];
    }
    out + rest
}

/// Returns the part of a file's name after its dot.
pub fn ending(path: &Path) -> Option<&str> {
    path.extension().and_then(|ending| ending.to_str())
}

/// Returns the comment marks for files with this ending. Scripts have no ending and use `#`.
pub fn marks(ending: Option<&str>) -> Option<&'static [&'static str]> {
    match ending {
        Some("rs" | "cs") => Some(&["///", "//!", "//"]),
        Some("ts" | "js" | "mjs" | "vue" | "kt" | "kts" | "java" | "cpp" | "hpp") => {
            Some(&["///", "//", "/**", "/*", "*/", "*"])
        }
        Some("py" | "sh" | "toml" | "cmake" | "yml") | None => Some(&["#"]),
        Some(_) => None,
    }
}

/// Returns the comments of a source file, one paragraph each.
pub fn comments(path: &Path, text: &str) -> Vec<String> {
    let ending = ending(path);
    let Some(marks) = marks(ending) else {
        return Vec::new();
    };
    let mut blocks = vec![String::new()];
    let mut is_in_docstring = false;
    for line in text.lines() {
        let line = line.trim();
        let comment = if ending == Some("py") && (is_in_docstring || line.contains("\"\"\"")) {
            is_in_docstring ^= line.matches("\"\"\"").count() % 2 == 1;
            Some(line.trim_start_matches(['f', 'r']).trim_matches('"'))
        } else if line.starts_with("#!") {
            None
        } else {
            let mark = marks.iter().find(|mark| line.starts_with(**mark));
            mark.map(|mark| line[mark.len()..].trim_end_matches("*/").trim())
        };
        match comment {
            Some(text) if !text.is_empty() && !text.starts_with(['-', '|', '#', '@']) => {
                if let Some(block) = blocks.last_mut() {
                    block.push(' ');
                    block.push_str(&plain(text));
                }
            }
            Some(text) => blocks.push(plain(text.trim_start_matches(['-', '|', '#', ' ']))),
            None => blocks.push(String::new()),
        }
    }
    blocks
}

/// Returns the string literals of a Rust file that have at least four words. Tests at the end of the file do not count.
pub fn literals(text: &str) -> Vec<String> {
    let text = text.split("#[cfg(test)]").next().unwrap_or_default();
    let mut blocks = Vec::new();
    let mut rest = text;
    while let Some(at) = rest.find(['"', '/', '\'']) {
        let (before, from) = rest.split_at(at);
        rest = &from[1..];
        if from.starts_with("//") {
            rest = from.find('\n').map_or("", |end| &from[end..]);
        } else if let Some(behind) = QUOTES.iter().find_map(|it| from.strip_prefix(it)) {
            rest = behind;
        } else if let Some(inside) = from.strip_prefix('"') {
            let (literal, behind) = literal(before, inside);
            let text = literal.replace("\\\n", " ").replace("\\n", "\n");
            let paragraphs = text.split("\n\n").filter(|it| is_text(it));
            blocks.extend(paragraphs.map(|it| plain(&without_holes(it))));
            rest = behind;
        }
    }
    blocks
}

/// Character literals that contain a quote.
const QUOTES: [&str; 2] = ["'\"'", "'\\\"'"];

/// Returns the content of a literal, and the source after it. `before` is the source before its quote.
fn literal<'t>(before: &str, inside: &'t str) -> (&'t str, &'t str) {
    let mark = before.trim_end_matches('#');
    if mark.ends_with('r') {
        let close = format!("\"{}", "#".repeat(before.len() - mark.len()));
        return inside.split_once(&close).unwrap_or((inside, ""));
    }
    let mut is_escaped = false;
    let end = inside.find(|c: char| {
        let ends = c == '"' && !is_escaped;
        is_escaped = c == '\\' && !is_escaped;
        ends
    });
    let (literal, behind) = inside.split_at(end.unwrap_or(inside.len()));
    (literal, behind.strip_prefix('"').unwrap_or_default())
}

/// Replaces each argument of a format string by one word.
fn without_holes(format: &str) -> String {
    let mut parts = format.split('{');
    let mut out = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        out.push('X');
        out.push_str(part.split_once('}').map_or(part, |(_, rest)| rest));
    }
    out
}

/// Returns `true` if a literal is text for people and not code.
fn is_text(literal: &str) -> bool {
    let is_word =
        |word: &&str| word.len() > 1 && word.bytes().all(|byte| byte.is_ascii_alphabetic());
    literal.split_whitespace().filter(is_word).count() >= 4
}

/// Returns the names of the tests in a file, with spaces between their words.
pub fn test_names(path: &Path, text: &str) -> Vec<String> {
    let ending = ending(path);
    let mut names = Vec::new();
    let mut is_test = false;
    for line in text.lines().map(str::trim) {
        let name = match ending {
            Some("rs") => {
                is_test |=
                    line.starts_with("#[") && line.contains("test]") | line.contains("test(");
                let function = line.split_once("fn ").filter(|_| is_test);
                is_test &= function.is_none();
                function.and_then(|(_, rest)| rest.split(['(', '<']).next())
            }
            Some("py") => (line.strip_prefix("def test_"))
                .or_else(|| line.strip_prefix("async def test_"))
                .and_then(|rest| rest.split('(').next()),
            Some("mjs" | "ts") => ["test('", "test(\"", "it('", "it(\""]
                .into_iter()
                .find_map(|start| line.strip_prefix(start))
                .and_then(|rest| rest.split(['\'', '"']).next()),
            _ => None,
        };
        names.extend(name.map(|name| name.replace('_', " ")));
    }
    names
}
