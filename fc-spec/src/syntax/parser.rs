//! The YAML parser and its settings.

use super::limits;
use granit_parser::{Parser, StrInput};

/// Returns the parser of a text. Constructs that the spec does not allow become events or errors. The number of
/// comments needs no limit, because the size of a file has one.
pub(super) fn parser(text: &str, comments: bool) -> Parser<'_, StrInput<'_>> {
    let options = granit_parser::options! {
        emit_comments: comments,
        max_buffered_comment_events: limits::FILE_BYTES,
        emit_anchor_events: true,
        emit_unresolved_aliases: true,
        disallow_directives: true,
        flow_nesting_limit: limits::DEPTH + 1,
        block_nesting_limit: limits::DEPTH + 1,
    };
    Parser::new_from_str_with_options(text, options)
}

/// Returns `true` if the parser gets beyond byte `beyond` of a text. It builds no tree.
pub(super) fn reaches(text: &str, beyond: usize) -> bool {
    for event in parser(text, false) {
        match event {
            Err(error) => return error.marker().byte_offset().unwrap_or_default() > beyond,
            Ok((_, at)) if at.byte_range().is_some_and(|range| range.start > beyond) => {
                return true;
            }
            Ok(_) => {}
        }
    }
    true
}
