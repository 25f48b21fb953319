//! Positions in the units of clients: lines from 0, columns in UTF-16 units or bytes.

use fc_spec::source::{SourceFile, Span};
use gen_lsp_types::{Position, Range, TextDocumentContentChangeEvent};

/// The unit of columns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
    /// Bytes of UTF-8.
    Utf8,
    /// Units of UTF-16. Every client supports them.
    Utf16,
}

impl Encoding {
    /// Returns the byte offset of a position. A column beyond the end of its line gives the end of the line. A line
    /// beyond the end of the file gives the end of the file. A column inside a character gives the start of the
    /// character.
    #[must_use]
    pub fn offset(self, file: &SourceFile, position: Position) -> usize {
        let line = usize::try_from(position.line).unwrap_or(usize::MAX);
        let line = line.saturating_add(1);
        let Some((start, end)) = file.lines(line, line) else {
            return file.text.len();
        };
        let text = file.text.get(start..end).unwrap_or_default();
        let column = usize::try_from(position.character).unwrap_or(usize::MAX);
        let mut passed = 0;
        for (at, c) in text.char_indices() {
            passed += self.width(c);
            if passed > column {
                return start + at;
            }
        }
        end
    }

    /// Returns the position of a byte offset.
    #[must_use]
    pub fn position(self, file: &SourceFile, offset: usize) -> Position {
        let column: usize = file.before(offset).chars().map(|c| self.width(c)).sum();
        Position {
            line: narrow(file.line(offset) - 1),
            character: narrow(column),
        }
    }

    /// Returns the range of a span.
    #[must_use]
    pub fn range(self, file: &SourceFile, span: Span) -> Range {
        Range {
            start: self.position(file, span.start),
            end: self.position(file, span.end),
        }
    }

    /// Returns the file after a change.
    #[must_use]
    pub fn changed(self, file: &SourceFile, change: TextDocumentContentChangeEvent) -> SourceFile {
        let (range, new) = match change {
            TextDocumentContentChangeEvent::TextDocumentContentChangePartial(change) => {
                (change.range, change.text)
            }
            TextDocumentContentChangeEvent::TextDocumentContentChangeWholeDocument(change) => {
                return SourceFile::new(file.path.as_str(), change.text);
            }
        };
        let start = self.offset(file, range.start);
        let end = self.offset(file, range.end).max(start);
        let mut text = file.text.clone();
        text.replace_range(start..end, &new);
        SourceFile::new(file.path.as_str(), text)
    }

    fn width(self, c: char) -> usize {
        match self {
            Self::Utf8 => c.len_utf8(),
            Self::Utf16 => c.len_utf16(),
        }
    }
}

fn narrow(number: usize) -> u32 {
    u32::try_from(number).unwrap_or(u32::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Lines with characters of one, three and four bytes, and both kinds of line ends.
    const TEXT: &str = "a: 中文😀b\r\n第二\n";

    #[test]
    fn offsets_and_positions_agree() {
        let file = SourceFile::new("x.yaml", TEXT);
        for encoding in [Encoding::Utf8, Encoding::Utf16] {
            let ends = TEXT.char_indices().filter(|(_, c)| !"\r\n".contains(*c));
            for (offset, _) in ends {
                let position = encoding.position(&file, offset);
                assert_eq!(
                    encoding.offset(&file, position),
                    offset,
                    "{encoding:?} {position:?}"
                );
            }
        }
        let b = TEXT.find('b').unwrap_or_default();
        assert_eq!(Encoding::Utf16.position(&file, b).character, 7);
        assert_eq!(Encoding::Utf8.position(&file, b).character, 13);
    }

    #[test]
    fn positions_beyond_the_end_are_clamped() {
        let file = SourceFile::new("x.yaml", TEXT);
        let at = |line, character| Encoding::Utf16.offset(&file, Position { line, character });
        assert_eq!(at(0, 999), TEXT.find('\r').unwrap_or_default());
        assert_eq!(at(999, 0), TEXT.len());
        assert_eq!(at(u32::MAX, u32::MAX), TEXT.len());
        // Between the halves of a surrogate pair.
        assert_eq!(at(0, 6), TEXT.find('😀').unwrap_or_default());
        let end = Encoding::Utf16.position(&file, usize::MAX);
        assert_eq!(
            end,
            Position {
                line: 2,
                character: 0
            }
        );
    }
}
