//! `fcproto lsp`.

use std::path::Path;

use fc_lsp::{Host, serve};
use lsp_server::Connection;

use crate::outcome::{Failure, Status};
use crate::place::Place;
use crate::project::Project;
use crate::versions::today;

/// Serve an editor over standard input and output, by the Language Server Protocol.
///
/// Editors start it by themselves. The project is that of the directory which the editor has open, or of the first file
/// that is opened; faults are those of `fcproto check`, for texts that are not saved yet, too.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
How editors are told of it: docs-site/en/guides/editors.md")]
pub struct Options {
    /// Accepted because many clients pass it; nothing else is spoken.
    #[arg(long)]
    stdio: bool,
}

pub fn run(place: &Place, _options: &Options) -> Result<Status, Failure> {
    let (connection, threads) = Connection::stdio();
    let was_asked_to_end = serve(&connection, &Here { place })?;
    // Nothing more is said, which is when the thread that writes ends.
    drop(connection);
    threads.join()?;
    Ok(if was_asked_to_end {
        Status::Fine
    } else {
        Status::Faulty
    })
}

/// What the command line says of the project.
struct Here<'p> {
    place: &'p Place,
}

impl Host for Here<'_> {
    fn find(&self, directory: &Path) -> Result<fc_lsp::Project, String> {
        let project =
            Project::find_from(self.place, directory).map_err(|error| error.to_string())?;
        // Clients name files by where they are, wherever the server was started.
        let root = std::path::absolute(&project.root).map_err(|error| error.to_string())?;
        Ok(fc_lsp::Project::new(root, project.spec, project.targets))
    }

    fn today(&self) -> String {
        today(None)
    }
}
