//! `fcproto changelog`.

use fc_diff::{Version, section};
use fc_spec::model::Model;

use crate::lang::{both, lang};
use crate::outcome::{Failure, Status};
use crate::place::Place;
use crate::print;
use crate::versions::{Shelf, today};

/// Options of `fcproto changelog`.
#[derive(Debug, clap::Args)]
pub struct Options {
    #[arg(
        value_name = "OLD",
        help = both("旧版本 [默认：上一次发布]", "Old version [default: the last release]")
    )]
    old: Option<String>,
    #[arg(
        value_name = "NEW",
        help = both("新版本 [默认：本项目]", "New version [default: this project]")
    )]
    new: Option<String>,
    #[arg(
        long = "for",
        value_name = "AUDIENCE",
        help = both("只含规范中这个受众的内容", "Include only the part of this audience of the spec")
    )]
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
    let findings = shelf.compare(&old, &new, &today(None))?;
    print::result(&section(&title, &findings, &new.model, lang))?;
    Ok(Status::Fine)
}

/// Returns both versions without the parts for other audiences. A version that does not know the audience stays whole.
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
