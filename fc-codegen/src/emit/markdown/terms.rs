//! Finds the terms of the glossary in the spec's sentences and links them to their entries.
//!
//! The first use of a term is known only when the page is complete. Until then, marks surround the spec's sentences.
//! Phrases of the templates are not marked, because they mean the same in any protocol.

use super::escape;
use super::links::{Anchor, Page};
use fc_spec::model::Lang;
use fc_spec::model::Term;
use std::cmp::Reverse;
use std::collections::{HashMap, HashSet};

/// The terms of the glossary in one language.
pub(super) struct Terms<'m> {
    /// Words and their terms, by the first character in lower case. Longer words come first.
    words: HashMap<char, Vec<(&'m str, &'m Term)>>,
}

impl<'m> Terms<'m> {
    pub(super) fn new(glossary: &'m [Term], lang: Lang) -> Self {
        let mut words: HashMap<char, Vec<(&str, &Term)>> = HashMap::new();
        for term in glossary {
            let others = lang.pick(&term.also.zh, &term.also.en);
            let own = std::iter::once(lang.text(&term.word));
            for word in own.chain(others.iter().map(String::as_str)) {
                if let Some(first) = word.chars().next() {
                    let words = words.entry(first.to_ascii_lowercase()).or_default();
                    words.push((word, term));
                }
            }
        }
        for words in words.values_mut() {
            words.sort_by_key(|(word, _)| Reverse(word.len()));
        }
        Self { words }
    }

    /// Returns the terms in a text of the spec, each once. Code and links do not count.
    pub(super) fn in_text(&self, text: &str) -> Vec<&'m Term> {
        let mut found: Vec<&Term> = Vec::new();
        self.rewritten(text, &mut true, &mut |term, _| {
            if !found.iter().any(|known| known.id == term.id) {
                found.push(term);
            }
            None
        });
        found
    }

    /// Links the first use of each term in a text of the spec, except for the term `but`.
    pub(super) fn linked(&self, page: Page<'_>, text: &str, but: &Term) -> String {
        let mut known = HashSet::from([but.id.as_str()]);
        self.rewritten(text, &mut true, &mut |term, word| {
            known.insert(&term.id).then(|| link(page, term, word))
        })
    }

    /// Links the first use of each term on a page and removes the marks.
    ///
    /// Headings, table heads, code and existing links stay unchanged. On a page that collects texts from many files,
    /// each section counts as a page. Readers arrive at a section by its anchor. A new term in one section must not
    /// change lines elsewhere, because branches that each add one could not be merged.
    pub(super) fn first_uses(&self, page: Page<'_>, contents: &str) -> String {
        let each_section = match page {
            _ if self.words.is_empty() => return contents.replace(MARKS, ""),
            Page::Wire | Page::Codes | Page::Results | Page::Operation(_) => false,
            Page::Index | Page::Types | Page::Tables => true,
            // Most of these pages are lists whose lines come from other pages or are links. The page of the language
            // consists of separate cells. The glossary has its own links.
            Page::Entities
            | Page::Places
            | Page::Changelog
            | Page::OpenQuestions
            | Page::Language
            | Page::Errors
            | Page::Glossary => return contents.replace(MARKS, ""),
        };
        let mut known: HashSet<&str> = HashSet::new();
        let mut is_marked = false;
        let mut out = String::with_capacity(contents.len());
        for block in blocks(contents) {
            match block {
                Block::Heading(line) => {
                    if each_section {
                        known.clear();
                    }
                    unmarked(line, &mut is_marked, &mut out);
                }
                Block::Kept(line) => unmarked(line, &mut is_marked, &mut out),
                Block::Prose(text) => {
                    out.push_str(&self.rewritten(text, &mut is_marked, &mut |term, word| {
                        known.insert(&term.id).then(|| link(page, term, word))
                    }));
                }
            }
        }
        out
    }

    /// Replaces the words of terms in marked parts of a text. `replace` returns the replacement, or `None` to keep a
    /// word.
    fn rewritten(
        &self,
        text: &str,
        is_marked: &mut bool,
        replace: &mut dyn FnMut(&'m Term, &str) -> Option<String>,
    ) -> String {
        let mut out = String::with_capacity(text.len());
        let mut rest = text;
        loop {
            // Most characters start none of these.
            let at = rest.find(|character: char| {
                let begins_word = || self.words.contains_key(&character.to_ascii_lowercase());
                MARKUP.contains(&character)
                    || MARKS.contains(&character)
                    || (*is_marked && begins_word())
            });
            let (plain, from) = rest
                .split_at_checked(at.unwrap_or(rest.len()))
                .unwrap_or((rest, ""));
            out.push_str(plain);
            rest = from;
            let Some(first) = rest.chars().next() else {
                return out;
            };
            let before = out.chars().next_back();
            let markup = markup(rest);
            let word = match markup {
                None if *is_marked => self.word(before, rest),
                _ => None,
            };
            let len = markup.or(word.map(|(len, _)| len));
            let (piece, behind) = rest
                .split_at_checked(len.unwrap_or(first.len_utf8()))
                .unwrap_or((rest, ""));
            // In Chinese, a link next to asterisks would break the emphasis.
            let is_emphasised = before == Some('*') || behind.starts_with('*');
            let replaced = word.filter(|_| !is_emphasised);
            match replaced.and_then(|(_, term)| replace(term, piece)) {
                Some(replaced) => out.push_str(&replaced),
                None => unmarked(piece, is_marked, &mut out),
            }
            rest = behind;
        }
    }

    /// Returns the length and the term of the longest word at the start of a text.
    fn word(&self, before: Option<char>, text: &str) -> Option<(usize, &'m Term)> {
        let first = text.chars().next()?;
        let words = self.words.get(&first.to_ascii_lowercase())?;
        let found = words.iter().find(|(word, _)| {
            // Case matters after the first character.
            let rest = (text.get(first.len_utf8()..)).zip(word.get(first.len_utf8()..));
            let behind = rest.and_then(|(text, word)| text.strip_prefix(word));
            behind.is_some_and(|behind| is_whole(word, before, behind.chars().next()))
        });
        found.map(|(word, term)| (word.len(), *term))
    }
}

