//! `fcproto completions` and `fcproto man`: what a shell and its reader want to know of the command line.

use std::path::PathBuf;

use clap::{Command, CommandFactory as _};
use clap_complete::Shell;

use crate::args::Args;
use crate::lang::{counted, said};
use crate::outcome::{Failure, Status};
use crate::print;

/// Print a script that completes this command line in a shell.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  fcproto completions bash > ~/.local/share/bash-completion/completions/fcproto
  fcproto completions zsh > ~/.zfunc/_fcproto     with ~/.zfunc in $fpath
  fcproto completions fish > ~/.config/fish/completions/fcproto.fish")]
pub struct Completions {
    /// Which shell.
    shell: Shell,
}

/// Write the manual pages, one of `fcproto` and one of each command.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  fcproto man ~/.local/share/man/man1 && man fcproto-generate")]
pub struct Man {
    /// Where to; it is made if it is not there.
    #[arg(value_name = "DIR")]
    directory: PathBuf,
}

pub fn completions(options: &Completions) -> Result<Status, Failure> {
    let mut script = Vec::new();
    clap_complete::generate(options.shell, &mut command(), "fcproto", &mut script);
    print::result(&String::from_utf8_lossy(&script))?;
    Ok(Status::Fine)
}

pub fn man(options: &Man) -> Result<Status, Failure> {
    let directory = options.directory.as_path();
    let shown = directory.display();
    let cannot = |error: std::io::Error| {
        said!(
            "无法写入 `{shown}`：{error}",
            "cannot write to `{shown}`: {error}"
        )
    };
    std::fs::create_dir_all(directory).map_err(cannot)?;
    clap_mangen::generate_to(command(), directory).map_err(cannot)?;
    let pages = pages(&command());
    let wrote = print::good(&said!("已写入", "wrote"));
    let pages = counted(pages, "页面", "page");
    print::done(&said!(
        "{wrote} {pages}，在 {shown}\n",
        "{wrote} {pages} in {shown}\n"
    ))?;
    Ok(Status::Fine)
}

/// Number of pages: a command's own, and those of the commands below it.
fn pages(command: &Command) -> usize {
    let below = command.get_subcommands().filter(|it| !it.is_hide_set());
    1 + below.map(pages).sum::<usize>()
}

/// The command line; `help` is not a page of its own, each command has its own.
fn command() -> Command {
    Args::command().disable_help_subcommand(true)
}
