//! `fcproto changelog`.

use fc_diff::{for_audience, section};

use crate::lang::{both, lang};
use crate::outcome::{Failure, Status};
use crate::print;
use crate::project_dirs::ProjectDirs;
use crate::versions::{Named, Shelf, today};

/// Options of `fcproto changelog`.
#[derive(Debug, clap::Args)]
pub struct Options {
    #[command(flatten)]
    versions: Named,
    #[arg(
        long = "for",
        value_name = "AUDIENCE",
        help = both("只含规范中这个受众的内容", "Include only the part of this audience of the spec")
    )]
    audience: Option<String>,
}

pub fn run(dirs: &ProjectDirs, options: &Options) -> Result<Status, Failure> {
    let shelf = Shelf::find(dirs, options.versions.new.is_none())?;
    let [old, new] = shelf.named(&options.versions)?;
    let lang = lang();
    let title = match &options.versions.new {
        Some(_) => new.model.protocol.version.clone(),
        None => lang.pick("未发布", "Unreleased").to_owned(),
    };
    let [old, new] = match &options.audience {
        Some(audience) => for_audience([old, new], audience)?,
        None => [old, new],
    };
    let findings = shelf.compare(&old, &new, &today(None))?;
    print::result(&section(&title, &findings, &new.model, lang))?;
    Ok(Status::Fine)
}
