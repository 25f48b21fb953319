//! `fcproto schema`.

use clap::ValueEnum;
use fc_spec::model::Languages;

use crate::lang::both;
use crate::outcome::{Failure, Status};
use crate::print;
use crate::project::Project;
use crate::project_dirs::ProjectDirs;

/// Options of `fcproto schema`.
#[derive(Debug, clap::Args)]
pub struct Options {
    #[arg(
        value_name = "WHAT",
        default_value = "spec",
        help = both("描述的对象", "Schema to print")
    )]
    of: Of,
}

/// The subject of a schema.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Of {
    #[value(help = both("规范语言", "The spec language"))]
    Spec,
    #[value(help = both("`fc.yaml`", "`fc.yaml`"))]
    Project,
    #[value(help = both("`fcproto inspect` 的输出", "The output of `fcproto inspect`"))]
    Dump,
}

pub fn run(dirs: &ProjectDirs, options: &Options) -> Result<Status, Failure> {
    print::result(&match options.of {
        Of::Spec => {
            // Without a project, texts are in both languages.
            let project = Project::find(dirs).ok();
            fc_spec::language::schema(project.map_or(Languages::All, |it| it.targets.texts))
        }
        Of::Project => fc_spec::language::project_schema(),
        Of::Dump => fc_spec::model::Dump::schema(),
    })?;
    Ok(Status::Fine)
}
