//! The change that a maker makes to a spec, and the places where its error may be.

use super::place::{At, Spec};
use fc_spec::source::{Sources, Span};
use std::ops::Range;

/// A range of a file and its replacement.
#[derive(Clone, Debug)]
struct Edit {
    file: usize,
    at: Range<usize>,
    new: String,
    /// `true` if an error anywhere on the changed lines is right.
    lines: bool,
}

/// The edits of a slip.
#[derive(Clone, Debug)]
pub struct Change {
    /// In the order of the files and of the positions in them.
    edits: Vec<Edit>,
    /// Other places where an error is right, as ranges of the unchanged spec.
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

    /// Adds an edit of the same file, after the others.
    pub fn and(mut self, at: Range<usize>, new: impl Into<String>) -> Self {
        let second = Self::new(self.edits[0].file, at, new);
        self.edits.extend(second.edits);
        self
    }

    /// Combines both changes.
    pub fn with(&self, other: &Self) -> Self {
        let mut both = self.clone();
        both.edits.extend(other.edits.iter().cloned());
        both.edits.sort_by_key(|edit| (edit.file, edit.at.start));
        both.also.extend(other.also.iter().cloned());
        both
    }

    /// Returns `true` if the changes are in different files, or more than `bytes` apart.
    pub fn is_apart(&self, other: &Self, bytes: usize) -> bool {
        let apart = |a: &Edit, b: &Edit| {
            a.file != b.file || a.at.end + bytes < b.at.start || b.at.end + bytes < a.at.start
        };
        self.edits
            .iter()
            .all(|a| other.edits.iter().all(|b| apart(a, b)))
    }

    /// Returns `true` if both change the same file.
    pub fn shares_file(&self, other: &Self) -> bool {
        self.edits[0].file == other.edits[0].file
    }

    /// Accepts an error at the key of a place too.
    pub fn or(mut self, at: At<'_>) -> Self {
        let key = if at.key.is_empty() {
            at.value.clone()
        } else {
            at.key.clone()
        };
        self.also.push((at.file, key));
        self
    }

    /// Accepts an error at the value of a place too.
    pub fn or_value(mut self, at: At<'_>) -> Self {
        self.also.push((at.file, at.value.clone()));
        self
    }

    /// Accepts an error anywhere on the changed lines.
    pub fn on_its_lines(mut self) -> Self {
        self.edits.iter_mut().for_each(|edit| edit.lines = true);
        self
    }

    /// Returns the spec's files with the change.
    pub fn apply(&self, spec: &Spec) -> Vec<(String, String)> {
        let mut files = spec.files.clone();
        for edit in self.edits.iter().rev() {
            files[edit.file].1.replace_range(edit.at.clone(), &edit.new);
        }
        files
    }

    /// Returns the places where an error of this change is right, after all of `done` was applied.
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

    /// Returns the position of a byte of a file after the change. `behind`: text inserted at the byte comes before it.
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

/// Returns the whole lines of a range, without the last line end.
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

/// A slip: its kind, its place and its change.
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

/// Returns `true` if an error hits one of the targets. It touches the target, and begins no earlier than the target's
/// first line.
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

/// The changes that makers use.
impl At<'_> {
    /// Replaces its value.
    pub fn set(self, text: impl Into<String>) -> Change {
        Change::new(self.file, self.value.clone(), text)
    }

    /// Replaces its key.
    pub fn rename(self, text: impl Into<String>) -> Change {
        Change::new(self.file, self.key.clone(), text)
    }

    /// Replaces the text between key and value.
    pub fn between(self, text: &str) -> Change {
        Change::new(self.file, self.key.end..self.value.start, text)
    }

    /// Inserts text at a byte.
    pub fn insert(self, at: usize, text: impl Into<String>) -> Change {
        Change::new(self.file, at..at, text)
    }

    /// Removes the entry: inside brackets with its comma, otherwise with its lines.
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

    /// Moves its lines by a number of blanks. Returns `None` if a line has too few.
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
