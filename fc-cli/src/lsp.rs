//! `fcproto lsp`.

use fc_lsp::serve;
use lsp_server::Connection;

use crate::lang::both;
use crate::outcome::{Failure, Status};
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
    let was_asked_to_end = serve(&connection, dirs, || today(None))?;
    // The writing thread ends when the connection is dropped.
    drop(connection);
    threads.join()?;
    Ok(Status::fine_if(was_asked_to_end))
}
