//! `fcproto completions` and `fcproto man`: completion scripts and manual pages.

use std::path::PathBuf;

use clap::Command;
use clap_complete::Shell;
use clap_complete::env::Shells;

use crate::help::{Help, Part, described};
use crate::lang::{both, counted, said};
use crate::outcome::{Failure, Status};
use crate::print;

/// Options of `fcproto completions`.
#[derive(Debug, clap::Args)]
pub struct Completions {
    #[arg(help = both("使用补全的 shell", "Shell that completes"))]
    shell: Shell,
}

pub fn completions_help() -> Help {
    Help {
        summary: both(
            "输出 shell 的补全脚本",
            "Print a completion script for a shell",
        ),
        details: vec![
            Part::Text(both(
                "补全命令和选项；在 `call`、`encode` 和 `decode --name` 后，还按规范补全接口、键和值。脚本在补全时运行 `fcproto`。",
                "Commands and options are completed. After `call`, `encode` and `decode --name`, so are the operations, keys and values \
                 of the spec. The script runs `fcproto` at each completion.",
            )),
            Part::Examples(vec![
                (
                    "fcproto completions bash > ~/.local/share/bash-completion/completions/fcproto",
                    "",
                ),
                (
                    "fcproto completions zsh > ~/.zfunc/_fcproto",
                    both(
                        "`~/.zfunc` 须在 `$fpath` 中",
                        "`~/.zfunc` has to be in `$fpath`",
                    ),
                ),
                (
                    "fcproto completions fish > ~/.config/fish/completions/fcproto.fish",
                    "",
                ),
            ]),
        ],
        fails: "",
        speaks: "",
    }
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

pub fn man_help() -> Help {
    Help {
        summary: both(
            "写出手册页，每条命令一页",
            "Write manual pages, one for each command",
        ),
        details: vec![Part::Examples(vec![(
            "fcproto man ~/.local/share/man/man1 && man fcproto-generate",
            "",
        )])],
        fails: "",
        speaks: both("命令和选项的说明", "Descriptions of commands and options"),
    }
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

/// Returns the number of manual pages of a command and its subcommands.
fn pages(command: &Command) -> usize {
    let below = command.get_subcommands().filter(|it| !it.is_hide_set());
    1 + below.map(pages).sum::<usize>()
}

/// Returns the command line without `help`. Each command already has its own page.
pub fn command() -> Command {
    described().disable_help_subcommand(true)
}
