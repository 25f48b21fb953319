//! Merges three versions of a file, where two branches have added something at the same place.
//!
//! A merge by lines reports a conflict there. It does not know which lines belong together, and the syntax tree does.
//! Only independent parts are merged: entries with names, values of an enum, and the lists of changes, answers and
//! codes. If both branches changed the same part, or the order has a meaning, people must decide.
//!
//! **Architecture invariant.** The merge parses its result and compares it with the intended content, including all
//! comments, before it returns the result.

mod entries;
mod items;
mod value;

use crate::format::format;
use crate::language::Cursor;
use crate::source::{Edits, FileId, SourceFile, Span};
use crate::syntax::{Node, parse_faultless};
use value::Value;

/// Merges `ours` and `theirs`, which both started from `base`. Returns the text of `ours` with the additions, changes
/// and removals of `theirs`. The result is formatted if both are.
///
/// Returns `None` if both have changed the same part, or if one of the three cannot be parsed. Line ends and the byte
/// order mark are those of `ours`.
#[must_use]
pub fn merge(base: &str, ours: &str, theirs: &str) -> Option<String> {
    let newline = SourceFile::new("", ours).newline();
    let mark = ours.starts_with(BYTE_ORDER_MARK);
    let [base, ours, theirs] = [base, ours, theirs].map(|text| {
        let text = text.strip_prefix(BYTE_ORDER_MARK).unwrap_or(text);
        SourceFile::new("", text.replace("\r\n", "\n"))
    });
    let base_tree = parse_faultless(FILE, &base.text)?;
    let our_tree = parse_faultless(FILE, &ours.text)?;
    let their_tree = parse_faultless(FILE, &theirs.text)?;
    let mut merge = Merge {
        ours: &ours,
        theirs: &theirs,
        edits: Edits::default(),
    };
    let root = Cursor::file(our_tree.root());
    let roots = [base_tree.root(), our_tree.root(), their_tree.root()];
    let [base_root, our_root, their_root] = roots;
    let meant = merge.entries(Above::File, root, Some(base_root), our_root, their_root)?;
    let merged = SourceFile::new("", merge.edits.apply(&ours));
    let merged_tree = parse_faultless(FILE, &merged.text)?;
    let is_meant = Value::of(merged_tree.root()) == meant
        && merged_tree.sorted_comments(&merged.text)
            == value::merged_comments([
                (&base_tree, &base),
                (&our_tree, &ours),
                (&their_tree, &theirs),
            ])?;
    if !is_meant {
        return None;
    }
    let is_laid_out = |file: &SourceFile| format(FILE, file).is_ok_and(|text| text == file.text);
    let text = if is_laid_out(&ours) && is_laid_out(&theirs) {
        format(FILE, &merged).ok()?
    } else {
        merged.text
    };
    let text = text.replace('\n', newline);
    Some(if mark {
        format!("{BYTE_ORDER_MARK}{text}")
    } else {
        text
    })
}

const BYTE_ORDER_MARK: char = '\u{feff}';

/// The three files are never in one list, so they can share an id.
const FILE: FileId = FileId(0);

/// The parent of the entries of a mapping or the items of a list.
#[derive(Clone, Copy)]
enum Above<'t> {
    /// The file.
    File,
    /// The keys in ours and theirs.
    Keys(Node<'t>, Node<'t>),
}

struct Merge<'t> {
    ours: &'t SourceFile,
    theirs: &'t SourceFile,
    /// The edits of ours.
    edits: Edits,
}

impl<'t> Merge<'t> {
    /// Returns the merged value of a place that both sides have changed.
    fn both(
        &mut self,
        above: Above<'t>,
        key: &str,
        cursor: Cursor,
        [base, ours, theirs]: [Option<Node<'t>>; 3],
    ) -> Option<Value<'t>> {
        let (ours, theirs) = (ours?, theirs?);
        if !is_block(self.ours, ours) || !is_block(self.theirs, theirs) {
            return None;
        }
        match cursor {
            Cursor::Items(_) => self.items(above, key, base, ours, theirs),
            _ => self.entries(above, cursor, base, ours, theirs),
        }
    }
}

/// Returns `true` if a mapping or list is written line by line.
fn is_block(file: &SourceFile, node: Node<'_>) -> bool {
    let is_some = node.as_mapping().is_some() || node.as_sequence().is_some();
    let text = file.text.get(node.span().start..).unwrap_or_default();
    is_some && !text.starts_with(['{', '['])
}

/// The lines of a node, with the lines above it down from `above`, the last line of its predecessor. Blank lines at the
/// start are left out, and `blank` is `true` if there are any.
#[derive(Clone, Copy)]
struct Lines {
    first: usize,
    last: usize,
    blank: bool,
}

impl Lines {
    fn of(file: &SourceFile, above: usize, span: Span) -> Self {
        let last = file.last_line(span);
        let is_blank = |line: &usize| {
            let text = file.line_text(*line);
            text.is_some_and(|text| text.trim().is_empty())
        };
        let blanks = (above + 1..last).take_while(is_blank).count();
        Self {
            first: above + 1 + blanks,
            last,
            blank: blanks > 0,
        }
    }

    fn span(self, file: &SourceFile) -> Option<Span> {
        let (start, end) = file.lines(self.first, self.last)?;
        Some(Span::new(FILE, start, end))
    }

    fn text(self, file: &SourceFile) -> Option<&str> {
        Some(file.slice(self.span(file)?))
    }
}

impl Merge<'_> {
    /// Adds lines of theirs below a line of ours.
    fn add(&mut self, below: usize, lines: Lines) -> Option<()> {
        let text = lines.text(self.theirs)?;
        let text = if lines.blank {
            format!("\n{text}")
        } else {
            text.to_owned()
        };
        let (start, end) = self.ours.lines(below, below)?;
        self.edits
            .add_line(self.ours, Span::new(FILE, start, end), &text);
        Some(())
    }
}
