//! The `fcproto` command: checks a protocol spec and generates code and docs from it.
//!
//! Each subcommand has one file with its options and messages. `fc_codegen` and the other crates do the work.

mod allow;
mod args;
mod call;
mod certify;
mod changelog;
mod check;
mod codes;
mod complete;
mod decode;
mod diff;
mod drift;
mod encode;
mod endpoint;
mod explain;
mod fmt;
mod generate;
mod git;
mod help;
mod init;
mod input;
mod inspect;
mod lang;
mod lint;
mod lsp;
mod mock;
mod new;
mod outcome;
mod output;
mod package;
mod plugin;
mod print;
mod progress;
mod project;
mod project_dirs;
mod proxy;
mod questions;
#[cfg(feature = "record")]
mod record;
mod recording;
mod release;
mod retire;
mod schema;
mod settle;
mod shell;
mod spec;
mod versions;
#[cfg(feature = "view")]
mod view;
mod watch;
mod where_;

use std::process::ExitCode;

use clap::Parser;
use clap_complete::CompleteEnv;

use args::{Args, Command};
use outcome::{Failure, Reported, Status};
use spec::Spec;

fn main() -> ExitCode {
    lang::speak(std::env::args_os().skip(1));
    CompleteEnv::with_factory(shell::command).complete();
    let args = match Args::try_parse() {
        Ok(args) => args,
        Err(error) => return help::usage::told(error),
    };
    args.color.apply();
    progress::quiet(args.quiet);
    let status = run(&args).unwrap_or_else(|failure| {
        if print::is_closed_pipe(failure.as_ref()) {
            // The reader of the output has closed it, so a message would have no reader.
            return Status::Fine;
        }
        if let Some(Reported(status)) = failure.downcast_ref() {
            return *status;
        }
        print::failure(failure.as_ref());
        Status::Failed
    });
    progress::done();
    ExitCode::from(status as u8)
}

fn run(args: &Args) -> Result<Status, Failure> {
    let dirs = &args.dirs.dirs();
    match &args.command {
        Command::Check(options) => check::run(dirs, options),
        Command::Explain(options) => explain::run(options),
        Command::Lint(options) => lint::run(dirs, options),
        Command::Fmt(options) => fmt::run(dirs, options),
        Command::Init(options) => init::run(dirs, options),
        Command::New(options) => new::run(&Spec::read(dirs)?, options),
        Command::Generate(options) => generate::run(dirs, options),
        Command::Package(options) => package::run(dirs, options),
        Command::Inspect(options) => inspect::run(&Spec::read(dirs)?, options),
        Command::Where(options) => where_::run(dirs, options),
        Command::Questions(options) => questions::run(Spec::read(dirs)?.valid()?, options),
        Command::Settle(options) => settle::run(Spec::read(dirs)?, options),
        Command::Diff(options) => diff::run(dirs, options),
        Command::Changelog(options) => changelog::run(dirs, options),
        Command::Release(options) => release::run(&Spec::read(dirs)?, options),
        Command::Codes(options) => codes::run(Spec::read(dirs)?.valid()?, options),
        Command::Decode(options) => decode::run(Spec::read(dirs)?.valid()?, options),
        Command::Drift(options) => drift::run(&Spec::read(dirs)?, options),
        Command::Encode(options) => encode::run(Spec::read(dirs)?.valid()?, options),
        Command::Retire(options) => retire::run(&Spec::read(dirs)?, options),
        Command::Call(options) => call::run(Spec::read(dirs)?.valid()?, options),
        Command::Mock(options) => mock::run(Spec::read(dirs)?.valid()?, options),
        Command::Certify(options) => certify::run(Spec::read(dirs)?.valid()?, options),
        #[cfg(feature = "record")]
        Command::Record(options) => record::run(Spec::read(dirs)?.valid()?, options),
        Command::Proxy(options) => proxy::run(Spec::read(dirs)?.valid()?, options),
        Command::Lsp(options) => lsp::run(dirs, options),
        Command::Completions(options) => shell::completions(options),
        Command::Man(options) => shell::man(options),
        Command::Git(options) => git::run(dirs, options),
        Command::GitDiff(options) => git::diff::run(dirs, options),
        Command::Schema(options) => schema::run(dirs, options),
        Command::HelpPage => help::page(),
    }
}
