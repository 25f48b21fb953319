//! `fcproto lsp`.

use std::path::Path;

use fc_lsp::{Host, serve};
use fc_spec::model::Text;
use lsp_server::Connection;

use crate::lang::both;
use crate::outcome::{Failure, Status};
use crate::print;
use crate::project::Project;
use crate::project_dirs::ProjectDirs;
use crate::versions::today;

/// Options of `fcproto lsp`.
#[derive(Debug, clap::Args)]
pub struct Options {
    #[arg(
        long,
        help = both("为兼容其他客户端而接受，没有作用", "Accepted for clients that pass it; has no effect")
    )]
    stdio: bool,
}

pub fn run(dirs: &ProjectDirs, _options: &Options) -> Result<Status, Failure> {
    let (connection, threads) = Connection::stdio();
    let was_asked_to_end = serve(&connection, &Here { dirs })?;
    // The writing thread ends when the connection is dropped.
    drop(connection);
    threads.join()?;
    Ok(Status::fine_if(was_asked_to_end))
}

/// The host of the server, with the project options of the command line.
struct Here<'p> {
    dirs: &'p ProjectDirs,
}

impl Host for Here<'_> {
    fn find(&self, directory: &Path) -> Result<fc_lsp::Project, Text> {
        let project = Project::find_from(self.dirs, directory).map_err(|error| error.text())?;
        // Clients name files by absolute paths, independent of the server's directory.
        let root = std::path::absolute(&project.root).map_err(|error| print::reason(&error))?;
        Ok(fc_lsp::Project::new(root, project.spec, project.targets))
    }

    fn today(&self) -> String {
        today(None)
    }
}
