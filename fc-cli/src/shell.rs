//! `fcproto completions` and `fcproto man`: completion scripts and manual pages.

use std::path::PathBuf;

use clap::Command;
use clap_complete::Shell;
use clap_complete::env::Shells;

use crate::help::described;
use crate::lang::{both, counted, said};
use crate::outcome::{Failure, Status, unwritable};
use crate::print;

/// Options of `fcproto completions`.
#[derive(Debug, clap::Args)]
pub struct Completions {
    #[arg(help = both("使用补全的 shell", "Shell that completes"))]
    shell: Shell,
}

/// Options of `fcproto man`.
#[derive(Debug, clap::Args)]
pub struct Man {
    #[arg(
        value_name = "DIR",
        help = both("写入的目录，没有则创建", "Directory to write to; created if missing")
    )]
    directory: PathBuf,
}

pub fn completions(options: &Completions) -> Result<Status, Failure> {
    let shell = options.shell.to_string();
    let shells = Shells::builtins();
    let mut script = Vec::new();
    if let Some(completer) = shells.completer(&shell) {
        completer.write_registration("COMPLETE", "fcproto", "fcproto", "fcproto", &mut script)?;
    }
    print::result(&String::from_utf8_lossy(&script))?;
    Ok(Status::Fine)
}

pub fn man(options: &Man) -> Result<Status, Failure> {
    let directory = options.directory.as_path();
    let shown = directory.display();
    std::fs::create_dir_all(directory).map_err(unwritable(directory))?;
    clap_mangen::generate_to(command(), directory).map_err(unwritable(directory))?;
    let pages = pages(&command());
    let wrote = print::good(&said!("已写入", "wrote"));
    let pages = counted(pages, "页面", "page");
    print::done(&said!(
        "{wrote} {pages}，在 {shown}\n",
        "{wrote} {pages} in {shown}\n"
    ))?;
    Ok(Status::Fine)
}

/// Returns the number of manual pages of a command and its subcommands.
fn pages(command: &Command) -> usize {
    let below = command.get_subcommands().filter(|it| !it.is_hide_set());
    1 + below.map(pages).sum::<usize>()
}

/// Returns the command line without `help`. Each command already has its own page.
pub fn command() -> Command {
    described().disable_help_subcommand(true)
}
