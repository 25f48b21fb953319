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
mod place;
mod places;
mod plugin;
mod print;
mod progress;
mod project;
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

use std::process::ExitCode;

use clap::Parser;
use clap_complete::CompleteEnv;

use args::{Args, Command};
use outcome::{Failure, Status, Told};
use spec::Spec;

fn main() -> ExitCode {
    lang::speak(std::env::args_os().skip(1));
    CompleteEnv::with_factory(shell::command).complete();
    let args = match Args::try_parse() {
        Ok(args) => args,
        Err(error) => return help::usage::told(error),
    };
    args.color.apply();
    print::quiet(args.quiet);
    let status = run(&args).unwrap_or_else(|failure| {
        if print::is_closed_pipe(failure.as_ref()) {
            // The reader of the output has closed it, so a message would have no reader.
            return Status::Fine;
        }
        if let Some(Told(status)) = failure.downcast_ref() {
            return *status;
        }
        print::failure(failure.as_ref());
        Status::Failed
    });
    progress::done();
    ExitCode::from(status as u8)
}

fn run(args: &Args) -> Result<Status, Failure> {
    let place = &args.place;
    match &args.command {
        Command::Check(options) => check::run(place, options),
        Command::Explain(options) => explain::run(options),
        Command::Lint(options) => lint::run(place, options),
        Command::Fmt(options) => fmt::run(place, options),
        Command::Init(options) => init::run(place, options),
        Command::New(options) => new::run(&Spec::read(place)?, options),
        Command::Generate(options) => generate::run(place, options),
        Command::Package(options) => package::run(place, options),
        Command::Inspect(options) => inspect::run(&Spec::read(place)?, options),
        Command::Where(options) => places::run(place, options),
        Command::Questions(options) => questions::run(Spec::read(place)?.valid()?, options),
        Command::Settle(options) => settle::run(Spec::read(place)?, options),
        Command::Diff(options) => diff::run(place, options),
        Command::Changelog(options) => changelog::run(place, options),
        Command::Release(options) => release::run(&Spec::read(place)?, options),
        Command::Codes(options) => codes::run(Spec::read(place)?.valid()?, options),
        Command::Decode(options) => decode::run(Spec::read(place)?.valid()?, options),
        Command::Drift(options) => drift::run(&Spec::read(place)?, options),
        Command::Encode(options) => encode::run(Spec::read(place)?.valid()?, options),
        Command::Retire(options) => retire::run(&Spec::read(place)?, options),
        Command::Call(options) => call::run(Spec::read(place)?.valid()?, options),
        Command::Mock(options) => mock::run(Spec::read(place)?.valid()?, options),
        Command::Certify(options) => certify::run(Spec::read(place)?.valid()?, options),
        #[cfg(feature = "record")]
        Command::Record(options) => record::run(Spec::read(place)?.valid()?, options),
        Command::Proxy(options) => proxy::run(Spec::read(place)?.valid()?, options),
        Command::Lsp(options) => lsp::run(place, options),
        Command::Completions(options) => shell::completions(options),
        Command::Man(options) => shell::man(options),
        Command::Git(options) => git::run(place, options),
        Command::GitDiff(options) => git::diff::run(place, options),
        Command::Schema(options) => schema::run(place, options),
        Command::HelpPage => help::page(),
    }
}
