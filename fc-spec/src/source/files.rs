//! The files of a spec, in memory.

use super::span::{FileId, LineCol, Span};
use std::sync::Arc;

/// A file of the spec.
#[derive(Clone, Debug)]
pub struct SourceFile {
    /// The path, relative to the project's root, with `/` as separator.
    pub path: String,
    /// The text without a byte order mark. If `whole` is `false`, it is empty or cut off at the first invalid byte.
    pub text: String,
    /// `true` if the whole file was read. Other files have an error and are not parsed.
    pub whole: bool,
    /// The byte offset of the start of each line.
    line_starts: Vec<usize>,
}

impl SourceFile {
    /// Creates a file with its whole text.
    #[must_use]
    pub fn new(path: impl Into<String>, text: impl Into<String>) -> Self {
        let text = text.into();
        let line_starts = std::iter::once(0)
            .chain(text.match_indices('\n').map(|(at, _)| at + 1))
            .collect();
        Self {
            path: path.into(),
            text,
            whole: true,
            line_starts,
        }
    }

    /// Creates a file without its end, which could not be read.
    #[must_use]
    pub(crate) fn partial(path: impl Into<String>, text: impl Into<String>) -> Self {
        Self {
            whole: false,
            ..Self::new(path, text)
        }
    }

    /// Returns the line end of the first line.
    pub(crate) fn newline(&self) -> &'static str {
        match self.text.split_once('\n') {
            Some((first, _)) if first.ends_with('\r') => "\r\n",
            _ => "\n",
        }
    }

    /// Returns the line of a byte offset, counted from 1.
    #[must_use]
    pub fn line(&self, offset: usize) -> usize {
        let line = self.line_starts.partition_point(|start| *start <= offset);
        line.max(1)
    }

    /// Returns the line and column of a byte offset. An offset beyond the end counts as the end of the file.
    #[must_use]
    pub fn line_col(&self, offset: usize) -> LineCol {
        LineCol {
            line: self.line(offset),
            column: self.before(offset).chars().count() + 1,
        }
    }

    /// Returns the text between the start of a line and a byte offset in it. An offset beyond the end counts as the end
    /// of the file.
    #[must_use]
    pub fn before(&self, offset: usize) -> &str {
        let start = self.line_start(offset);
        let before = self.text.get(start..offset);
        before
            .or_else(|| self.text.get(start..))
            .unwrap_or_default()
    }

    /// Returns the start of the line with a byte offset.
    pub(crate) fn line_start(&self, offset: usize) -> usize {
        let starts = self.line_starts.get(self.line(offset) - 1);
        starts.copied().unwrap_or_default()
    }

    /// Returns the start of the line after a line, or the end of the file.
    pub(crate) fn next_line(&self, line: usize) -> usize {
        let start = self.line_starts.get(line).copied();
        start.unwrap_or(self.text.len())
    }

    /// Returns the last line of a span.
    pub(crate) fn last_line(&self, span: Span) -> usize {
        self.line(span.end.saturating_sub(1).max(span.start))
    }

    /// Returns the text of a span.
    pub(crate) fn slice(&self, span: Span) -> &str {
        self.text.get(span.start..span.end).unwrap_or_default()
    }

    /// Returns the text of a line, or `None` if there is no such line.
    pub(crate) fn line_text(&self, line: usize) -> Option<&str> {
        let (start, end) = self.lines(line, line)?;
        self.text.get(start..end)
    }

    /// Returns the number of spaces at the start of the line with a byte offset.
    pub(crate) fn indentation(&self, offset: usize) -> usize {
        let line = self.line_text(self.line(offset)).unwrap_or_default();
        line.len() - line.trim_start_matches(' ').len()
    }

    /// Returns the byte range of the lines `first` to `last`, both included and counted from 1. The range excludes the
    /// line end of the last line.
    #[must_use]
    pub fn lines(&self, first: usize, last: usize) -> Option<(usize, usize)> {
        let start = *self.line_starts.get(first.checked_sub(1)?)?;
        let lines = self.text.get(start..self.next_line(last))?;
        let lines = lines.strip_suffix('\n').unwrap_or(lines);
        let lines = lines.strip_suffix('\r').unwrap_or(lines);
        Some((start, start + lines.len()))
    }
}

