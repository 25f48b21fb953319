//! The files of a spec, in memory.

use super::span::{FileId, LineCol, Span};
use std::sync::Arc;

/// A file of the spec.
#[derive(Clone, Debug)]
pub struct SourceFile {
    /// Path from the project's root with `/` between its parts.
    pub path: String,
    /// Its text, without a byte order mark at its start. Empty, or cut off at the first wrong byte, where
    /// `whole` is false.
    pub text: String,
    /// Whether all of the file is here. What is not has its own fault and is not parsed.
    pub whole: bool,
    /// Byte offset of the start of each line.
    line_starts: Vec<usize>,
}

impl SourceFile {
    /// A file with all of its text.
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

    /// A file of which only the start could be read.
    #[must_use]
    pub(crate) fn partial(path: impl Into<String>, text: impl Into<String>) -> Self {
        Self {
            whole: false,
            ..Self::new(path, text)
        }
    }

    /// Line end of the first line.
    pub(crate) fn newline(&self) -> &'static str {
        match self.text.split_once('\n') {
            Some((first, _)) if first.ends_with('\r') => "\r\n",
            _ => "\n",
        }
    }

    /// Line of a byte offset, counted from 1.
    #[must_use]
    pub fn line(&self, offset: usize) -> usize {
        let line = self.line_starts.partition_point(|start| *start <= offset);
        line.max(1)
    }

    /// Line and column of a byte offset; the end of the file for an offset beyond it.
    #[must_use]
    pub fn line_col(&self, offset: usize) -> LineCol {
        let line = self.line(offset);
        let start = self.line_starts.get(line - 1).copied().unwrap_or_default();
        let before = self.text.get(start..offset);
        let before = before
            .or_else(|| self.text.get(start..))
            .unwrap_or_default();
        LineCol {
            line,
            column: before.chars().count() + 1,
        }
    }

    /// Byte range of the lines `first` to `last`, counted from 1, both included, without the end of
    /// the last one.
    #[must_use]
    pub fn lines(&self, first: usize, last: usize) -> Option<(usize, usize)> {
        let start = *self.line_starts.get(first.checked_sub(1)?)?;
        let end = self
            .line_starts
            .get(last)
            .copied()
            .unwrap_or(self.text.len());
        let lines = self.text.get(start..end)?;
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
    /// No files yet.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Files by path and text, sorted by path, for specs that do not come from a disk.
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

    /// The same files with their paths seen from a directory above the project's root, which is `prefix` from there.
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

    /// A file.
    #[must_use]
    pub fn get(&self, file: FileId) -> Option<&SourceFile> {
        self.shared(file).map(Arc::as_ref)
    }

    /// The same, for those who keep it.
    pub(crate) fn shared(&self, file: FileId) -> Option<&Arc<SourceFile>> {
        self.files.get(usize::try_from(file.0).ok()?)
    }

    /// Every file, also those that are not whole.
    pub fn iter(&self) -> impl Iterator<Item = (FileId, &SourceFile)> {
        (0..).map(FileId).zip(self.files.iter().map(Arc::as_ref))
    }

    /// Path of the file of a span; empty for a file that is not of this list.
    #[must_use]
    pub fn path(&self, span: Span) -> &str {
        self.get(span.file).map_or("", |file| file.path.as_str())
    }

    /// Text of a span.
    #[must_use]
    pub fn slice(&self, span: Span) -> &str {
        self.get(span.file)
            .and_then(|file| file.text.get(span.start..span.end))
            .unwrap_or_default()
    }

    /// Line of a span's start.
    #[must_use]
    pub fn line(&self, span: Span) -> usize {
        self.get(span.file).map_or(1, |file| file.line(span.start))
    }

    /// Line and column of a span's start.
    #[must_use]
    pub fn line_col(&self, span: Span) -> LineCol {
        self.get(span.file)
            .map_or(LineCol { line: 1, column: 1 }, |file| {
                file.line_col(span.start)
            })
    }

    /// Line and column of a span's end.
    #[must_use]
    pub fn end_line_col(&self, span: Span) -> LineCol {
        self.line_col(Span::point(span.file, span.end))
    }

    /// Both ends of a span as people count them.
    pub(crate) fn ends(&self, span: Span) -> (LineCol, LineCol) {
        (self.line_col(span), self.end_line_col(span))
    }
}
