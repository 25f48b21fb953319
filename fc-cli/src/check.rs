//! `fc check`.

use clap::ValueEnum;
use fc_spec::diagnostic::{Format, render};

use crate::lang::{counted, lang, said};
use crate::outcome::{Failure, Status};
use crate::place::Place;
use crate::print;
use crate::project::{Project, in_repository};
use crate::spec::Spec;

/// Find all errors in the spec.
///
/// All errors in all files are reported in one run. Text goes to standard error, the other formats to
/// standard output.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  fc check
  fc check --format json | jq -r .message
  fc check --format sarif > fc.sarif
  fc check -q --deny warnings    for a hook: silent unless there is something to fix")]
#[command(after_long_help = "\
Examples:
  fc check
  fc check --format json | jq -r .message
  fc check --format sarif > fc.sarif
  fc check -q --deny warnings    for a hook: silent unless there is something to fix

JSON:
  Each line is one error or warning: code, severity (error or warning), title (of the code), message,
  primary (a place), secondary (places), notes (texts), fixes (message, replacement, place).
  A place has path, line, column, end_line, end_column (counted from 1, in characters, end
  exclusive), start, end (in bytes) and label. Every key is always present.

Paths:
  In text and json they are relative to the project root, in sarif and github to the repository
  that contains it ($GITHUB_WORKSPACE, or the nearest directory upwards with a .git); without one, to the
  current directory.

Warnings:
  For example a text that `fc new` has left to be written. They change the exit status only with `--deny warnings`.")]
pub struct Options {
    /// Output format.
    #[arg(long, value_name = "FORMAT", default_value = "text")]
    format: Shown,
    /// What ends with status 1 although it is not an error.
    #[arg(long, value_name = "WHAT")]
    deny: Option<Denied>,
}

/// What `--deny` takes for errors.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Denied {
    /// Every warning
    Warnings,
}

/// Output format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Shown {
    /// With excerpts from the spec, for people
    Text,
    /// One JSON object per line
    Json,
    /// A SARIF 2.1.0 log, for code hosts and editors
    Sarif,
    /// Annotations of a GitHub pull request
    Github,
}

pub fn run(place: &Place, options: &Options) -> Result<Status, Failure> {
    let project = Project::find(place)?;
    let spec = Spec::in_project(&project);
    if let Some(model) = &spec.model {
        project.targets.check_audiences(model)?;
    }
    let format = match options.format {
        Shown::Text => {
            spec.show_faults()?;
            if let Some(model) = &spec.model {
                let files = counted(spec.files(), "文件", "file");
                let operations = counted(model.operations.len(), "接口", "operation");
                let types = counted(model.types.len(), "类型", "type");
                let checked = print::good(&said!("检查完毕", "checked"));
                print::done(&said!(
                    "{checked}：{files}，{operations}，{types}\n",
                    "{checked} {files}: {operations}, {types}\n"
                ))?;
            }
            return Ok(options.status(&spec));
        }
        Shown::Json => Format::Json,
        Shown::Sarif => Format::Sarif,
        Shown::Github => Format::Github,
    };
    let rendered = if format == Format::Json {
        render(&spec.faults, &spec.sources, format, lang())
    } else {
        let prefix = in_repository(&project.root);
        render(&spec.faults, &spec.sources.below(&prefix), format, lang())
    };
    print::result(&rendered)?;
    Ok(options.status(&spec))
}

impl Options {
    fn status(&self, spec: &Spec) -> Status {
        match spec.status() {
            Status::Fine if self.deny.is_some() && !spec.faults.is_empty() => Status::Faulty,
            status => status,
        }
    }
}
