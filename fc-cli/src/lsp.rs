//! `fcproto lsp`.

use std::path::Path;

use fc_lsp::{Host, serve};
use lsp_server::Connection;

use crate::help::{Help, Part};
use crate::lang::both;
use crate::outcome::{Failure, Status};
use crate::place::Place;
use crate::project::Project;
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

pub fn help() -> Help {
    Help {
        summary: both(
            "启动供编辑器使用的语言服务器",
            "Start the language server for editors",
        ),
        details: vec![Part::Text(both(
            "编辑器自己启动它，通过标准输入和输出以 LSP 通信。项目取自编辑器打开的目录，或第一个打开的文件所在的目录。错误与 `fcproto check` 相同，\
             也包括未保存的修改。配置方法见 docs-site/guides/editors.md。",
            "Editors start it themselves and speak the Language Server Protocol over standard input and output. The project is that of \
             the open directory, or of the first open file. Errors are those of `fcproto check`, also for unsaved changes. \
             docs-site/en/guides/editors.md describes the setup.",
        ))],
        fails: both(
            "编辑器没有请求结束就断开",
            "The editor disconnects without ending the session",
        ),
        speaks: both(
            "不变化：语言由编辑器指定",
            "None: the editor chooses the language",
        ),
    }
}

pub fn run(place: &Place, _options: &Options) -> Result<Status, Failure> {
    let (connection, threads) = Connection::stdio();
    let was_asked_to_end = serve(&connection, &Here { place })?;
    // The writing thread ends when the connection is dropped.
    drop(connection);
    threads.join()?;
    Ok(if was_asked_to_end {
        Status::Fine
    } else {
        Status::Faulty
    })
}

/// The host of the server, with the project options of the command line.
struct Here<'p> {
    place: &'p Place,
}

impl Host for Here<'_> {
    fn find(&self, directory: &Path) -> Result<fc_lsp::Project, String> {
        let project =
            Project::find_from(self.place, directory).map_err(|error| error.to_string())?;
        // Clients name files by absolute paths, independent of the server's directory.
        let root = std::path::absolute(&project.root).map_err(|error| error.to_string())?;
        Ok(fc_lsp::Project::new(root, project.spec, project.targets))
    }

    fn today(&self) -> String {
        today(None)
    }
}