/// The files of a spec, sorted by path. A copy shares their texts.
#[derive(Clone, Debug, Default)]
pub struct Sources {
    files: Vec<Arc<SourceFile>>,
}

impl Sources {
    /// Creates an empty list.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Creates files from paths and texts, sorted by path, for specs that are not on a disk.
    pub fn from_texts<P: Into<String>, T: Into<String>>(
        texts: impl IntoIterator<Item = (P, T)>,
    ) -> Self {
        let mut files: Vec<_> = texts
            .into_iter()
            .map(|(path, text)| Arc::new(SourceFile::new(path, text)))
            .collect();
        files.sort_by(|a, b| a.path.cmp(&b.path));
        Self { files }
    }

    /// Returns the same files with paths from a directory above the project's root. `prefix` is the path from there to
    /// the root.
    #[must_use]
    pub fn below(&self, prefix: &str) -> Self {
        let mut files = self.files.clone();
        if !prefix.is_empty() {
            for file in &mut files {
                let file = Arc::make_mut(file);
                file.path = format!("{prefix}/{}", file.path);
            }
        }
        Self { files }
    }

    /// Adds a file. Ids count up from 0.
    pub fn push(&mut self, file: impl Into<Arc<SourceFile>>) -> FileId {
        let id = FileId(u32::try_from(self.files.len()).unwrap_or(u32::MAX));
        self.files.push(file.into());
        id
    }

    /// Puts a file in the place of the one with its path.
    pub fn replace(&mut self, file: impl Into<Arc<SourceFile>>) {
        let file = file.into();
        let mut files = self.files.iter_mut();
        if let Some(old) = files.find(|old| old.path == file.path) {
            *old = file;
        }
    }

    /// Returns a file.
    #[must_use]
    pub fn get(&self, file: FileId) -> Option<&SourceFile> {
        self.shared(file).map(Arc::as_ref)
    }

    /// Returns a file that the caller can keep.
    pub(crate) fn shared(&self, file: FileId) -> Option<&Arc<SourceFile>> {
        self.files.get(usize::try_from(file.0).ok()?)
    }

    /// Returns every file, including those that are not whole.
    pub fn iter(&self) -> impl Iterator<Item = (FileId, &SourceFile)> {
        (0..).map(FileId).zip(self.files.iter().map(Arc::as_ref))
    }

    /// Returns the files whose text has changed, each before and after the change. `before` has the same paths.
    pub fn changes_since<'s>(
        &'s self,
        before: &'s Self,
    ) -> impl Iterator<Item = (&'s SourceFile, &'s SourceFile)> {
        let pairs = before.files.iter().zip(&self.files);
        let pairs = pairs.map(|(before, after)| (before.as_ref(), after.as_ref()));
        pairs.filter(|(before, after)| before.text != after.text)
    }

    /// Returns the path of the file of a span. It is empty for a file that is not in the list.
    #[must_use]
    pub fn path(&self, span: Span) -> &str {
        self.get(span.file).map_or("", |file| file.path.as_str())
    }

    /// Returns the text of a span.
    #[must_use]
    pub fn slice(&self, span: Span) -> &str {
        self.get(span.file).map_or("", |file| file.slice(span))
    }

    /// Returns the line of a span's start.
    #[must_use]
    pub fn line(&self, span: Span) -> usize {
        self.get(span.file).map_or(1, |file| file.line(span.start))
    }

    /// Returns the line and column of a span's start.
    #[must_use]
    pub fn line_col(&self, span: Span) -> LineCol {
        self.get(span.file)
            .map_or(LineCol { line: 1, column: 1 }, |file| {
                file.line_col(span.start)
            })
    }

    /// Returns the line and column of a span's end.
    #[must_use]
    pub fn end_line_col(&self, span: Span) -> LineCol {
        self.line_col(Span::point(span.file, span.end))
    }

    /// Returns the line and column of both ends of a span.
    pub(crate) fn ends(&self, span: Span) -> (LineCol, LineCol) {
        (self.line_col(span), self.end_line_col(span))
    }
}
