//! Ranges of codes that a robot handles with one method.

use super::context::Context;
use crate::package::name::free;
use fc_spec::model::{CodeRange, RangeUse};

/// The method for codes without another handler, in words that each language joins.
pub const UNKNOWN: &str = "unknown";

/// Returns the pass-through ranges, each with the name of its method in words.
pub fn pass_through<'m>(context: &Context<'m>) -> Vec<(String, &'m CodeRange)> {
    let ranges = context.model().ranges.iter();
    let ranges = ranges.filter(|range| range.usage == RangeUse::PassThrough);
    let mut named: Vec<(String, &CodeRange)> = Vec::new();
    for range in ranges {
        let with_code = format!("pass_through_{:04x}", range.first);
        let name = free(&["pass_through", &with_code], |name| {
            context.package.has_call(name) || named.iter().any(|(taken, _)| taken == name)
        });
        named.push((name, range));
    }
    named
}
