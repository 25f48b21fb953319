//! `fcproto check`.

use std::fmt::Write as _;

use clap::ValueEnum;
use fc_codegen::output::{replace_spec_file, unified};
use fc_spec::diagnostic::{Faults, Format, render};
use fc_spec::fix::{Done, fix_all};
use fc_spec::syntax::Sources;

use crate::lang::{counted, lang, said};
use crate::outcome::{Failure, Status};
use crate::place::Place;
use crate::print;
use crate::project::{Project, in_repository};
use crate::spec::{Spec, show_faults};

/// Find all errors in the spec.
///
/// All errors in all files are reported in one run. Text goes to standard error, the other formats to
/// standard output.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  fcproto check
  fcproto check --format json | jq -r .message
  fcproto check --format sarif > fc.sarif
  fcproto check --fix --dry-run     show the fixes that leave no choice
  fcproto check -q --deny warnings  for a hook: silent unless there is something to fix")]
#[command(after_long_help = "\
Examples:
  fcproto check
  fcproto check --format json | jq -r .message
  fcproto check --format sarif > fc.sarif
  fcproto check -q --deny warnings  for a hook: silent unless there is something to fix

JSON:
  Each line is one error or warning: code, severity (error or warning), title (of the code), message,
  primary (a place), secondary (places), notes (texts), fixes (message, replacement, place).
  A place has path, line, column, end_line, end_column (counted from 1, in characters, end
  exclusive), start, end (in bytes) and label. Every key is always present.

Fixes:
  `--fix` makes those that leave no choice: characters typed with a Chinese keyboard, tabs, a missing space after a colon,
  quotes where a value is a text, yes for true, a date with other signs, and a key or word with one wrong letter. Files are
  written only if fewer faults are left.

Paths:
  In text and json they are relative to the project root, in sarif and github to the repository
  that contains it ($GITHUB_WORKSPACE, or the nearest directory upwards with a .git); without one, to the
  current directory.

Warnings:
  For example a text that `fcproto new` has left to be written. They change the exit status only with `--deny warnings`.")]
pub struct Options {
    /// Output format.
    #[arg(long, value_name = "FORMAT", default_value = "text")]
    format: Shown,
    /// What ends with status 1 although it is not an error.
    #[arg(long, value_name = "WHAT")]
    deny: Option<Denied>,
    /// Make the fixes that leave no choice, and check what is left.
    #[arg(long)]
    fix: bool,
    /// Show what `--fix` would change as a unified diff, and write nothing.
    #[arg(long, requires = "fix")]
    dry_run: bool,
}

/// What `--deny` takes for errors.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum Denied {
    /// Every warning
    Warnings,
}

/// Output format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Shown {
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
    let mut spec = Spec::in_project(&project);
    if options.fix {
        spec = fixed(&project, spec, options)?;
    }
    if let Some(model) = &spec.model {
        project.targets.check_audiences(model)?;
    }
    options.format.show(&project, &spec.faults, &spec.sources)?;
    if let (Shown::Text, Some(model)) = (options.format, &spec.model) {
        let files = counted(spec.files(), "文件", "file");
        let operations = counted(model.operations.len(), "接口", "operation");
        let types = counted(model.types.len(), "类型", "type");
        let checked = print::good(&said!("检查完毕", "checked"));
        print::done(&said!(
            "{checked}：{files}，{operations}，{types}\n",
            "{checked} {files}: {operations}, {types}\n"
        ))?;
    }
    Ok(options.status(&spec))
}

/// The spec with the certain fixes made, on the disk as well unless that is only to be shown.
fn fixed(project: &Project, spec: Spec, options: &Options) -> Result<Spec, Failure> {
    let Some(fixed) = fix_all(&spec.sources, |sources| {
        spec.instead(sources.clone()).faults
    }) else {
        if options.format == Shown::Text {
            print::done(&said!(
                "没有能自动修改的错误\n",
                "nothing that can be fixed without a choice\n"
            ))?;
        }
        return Ok(spec);
    };
    let mut changed = String::new();
    for ((_, old), (_, new)) in spec.sources.iter().zip(fixed.sources.iter()) {
        if old.text == new.text {
            continue;
        }
        let path = &old.path;
        if options.dry_run {
            let (before, after) = (format!("a/{path}"), format!("b/{path}"));
            changed += &print::diff(&unified(&before, &after, &old.text, &new.text));
        } else {
            replace_spec_file(&project.root, path, &new.text)?;
        }
    }
    let mut told = String::new();
    for Done {
        code,
        path,
        line,
        message,
    } in &fixed.done
    {
        let message = lang().text(message);
        let fixed = print::good(&said!("已修改", "fixed"));
        let _ = writeln!(told, "{fixed} {path}:{line} {code}: {message}");
    }
    if options.dry_run {
        print::result(&changed)?;
        return Ok(spec);
    }
    if options.format == Shown::Text {
        print::done(&told)?;
    }
    Ok(Spec::in_project(project))
}

impl Shown {
    /// Shows faults: to people on standard error, to programs on standard output.
    pub fn show(
        self,
        project: &Project,
        faults: &Faults,
        sources: &Sources,
    ) -> Result<(), Failure> {
        let format = match self {
            Self::Text => {
                show_faults(faults, sources)?;
                return Ok(());
            }
            Self::Json => Format::Json,
            Self::Sarif => Format::Sarif,
            Self::Github => Format::Github,
        };
        let rendered = if self == Self::Json {
            render(faults, sources, format, lang())
        } else {
            let prefix = in_repository(&project.root);
            render(faults, &sources.below(&prefix), format, lang())
        };
        print::result(&rendered)?;
        Ok(())
    }
}

impl Options {
    fn status(&self, spec: &Spec) -> Status {
        match spec.status() {
            Status::Fine if self.deny.is_some() && !spec.faults.is_empty() => Status::Faulty,
            status => status,
        }
    }
}
