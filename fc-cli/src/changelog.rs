//! `fcproto changelog`.

use fc_diff::{Version, section};
use fc_spec::model::Model;

use crate::lang::lang;
use crate::outcome::{Failure, Status};
use crate::place::Place;
use crate::print;
use crate::versions::{Shelf, today};

/// Print what has changed, for those who write apps and robots.
///
/// What breaks, what is new and what else programs notice, as a section of Markdown; texts and examples are counted only. Versions are
/// named as for `fcproto diff`. With `--for` both are cut down to what that audience has, so that it reads of nothing else.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  fcproto changelog           what the next release brings
  fcproto changelog 1.0 2.0 --lang zh
  fcproto changelog --for product_app")]
pub struct Options {
    /// The old version [default: the last release]
    #[arg(value_name = "OLD")]
    old: Option<String>,
    /// The new version [default: this project]
    #[arg(value_name = "NEW")]
    new: Option<String>,
    /// Only what this audience has, as the spec names it under `availability`.
    #[arg(long = "for", value_name = "AUDIENCE")]
    audience: Option<String>,
}

pub fn run(place: &Place, options: &Options) -> Result<Status, Failure> {
    let shelf = Shelf::find(place, options.new.is_none())?;
    let old = match &options.old {
        Some(old) => old.clone(),
        None => shelf.last()?,
    };
    let new = options.new.clone().unwrap_or_else(|| shelf.here());
    let (Some(old), Some(new)) = (shelf.read(&old)?, shelf.read(&new)?) else {
        return Ok(Status::Faulty);
    };
    let lang = lang();
    let title = match &options.new {
        Some(_) => new.model.protocol.version.clone(),
        None => lang.pick("未发布", "Unreleased").to_owned(),
    };
    let (old, new) = match options.audience.as_deref() {
        Some(audience) => of_audience(old, new, audience)?,
        None => (old, new),
    };
    let findings = shelf.compare(&old, &new, &today(None));
    print::result(&section(&title, &findings, &new.model, lang))?;
    Ok(Status::Fine)
}

/// Both versions without what is not for this audience. One that does not know it withholds nothing from it.
fn of_audience(old: Version, new: Version, audience: &str) -> Result<(Version, Version), Failure> {
    let (one, other) = (
        old.model.for_audience(audience),
        new.model.for_audience(audience),
    );
    if let (Err(_), Err(unknown)) = (&one, &other) {
        return Err(unknown.to_string().into());
    }
    let part = |whole: Version, part: Option<Model>| Version {
        model: part.unwrap_or_else(|| whole.model.clone()),
        ..whole
    };
    Ok((part(old, one.ok()), part(new, other.ok())))
}
