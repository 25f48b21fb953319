//! Global options for the directories of the project.

use std::path::PathBuf;

pub use fc_codegen::project::ProjectDirs;

use crate::help::global;
use crate::lang::both;

/// The options for the directories of the project and its spec.
#[derive(Debug, clap::Args)]
pub struct Options {
    #[arg(
        long,
        value_name = "DIR",
        global = true,
        help_heading = global(),
        help = both("项目目录 [默认：向上最近的项目]", "Project directory [default: the nearest one upwards]")
    )]
    root: Option<PathBuf>,
    #[arg(
        long,
        value_name = "DIR",
        global = true,
        help_heading = global(),
        help = both("规范目录 [默认：`fc.yaml` 指定的，或 `spec`]", "Spec directory [default: set in `fc.yaml`, else `spec`]")
    )]
    spec: Option<PathBuf>,
}

impl Options {
    /// Returns the named directories.
    pub fn dirs(&self) -> ProjectDirs {
        ProjectDirs {
            root: self.root.clone(),
            spec: self.spec.clone(),
        }
    }
}
