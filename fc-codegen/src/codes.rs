//! The assigned and the free codes of a spec, for people and as JSON.

use crate::emit::markdown::{Lang, Word as _, purpose};
use fc_spec::model::{CodeRange, Kind, Location, Model, RangeUse, Text};
use serde::Serialize;
use std::fmt::Write as _;

/// The codes of a spec, by range.
#[derive(Debug, Serialize)]
pub struct CodeMap<'m> {
    /// The code that the next command gets, such as `0x0A11`.
    next_command: Option<String>,
    /// The code that the next report gets.
    next_report: Option<String>,
    /// The ranges, in the order of their codes.
    ranges: Vec<Range<'m>>,
    /// The names of the operations without a code.
    without: Vec<&'m str>,
}

#[derive(Debug, Serialize)]
struct Range<'m> {
    #[serde(flatten)]
    of: &'m CodeRange,
    /// The number of codes that were never assigned.
    free: usize,
    taken: Vec<Entry<'m>>,
}

/// A code that is assigned or retired.
#[derive(Debug, Serialize)]
struct Entry<'m> {
    #[serde(skip)]
    code: u16,
    #[serde(rename = "code")]
    spelling: &'m str,
    #[serde(flatten)]
    holder: Holder<'m>,
}

#[derive(Debug, Serialize)]
#[serde(tag = "state", rename_all = "lowercase")]
enum Holder<'m> {
    Used {
        name: &'m str,
        kind: Kind,
        #[serde(flatten)]
        title: &'m Text,
        place: &'m Location,
    },
    Retired {
        #[serde(flatten)]
        text: &'m Text,
    },
}

impl<'m> CodeMap<'m> {
    /// Creates the map of a checked model, in which every code is in a range.
    #[must_use]
    pub fn new(model: &'m Model) -> Self {
        let used = model.operations.iter().filter_map(|operation| {
            Some(Entry {
                code: operation.code.value?,
                spelling: &operation.code.spelling,
                holder: Holder::Used {
                    name: &operation.name,
                    kind: operation.kind(),
                    title: &operation.title,
                    place: &operation.location,
                },
            })
        });
        let retired = model.retired.iter().map(|retired| Entry {
            code: retired.code,
            spelling: &retired.spelling,
            holder: Holder::Retired {
                text: &retired.text,
            },
        });
        let mut taken: Vec<Entry<'m>> = used.chain(retired).collect();
        taken.sort_by_key(|entry| entry.code);
        let codes = model.taken_codes();
        let ranges = model.ranges.iter().map(|of| {
            let all = usize::from(of.last.abs_diff(of.first)) + 1;
            let gone = codes.range(of.first..=of.last).count();
            Range {
                of,
                free: all.saturating_sub(gone),
                taken: Vec::new(),
            }
        });
        let mut ranges: Vec<Range<'m>> = ranges.collect();
        ranges.sort_by_key(|range| range.of.first);
        for entry in taken {
            if let Some(range) = ranges.iter_mut().find(|range| range.of.has(entry.code)) {
                range.taken.push(entry);
            }
        }
        let next = |usage| model.next_code(usage, None).map(spelled);
        let uncoded = model.operations.iter();
        let uncoded = uncoded.filter(|operation| operation.code.value.is_none());
        Self {
            next_command: next(RangeUse::Commands),
            next_report: next(RangeUse::Reports),
            ranges,
            without: uncoded.map(|operation| operation.name.as_str()).collect(),
        }
    }

    /// Returns the map as one JSON document, in both languages.
    #[must_use]
    pub fn json(&self) -> String {
        // Serializing fails only for keys that are not strings, and the map has none.
        serde_json::to_string_pretty(self).unwrap_or_default() + "\n"
    }

    /// Returns the map for a terminal: the next codes, then the holders of codes by range.
    #[must_use]
    pub fn text(&self, lang: Lang) -> String {
        let mut text = String::new();
        for (next, zh, en) in [
            (&self.next_command, "下一个指令", "next command"),
            (&self.next_report, "下一个上报", "next report "),
        ] {
            if let Some(next) = next {
                // Writing to a `String` cannot fail.
                let _ = writeln!(text, "{}  {next}", lang.pick(zh, en));
            }
        }
        for range in &self.ranges {
            let _ = writeln!(text, "\n{}", range.title(lang));
            let width = range.taken.iter().map(|entry| entry.name().len()).max();
            for entry in &range.taken {
                let _ = writeln!(text, "  {}", entry.line(lang, width.unwrap_or_default()));
            }
        }
        if !self.without.is_empty() {
            let title = lang.pick("还没有功能码", "Without a code");
            let _ = writeln!(text, "\n{title}\n  {}", self.without.join(", "));
        }
        text
    }

    /// Returns the state of one code. Each holder has one line.
    #[must_use]
    pub fn standing(&self, code: u16, lang: Lang) -> String {
        let mut ranges = self.ranges.iter().filter(|range| range.of.has(code));
        let Some(range) = ranges.next() else {
            let why = lang.pick("不在任何号段内", "in none of the ranges");
            return format!("{}  {why}\n", spelled(code));
        };
        let taken = range.taken.iter().filter(|entry| entry.code == code);
        let lines: Vec<String> = taken.map(|entry| entry.line(lang, 0) + "\n").collect();
        if lines.is_empty() {
            let why = match range.of.usage {
                RangeUse::Commands => lang.pick("空闲，可用于指令", "free, for a command"),
                RangeUse::Reports => lang.pick("空闲，可用于上报", "free, for a report"),
                RangeUse::PassThrough => {
                    lang.pick("空闲，透传给上装", "free, passed through to the upper body")
                }
                RangeUse::Reserved => lang.pick("保留，不分配", "not to be given out"),
                RangeUse::Historic => {
                    lang.pick("号段已关闭，不再分配", "closed, not to be given out")
                }
            };
            return format!("{}  {why}\n", spelled(code));
        }
        lines.concat()
    }
}

impl Range<'_> {
    fn title(&self, lang: Lang) -> String {
        let CodeRange {
            first_spelling: first,
            last_spelling: last,
            ..
        } = self.of;
        let ends = if first == last {
            first.clone()
        } else {
            format!("{first}–{last}")
        };
        let free = match (self.of.usage, lang) {
            (RangeUse::Historic | RangeUse::Reserved, _) => String::new(),
            (_, Lang::Zh) => format!("，剩余 {} 个", self.free),
            (_, Lang::En) => format!(", {} free", self.free),
        };
        let purpose = purpose(self.of, lang);
        format!("{ends} · {} · {purpose}{free}", lang.text(&self.of.text))
    }
}

impl Entry<'_> {
    fn name(&self) -> &str {
        match self.holder {
            Holder::Used { name, .. } => name,
            Holder::Retired { .. } => "",
        }
    }

    /// Returns the line of an entry. The name is padded to `width` columns.
    fn line(&self, lang: Lang, width: usize) -> String {
        let code = self.spelling;
        match &self.holder {
            Holder::Used {
                name,
                kind,
                title,
                place,
            } => format!(
                "{code}  {name:<width$}  {} · {} · {}:{}",
                lang.text(title),
                kind.word(lang),
                place.file,
                place.line
            ),
            Holder::Retired { text } => format!(
                "{code}  {}{}",
                lang.pick("已退役：", "retired: "),
                lang.text(text)
            ),
        }
    }
}

fn spelled(code: u16) -> String {
    format!("0x{code:04X}")
}
