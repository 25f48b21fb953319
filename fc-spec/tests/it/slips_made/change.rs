//! What a maker does to a spec, and where the fault of it has to be.

use super::place::{At, Spec};
use fc_spec::source::{Sources, Span};
use std::ops::Range;

/// A stretch of a file replaced.
#[derive(Clone, Debug)]
struct Edit {
    file: usize,
    at: Range<usize>,
    new: String,
    /// Whether its whole lines are meant.
    lines: bool,
}

/// What a slip changes.
#[derive(Clone, Debug)]
pub struct Change {
    /// In the order of the files and their texts.
    edits: Vec<Edit>,
    /// Places of the spec as it was that a careful person may point at as well.
    also: Vec<(usize, Range<usize>)>,
}

impl Change {
    pub fn new(file: usize, at: Range<usize>, new: impl Into<String>) -> Self {
        let new = new.into();
        let lines = false;
        Self {
            edits: vec![Edit {
                file,
                at,
                new,
                lines,
            }],
            also: Vec::new(),
        }
    }

    /// A second edit of its file, behind the others.
    pub fn and(mut self, at: Range<usize>, new: impl Into<String>) -> Self {
        let second = Self::new(self.edits[0].file, at, new);
        self.edits.extend(second.edits);
        self
    }

    /// Both changes.
    pub fn with(&self, other: &Self) -> Self {
        let mut both = self.clone();
        both.edits.extend(other.edits.iter().cloned());
        both.edits.sort_by_key(|edit| (edit.file, edit.at.start));
        both.also.extend(other.also.iter().cloned());
        both
    }

    /// Whether two changes are in different files, or so many bytes apart.
    pub fn is_apart(&self, other: &Self, bytes: usize) -> bool {
        let apart = |a: &Edit, b: &Edit| {
            a.file != b.file || a.at.end + bytes < b.at.start || b.at.end + bytes < a.at.start
        };
        self.edits
            .iter()
            .all(|a| other.edits.iter().all(|b| apart(a, b)))
    }

    /// Whether both change the same file.
    pub fn shares_file(&self, other: &Self) -> bool {
        self.edits[0].file == other.edits[0].file
    }

    /// The key of a place is a right answer too.
    pub fn or(mut self, at: At<'_>) -> Self {
        let key = if at.key.is_empty() {
            at.value.clone()
        } else {
            at.key.clone()
        };
        self.also.push((at.file, key));
        self
    }

    /// The value of a place is a right answer too.
    pub fn or_value(mut self, at: At<'_>) -> Self {
        self.also.push((at.file, at.value.clone()));
        self
    }

    /// Anything on the lines that were changed is right.
    pub fn on_its_lines(mut self) -> Self {
        self.edits.iter_mut().for_each(|edit| edit.lines = true);
        self
    }

    /// The spec's files with the change.
    pub fn apply(&self, spec: &Spec) -> Vec<(String, String)> {
        let mut files = spec.files.clone();
        for edit in self.edits.iter().rev() {
            files[edit.file].1.replace_range(edit.at.clone(), &edit.new);
        }
        files
    }

    /// The places that a fault of this change may have, where all of `done` was changed.
    pub fn targets(&self, spec: &Spec, done: &Self) -> Vec<(usize, Range<usize>)> {
        let files = done.apply(spec);
        let mut targets = Vec::new();
        for edit in &self.edits {
            let start = done.moved(edit.file, edit.at.start, false);
            let changed = start..start + edit.new.len();
            let text = &files[edit.file].1;
            let target = if edit.lines {
                lines_of(text, changed)
            } else {
                changed
            };
            targets.push((edit.file, target));
        }
        for (file, at) in &self.also {
            let (start, end) = (
                done.moved(*file, at.start, true),
                done.moved(*file, at.end, true),
            );
            targets.push((*file, start..end.max(start)));
        }
        targets
    }

    /// Where a byte of a file is after the change.
    fn moved(&self, file: usize, byte: usize, behind: bool) -> usize {
        let mut moved = byte;
        for edit in self.edits.iter().filter(|edit| edit.file == file) {
            let at = &edit.at;
            if at.end < byte || (at.end == byte && (behind || at.start < at.end)) {
                moved = moved + edit.new.len() - at.len();
            }
        }
        moved
    }
}

/// The whole lines of a stretch, without their blanks at either end.
fn lines_of(text: &str, at: Range<usize>) -> Range<usize> {
    let inside = text[at.clone()]
        .strip_suffix('\n')
        .map_or(at.end, |inside| at.start + inside.len());
    let start = text[..at.start].rfind('\n').map_or(0, |end| end + 1);
    let end = text[inside..]
        .find('\n')
        .map_or(text.len(), |end| inside + end);
    start..end
}

/// A slip: what was done where.
pub struct Slip {
    pub kind: &'static str,
    pub title: String,
    pub change: Change,
}

impl Slip {
    pub fn sources(&self, spec: &Spec) -> Sources {
        Sources::from_texts(self.change.apply(spec))
    }
}

/// Whether a fault points at one of the targets: it touches it, and begins no earlier than the line on which that begins.
pub fn hits(sources: &Sources, span: Span, targets: &[(usize, Range<usize>)]) -> bool {
    targets.iter().any(|(file, at)| {
        let Some((id, source)) = sources.iter().nth(*file) else {
            return false;
        };
        let start = source.text[..at.start.min(source.text.len())]
            .rfind('\n')
            .map_or(0, |end| end + 1);
        id == span.file && span.start >= start && span.start <= at.end && span.end >= at.start
    })
}

/// What the makers write with.
impl At<'_> {
    /// Its value replaced.
    pub fn set(self, text: impl Into<String>) -> Change {
        Change::new(self.file, self.value.clone(), text)
    }

    /// Its key replaced.
    pub fn rename(self, text: impl Into<String>) -> Change {
        Change::new(self.file, self.key.clone(), text)
    }

    /// What stands between key and value replaced.
    pub fn between(self, text: &str) -> Change {
        Change::new(self.file, self.key.end..self.value.start, text)
    }

    /// Text put in at a byte.
    pub fn insert(self, at: usize, text: impl Into<String>) -> Change {
        Change::new(self.file, at..at, text)
    }

    /// Taken out: of a row in brackets with its comma, else its lines.
    pub fn removed(self) -> Change {
        let text = self.whole();
        let at = if !self.flow {
            self.lines()
        } else if let Some(next) = self.behind() {
            self.key.start..next.key.start
        } else {
            let end = self
                .before()
                .map_or(self.key.start, |before| before.value.end);
            end..self.value.end
        };
        debug_assert!(text.is_char_boundary(at.start));
        Change::new(self.file, at, "")
    }

    /// Its lines moved by so many blanks.
    pub fn shifted(self, by: isize) -> Option<Change> {
        let lines = self.lines();
        let text = &self.whole()[lines.clone()];
        let mut moved = String::new();
        for line in text.split_inclusive('\n') {
            match usize::try_from(by) {
                Ok(more) if !line.trim().is_empty() => moved += &" ".repeat(more),
                Ok(_) => {}
                Err(_) if line.trim().is_empty() => {}
                Err(_) => {
                    let less = " ".repeat(by.unsigned_abs());
                    moved += line.strip_prefix(&less)?;
                    continue;
                }
            }
            moved += line;
        }
        Some(Change::new(self.file, lines, moved).on_its_lines())
    }
}
