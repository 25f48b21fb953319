//! How an operation is called and answered, as the pages of the documentation show it: in each language, what makes the
//! samples of the pages makes those of a file that is checked with the package.

use super::context::Context;
use super::style::Style;
use crate::sample::{Profile, Samples};
use crate::surface::expr::{Expressions, Record};
use crate::surface::language::Language;
use crate::surface::package::Package;
use crate::target::Targets;
use fc_spec::model::{Direction, Operation, Side};

/// Columns of a line on a page, which is narrower than a file.
pub const PAGE_WIDTH: usize = 80;

/// What makes the samples of a package.
pub trait Snippets {
    /// What an app does: calls a command, takes a report or a stream, sends a stream of its own. `None` without a code.
    fn app(&self, operation: &Operation) -> Option<String>;

    /// What a robot does: answers a command, pushes a report, sends a stream. `None` without a code, and of a stream that
    /// it does not send.
    fn robot(&self, operation: &Operation) -> Option<String>;
}

/// A language in which the pages show every operation.
pub struct Shown {
    /// What a fence says of it.
    pub fence: &'static str,
    /// The file that has all samples, below the product's place.
    pub file: &'static str,
    /// How names are spelled in it.
    pub language: fn(&Targets) -> &'static Language,
    /// How it is written on a page.
    pub style: &'static Style,
    /// What makes the samples of a package in it.
    pub snippets: Make,
}

/// Makes what makes the samples of a package, with the values in them.
type Make = for<'p> fn(&'p Context<'p>, &'p Samples<'p>) -> Box<dyn Snippets + Sync + 'p>;

/// The streams that have a code, and that this side sends.
pub fn streams<'p>(package: &'p Package<'_>, sender: Side) -> Vec<&'p Operation> {
    let streams = package.streams.iter().map(|stream| stream.of);
    streams.filter(|it| it.sender == sender).collect()
}

/// Whether a stream has a code, so that the package has it.
pub fn is_there(package: &Package<'_>, stream: &Operation) -> bool {
    let mut streams = package.streams.iter();
    streams.any(|known| known.of.name == stream.name)
}

/// The spec's example of what an operation carries in a direction; `None` where that is not said, as of a stream of bytes.
pub fn example<'p, 'm>(
    package: &'p Package<'m>,
    samples: &Samples<'m>,
    operation: &Operation,
    direction: Direction,
) -> Option<Record<'p>> {
    let body = operation.body(direction)?;
    let value = samples.body(operation, direction, Profile::Example);
    Some(Expressions::new(package, samples).record(&body.ty, &value))
}

/// What a stream of bytes carries in the samples.
pub const BYTES: &str = "any bytes";
