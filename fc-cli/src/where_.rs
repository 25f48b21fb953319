//! `fcproto where`.

use fc_spec::diagnostic::Faults;
use fc_spec::index::locate;
use fc_spec::syntax::read_dir;

use crate::lang::{both, in_lang};
use crate::outcome::{Failure, Status};
use crate::print;
use crate::project::Project;
use crate::project_dirs::ProjectDirs;

/// Options of `fcproto where`.
#[derive(Debug, clap::Args)]
pub struct Options {
    #[arg(
        value_name = "NAME",
        help = both("名称、`Station.name` 这样的路径，或功能码", "Name, path such as `Station.name`, or code")
    )]
    name: String,
}

pub fn run(dirs: &ProjectDirs, options: &Options) -> Result<Status, Failure> {
    let project = Project::find(dirs)?;
    let mut faults = Faults::new();
    let sources = read_dir(&project.root, &project.spec, &mut faults);
    let found = locate(&sources, &mut faults, &options.name)?;
    let found = found.iter().map(|declaration| in_lang(&declaration.text()));
    print::result(&found.collect::<String>())?;
    Ok(Status::Fine)
}