/// The marks around a sentence of the spec. They are noncharacters of Unicode, so no text contains them.
const MARKS: [char; 2] = ['\u{FDD0}', '\u{FDD1}'];

/// Marks Markdown of the spec.
pub(super) fn marked(markdown: &str) -> String {
    let [open, close] = MARKS;
    if markdown.is_empty() {
        return String::new();
    }
    format!("{open}{markdown}{close}")
}

/// Adds a text without its marks. `is_marked` is `true` inside marks, before and after the call.
fn unmarked(text: &str, is_marked: &mut bool, out: &mut String) {
    for character in text.chars() {
        if MARKS.contains(&character) {
            *is_marked = MARKS.first() == Some(&character);
        } else {
            out.push(character);
        }
    }
}

/// Returns `true` if a word is not part of a longer word, a name or a path. Chinese has no spaces between words.
fn is_whole(word: &str, before: Option<char>, behind: Option<char>) -> bool {
    let is_latin = |character: char| character.is_ascii_alphanumeric() || character == '_';
    let goes_on = |character: char| is_latin(character) || matches!(character, '/' | '-');
    let begins = !word.starts_with(is_latin)
        || !before.is_some_and(|character| goes_on(character) || character == '.');
    begins && (!word.ends_with(is_latin) || !behind.is_some_and(goes_on))
}

fn link(page: Page<'_>, term: &Term, word: &str) -> String {
    let href = page.link((Page::Glossary, Anchor::of("term", &term.id)));
    format!("[{word}]({href})")
}

/// The characters that start [`markup`].
const MARKUP: [char; 5] = ['`', '[', '<', '\\', '&'];

