//! The words of the glossary in the spec's sentences: where they are, and links from them to what they mean.
//!
//! Which use is the first on a page is known when the page is. Until then the spec's sentences stand between marks,
//! apart from the phrases of the templates, which mean what they say in any protocol.

use super::escape;
use super::links::{Anchor, Page};
use fc_spec::model::Lang;
use fc_spec::model::Term;
use std::cmp::Reverse;
use std::collections::{HashMap, HashSet};

/// The words of the glossary in one language.
pub(super) struct Terms<'m> {
    /// With their terms, by the first character in lower case; longer words first.
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

    /// The terms in a text of the spec, each once. Code and links in it do not count.
    pub(super) fn of(&self, text: &str) -> Vec<&'m Term> {
        let mut found: Vec<&Term> = Vec::new();
        self.rewritten(text, &mut true, &mut |term, _| {
            if !found.iter().any(|known| known.id == term.id) {
                found.push(term);
            }
            None
        });
        found
    }

    /// A text of the spec with a link from the first use of each term but for one.
    pub(super) fn linked(&self, page: Page<'_>, text: &str, but: &Term) -> String {
        let mut known = HashSet::from([but.id.as_str()]);
        self.rewritten(text, &mut true, &mut |term, word| {
            known.insert(&term.id).then(|| link(page, term, word))
        })
    }

    /// A page with a link from the first use of each term, without marks.
    ///
    /// Headings, the heads of tables, code and existing links stay as they are. Where a page gathers what many files
    /// say, each of its sections is as a page of its own: a reader comes to it by its anchor, and what is added in
    /// one place must change no line elsewhere, or two branches that each add something could not be merged.
    pub(super) fn first_uses(&self, page: Page<'_>, contents: &str) -> String {
        let each_section = match page {
            _ if self.words.is_empty() => return contents.replace(MARKS, ""),
            Page::Wire | Page::Codes | Page::Results | Page::Operation(_) => false,
            Page::Index | Page::Types | Page::Tables => true,
            // Registers, in which every line is from somewhere else or only links; the language, in which a cell is one of a table;
            // and the glossary, which links its own.
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

    /// A text in which words of terms are replaced by what `replace` makes of them, if anything, where it is marked.
    fn rewritten(
        &self,
        text: &str,
        is_marked: &mut bool,
        replace: &mut dyn FnMut(&'m Term, &str) -> Option<String>,
    ) -> String {
        let mut out = String::with_capacity(text.len());
        let mut rest = text;
        loop {
            // Most of a text is none of this.
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
            // A link would keep the asterisks beside it from opening or closing emphasis in Chinese.
            let is_emphasised = before == Some('*') || behind.starts_with('*');
            let replaced = word.filter(|_| !is_emphasised);
            match replaced.and_then(|(_, term)| replace(term, piece)) {
                Some(replaced) => out.push_str(&replaced),
                None => unmarked(piece, is_marked, &mut out),
            }
            rest = behind;
        }
    }

    /// The longest word with which a text begins: its length, and its term.
    fn word(&self, before: Option<char>, text: &str) -> Option<(usize, &'m Term)> {
        let first = text.chars().next()?;
        let words = self.words.get(&first.to_ascii_lowercase())?;
        let found = words.iter().find(|(word, _)| {
            // Case matters from the second letter on.
            let rest = (text.get(first.len_utf8()..)).zip(word.get(first.len_utf8()..));
            let behind = rest.and_then(|(text, word)| text.strip_prefix(word));
            behind.is_some_and(|behind| is_whole(word, before, behind.chars().next()))
        });
        found.map(|(word, term)| (word.len(), *term))
    }
}

/// Around a sentence of the spec in a page that is being made. They are no characters of any text.
const MARKS: [char; 2] = ['\u{FDD0}', '\u{FDD1}'];

/// Marks Markdown that is the spec's.
pub(super) fn marked(markdown: &str) -> String {
    let [open, close] = MARKS;
    if markdown.is_empty() {
        return String::new();
    }
    format!("{open}{markdown}{close}")
}

/// Adds a text without its marks; `is_marked` is whether it begins, and then whether it ends, between two.
fn unmarked(text: &str, is_marked: &mut bool, out: &mut String) {
    for character in text.chars() {
        if MARKS.contains(&character) {
            *is_marked = MARKS.first() == Some(&character);
        } else {
            out.push(character);
        }
    }
}

/// Whether a word is not part of a longer one, of a name or of a path. Chinese is written without spaces.
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

/// With what [`markup`] begins.
const MARKUP: [char; 5] = ['`', '[', '<', '\\', '&'];

/// Length of the code span, link, tag, entity or escaped character with which a text begins.
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
            // What these hold is a link, or a word in a frame.
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

/// A part of a page, its line breaks included.
enum Block<'p> {
    Heading(&'p str),
    /// Front matter, code, the head of a table, a comment.
    Kept(&'p str),
    /// A paragraph, an item of a list or a row of a table.
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
    // Where the paragraph begins that is being read, and where the line.
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

/// What begins and ends the front matter.
const FRONT: &str = "---\n";

#[cfg(test)]
mod tests {
    use super::*;
    use fc_spec::model::{Aliases, Location, Text};

    /// `zh`, `en` and the other forms of both.
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

    /// Each `@` makes a link of the word before it; each `#` does, too, where every section has links of its own.
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
        // A section of its own has links of its own.
        let again = expected("[dock](glossary.md#term-dock)");
        assert_eq!(first_uses(Lang::En, Page::Types, &source), again);
        assert_eq!(first_uses(Lang::En, Page::Changelog, &source), plain);
        // What the spec does not say is left alone.
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
        let found = terms.of("桩、点位、站点和 `SN`");
        let found: Vec<&str> = found.into_iter().map(|term| term.id.as_str()).collect();
        assert_eq!(found, ["dock", "station"]);
    }
}
