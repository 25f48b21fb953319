//! `fc fmt`.

use std::io::Read as _;
use std::path::{Path, PathBuf};

use fc_codegen::output::{replace_spec_file, unified};
use fc_spec::diagnostic::{FaultCode, Faults, Format, render, summary};
use fc_spec::format::{Refused, format};
use fc_spec::syntax::{Sources, limits, read_bytes, read_dir, read_files};

use crate::outcome::{Failure, Status};
use crate::place::Place;
use crate::print;
use crate::project::Project;

/// Lay out the files of the spec: their keys in one order, their lines in one form.
///
/// Comments and values stay as they are, to the byte, and so does the order of all that is sent. A file with errors in
/// its YAML or with unknown keys is left as it is, and one that is laid out already is not touched.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  fc fmt
  fc fmt --check              for continuous integration: names what is not laid out
  fc fmt spec/types.yaml --diff
  fc fmt - < spec/types.yaml  for editors: the text comes back on standard output

A hook for git, .git/hooks/pre-commit:
  #!/bin/sh
  exec fc fmt --check")]
pub struct Options {
    /// Files to lay out, `-` for standard input [default: all of the spec]
    #[arg(value_name = "FILES")]
    files: Vec<PathBuf>,
    /// Write nothing; name the files that would change and exit with 1 if there are any.
    #[arg(long)]
    check: bool,
    /// Write nothing; show what would change as a unified diff.
    #[arg(long)]
    diff: bool,
}

/// What a text from standard input is called.
const STDIN: &str = "<stdin>";

pub fn run(place: &Place, options: &Options) -> Result<Status, Failure> {
    let mut faults = Faults::new();
    let from_stdin = options.files.iter().any(|file| file.as_os_str() == "-");
    if from_stdin && options.files.len() > 1 {
        return Err("`-` is for standard input alone".into());
    }
    let (root, sources) = if from_stdin {
        (PathBuf::new(), stdin(&mut faults)?)
    } else if options.files.is_empty() {
        let project = Project::find(place)?;
        let sources = read_dir(&project.root, &project.spec, &mut faults);
        (project.root, sources)
    } else {
        let files = options.files.iter().map(PathBuf::as_path);
        let named = files.map(|file| (file.display().to_string(), file));
        (PathBuf::new(), read_files(named, &mut faults))
    };

    let mut run = Run {
        root: &root,
        options,
        from_stdin,
        shown: String::new(),
        changed: 0,
    };
    run.all(&sources, &mut faults)?;
    let Run { shown, changed, .. } = run;
    print::result(&shown)?;
    if !faults.is_empty() {
        faults.sort();
        let summary = summary(&faults).map(|line| print::leveled(&line) + "\n");
        print::message(
            &(render(&faults, &sources, Format::Colored) + &summary.unwrap_or_default()),
        )?;
    }
    if options.check && changed > 0 {
        let files = print::counted(changed, "file");
        print::message(&format!("{files} not laid out: run `fc fmt`\n"))?;
    }
    let unreadable = |code| matches!(code, FaultCode::Unreadable);
    Ok(if faults.iter().any(|fault| unreadable(fault.code)) {
        Status::Failed
    } else if faults.has_errors() || (options.check && changed > 0) {
        Status::Faulty
    } else {
        Status::Fine
    })
}

/// The text on standard input.
fn stdin(faults: &mut Faults) -> Result<Sources, Failure> {
    let mut bytes = Vec::new();
    // One byte more than a file may have, so that one that is too long is seen to be.
    let limit = u64::try_from(limits::FILE_BYTES).unwrap_or(u64::MAX);
    std::io::stdin()
        .take(limit.saturating_add(1))
        .read_to_end(&mut bytes)
        .map_err(|error| format!("cannot read standard input: {error}"))?;
    Ok(read_bytes(STDIN.to_owned(), bytes, faults))
}

struct Run<'a> {
    root: &'a Path,
    options: &'a Options,
    from_stdin: bool,
    /// What goes to standard output.
    shown: String,
    changed: usize,
}

impl Run<'_> {
    fn all(&mut self, sources: &Sources, faults: &mut Faults) -> Result<(), Failure> {
        let shows = self.options.check || self.options.diff;
        for (id, file) in sources.iter().filter(|(_, file)| file.whole) {
            let new = match format(id, file) {
                Ok(new) => new,
                Err(refused) => {
                    match refused {
                        Refused::Faults(of_file) => faults.append(of_file),
                        Refused::NotTheSame => {
                            return Err(format!(
                                "`{}` was left as it is: laid out, it would not say the same; this is a mistake of \
                                 `fc fmt`",
                                file.path
                            )
                            .into());
                        }
                    }
                    file.text.clone()
                }
            };
            if self.from_stdin && !shows {
                self.shown += &new;
            }
            if new == file.text {
                continue;
            }
            self.changed += 1;
            if self.options.check {
                self.shown += &format!("{}\n", file.path);
            }
            if self.options.diff {
                let (old_name, new_name) = (format!("a/{}", file.path), format!("b/{}", file.path));
                self.shown += &print::diff(&unified(&old_name, &new_name, &file.text, &new));
            }
            if !shows && !self.from_stdin {
                replace_spec_file(self.root, &file.path, &new)?;
                self.shown += &format!("{} {}\n", print::good("laid out"), file.path);
            }
        }
        Ok(())
    }
}