/// Returns the length of the code span, link, tag, entity or escaped character at the start of a text.
fn markup(text: &str) -> Option<usize> {
    match text.chars().next()? {
        '`' => {
            let inside = text.trim_start_matches('`');
            let ticks = text.len() - inside.len();
            Some(ticks + escape::closing(inside, ticks).unwrap_or(0))
        }
        '[' => {
            let mut depth = 0_usize;
            let end = text.find(|character| {
                match character {
                    '[' => depth += 1,
                    ']' => depth = depth.saturating_sub(1),
                    _ => {}
                }
                depth == 0
            })?;
            let link = text.get(end..)?;
            link.starts_with("](")
                .then(|| Some(end + link.find(')')? + 1))?
        }
        '<' => {
            // These elements contain a link, or a word with a border.
            let closing = ["a", "span"]
                .into_iter()
                .find(|name| {
                    text.get(1..)
                        .is_some_and(|tag| tag.starts_with(&format!("{name} ")))
                })
                .map_or_else(|| ">".to_owned(), |name| format!("</{name}>"));
            Some(text.find(&closing)? + closing.len())
        }
        '\\' => Some(1 + text.chars().nth(1)?.len_utf8()),
        '&' => {
            let end = text.find(';')?;
            let name = text.get(1..end)?;
            let is_name = !name.is_empty() && name.chars().all(|it| it.is_ascii_alphanumeric());
            is_name.then_some(end + 1)
        }
        _ => None,
    }
}

/// A part of a page, with its line breaks.
enum Block<'p> {
    Heading(&'p str),
    /// Front matter, code, a table head or a comment.
    Kept(&'p str),
    /// A paragraph, a list item or a table row.
    Prose(&'p str),
}

fn blocks(page: &str) -> Vec<Block<'_>> {
    let front = page.strip_prefix(FRONT);
    let front = front.and_then(|rest| Some(FRONT.len() + rest.find(FRONT)? + FRONT.len()));
    let (front, body) = page
        .split_at_checked(front.unwrap_or(0))
        .unwrap_or(("", page));
    let mut blocks = vec![Block::Kept(front)];
    let mut fence: Option<&str> = None;
    // The start of the current paragraph, and of the current line.
    let (mut from, mut at) = (0, 0);
    let mut lines = body.split_inclusive('\n').peekable();
    while let Some(line) = lines.next() {
        let line_start = line.trim_start_matches(MARKS);
        let start = line_start.trim_start();
        let is_fence = start.starts_with("```") || start.starts_with("~~~");
        let is_head = lines.peek().is_some_and(|next| next.starts_with("|---"));
        let is_heading = fence.is_none() && line_start.starts_with('#');
        let is_kept = fence.is_some() || is_fence || is_head || start.starts_with("<!--");
        if is_heading || is_kept || start.is_empty() || start.starts_with(['|', '-']) {
            blocks.extend(body.get(from..at).map(Block::Prose));
            from = at;
        }
        match fence {
            Some(open) if is_closing(start, open) => fence = None,
            None if is_fence => {
                let end = start.find(|character| !matches!(character, '`' | '~'));
                fence = start.get(..end.unwrap_or(start.len()));
            }
            _ => {}
        }
        at += line.len();
        if is_heading || is_kept {
            let block = if is_heading {
                Block::Heading
            } else {
                Block::Kept
            };
            blocks.push(block(line));
            from = at;
        }
    }
    blocks.extend(body.get(from..).map(Block::Prose));
    blocks
}

fn is_closing(line: &str, fence: &str) -> bool {
    line.trim_end().trim_end_matches(MARKS) == fence
}

/// The delimiter of the front matter.
const FRONT: &str = "---\n";

#[cfg(test)]
mod tests {
    use super::*;
    use fc_spec::model::{Aliases, Location, Text};

    fn term(zh: &str, en: &str, also_zh: &[&str], also_en: &[&str]) -> Term {
        let text = |zh: &str, en: &str| Text {
            zh: zh.to_owned(),
            en: en.to_owned(),
        };
        let words = |words: &[&str]| words.iter().map(|word| (*word).to_owned()).collect();
        Term {
            id: en.replace(' ', "_"),
            word: text(zh, en),
            means: text("含义", "Meaning"),
            also: Aliases {
                zh: words(also_zh),
                en: words(also_en),
            },
            location: Location {
                file: "spec/protocol.yaml".to_owned(),
                name: "glossary".to_owned(),
                line: 1,
            },
        }
    }

    fn glossary() -> Vec<Term> {
        vec![
            term("桩", "dock", &[], &["docks"]),
            term("退桩点", "undocking point", &[], &[]),
            term("站点", "station", &["点位"], &["stations"]),
            term("SN", "serial number", &[], &[]),
        ]
    }

    fn first_uses(lang: Lang, page: Page<'_>, contents: &str) -> String {
        Terms::new(&glossary(), lang).first_uses(page, contents)
    }

    #[test]
    fn the_first_use_of_a_term_is_a_link() {
        const DOCK: &str = "(glossary.md#term-dock)";
        const STATION: &str = "(glossary.md#term-station)";
        let zh: [(&str, &str); 6] = [
            (
                "到达退桩点，再上桩。",
                "到达[退桩点](glossary.md#term-undocking_point)，再上[桩]D。",
            ),
            ("站点、点位、站点", "[站点]S、点位、站点"),
            ("这些点位，那些站点", "这些[点位]S，那些站点"),
            ("**站点**：站点", "**站点**：[站点]S"),
            (
                "把SN写进SNR和 SN 里",
                "把[SN](glossary.md#term-serial_number)写进SNR和 SN 里",
            ),
            ("没有", "没有"),
        ];
        let en = [
            (
                "Stations, a station and a dock",
                "[Stations]S, a station and a [dock]D",
            ),
            ("undock, docked, docks.", "undock, docked, [docks]D."),
            (
                "a dock-side /dock/ my_dock station.name, DOCK",
                "a dock-side /dock/ my_dock [station]S.name, DOCK",
            ),
            ("the station's dock", "the [station]S's [dock]D"),
            (
                "an undocking\npoint, an Undocking point",
                "an undocking\npoint, an [Undocking point](glossary.md#term-undocking_point)",
            ),
            (
                "`station` ``a ` dock`` ` station",
                "`station` ``a ` dock`` ` [station]S",
            ),
            (
                "[station](x.md#dock) [a dock] station",
                "[station](x.md#dock) [a [dock]D] [station]S",
            ),
            (
                "\\dock <a id=\"dock\"></a><span class=\"dock\">dock</span> <br>dock",
                "\\dock <a id=\"dock\"></a><span class=\"dock\">dock</span> <br>[dock]D",
            ),
        ];
        for (lang, cases) in [(Lang::Zh, &zh[..]), (Lang::En, &en[..])] {
            for (text, expected) in cases {
                let expected = expected.replace("]D", &format!("]{DOCK}"));
                let expected = expected.replace("]S", &format!("]{STATION}"));
                let found = first_uses(lang, Page::Wire, &marked(text));
                assert_eq!(found, expected, "{text}");
            }
        }
    }

    /// Each `@` makes a link of the word before it. Each `#` does too, if every section has its own links.
    #[test]
    fn headings_code_and_heads_of_tables_stay() {
        const FRONT_MATTER: &str = "---
title: dock
---
";
        const PAGE: &str = "
# The dock

<!-- dock -->

| dock | x |
|---|---|
| `dock` | a dock@ |

```text
dock

# no heading: dock
```

## A dock

- a dock#, a station@
  of a dock
";
        let expected = |dock: &str| {
            let page = PAGE.replace("dock#", dock);
            let page = page.replace("dock@", "[dock](glossary.md#term-dock)");
            let page = page.replace("station@", "[station](glossary.md#term-station)");
            format!("{FRONT_MATTER}{page}")
        };
        let body = PAGE.replace('@', "").replace("dock#", "dock");
        let source = format!("{FRONT_MATTER}{}", marked(&body));
        let plain = format!("{FRONT_MATTER}{body}");
        assert_eq!(first_uses(Lang::En, Page::Wire, &source), expected("dock"));
        // In separate sections, each section has its own links.
        let again = expected("[dock](glossary.md#term-dock)");
        assert_eq!(first_uses(Lang::En, Page::Types, &source), again);
        assert_eq!(first_uses(Lang::En, Page::Changelog, &source), plain);
        // Text outside the marks stays unchanged.
        assert_eq!(first_uses(Lang::En, Page::Wire, &plain), plain);
    }

    #[test]
    fn an_entry_does_not_link_itself() {
        let glossary = glossary();
        let terms = Terms::new(&glossary, Lang::Zh);
        let station = glossary.iter().find(|term| term.id == "station");
        let linked = station.map(|it| terms.linked(Page::Glossary, "站点在桩前，离桩不远", it));
        assert_eq!(
            linked.as_deref(),
            Some("站点在[桩](#term-dock)前，离桩不远")
        );
        let found = terms.in_text("桩、点位、站点和 `SN`");
        let found: Vec<&str> = found.into_iter().map(|term| term.id.as_str()).collect();
        assert_eq!(found, ["dock", "station"]);
    }
}
