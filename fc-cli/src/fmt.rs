//! `fcproto fmt`.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use fc_codegen::output::replace_spec_file;
use fc_spec::diagnostic::Faults;
use fc_spec::format::{Refused, format};
use fc_spec::source::{FileId, SourceFile};
use fc_spec::syntax::{limits, read_bytes, read_dir, read_files};

use crate::lang::{both, counted, said};
use crate::outcome::{Failure, Status};
use crate::project::Project;
use crate::project_dirs::ProjectDirs;
use crate::{input, print};

/// Options of `fcproto fmt`.
#[derive(Debug, Default, clap::Args)]
pub struct Options {
    #[arg(
        value_name = "FILES",
        help = both("要排版的文件，`-` 为标准输入 [默认：全部规范文件]", "Files to format, `-` for standard input [default: all of the spec]")
    )]
    files: Vec<PathBuf>,
    #[arg(
        long,
        help = both("什么也不写；列出会变的文件，有则以 1 退出", "Write nothing; list files that would change and exit with 1")
    )]
    check: bool,
    #[arg(
        long,
        help = both("什么也不写；以 diff 显示修改", "Write nothing; show the changes as a diff")
    )]
    diff: bool,
}

impl Options {
    /// Returns the options of a run that checks all files and writes nothing.
    pub fn checking() -> Self {
        Self {
            check: true,
            ..Self::default()
        }
    }
}

/// The name of standard input in messages.
const STDIN: &str = "<stdin>";

pub fn run(dirs: &ProjectDirs, options: &Options) -> Result<Status, Failure> {
    let mut faults = Faults::new();
    let from_stdin = options.files.iter().any(|file| file.as_os_str() == "-");
    if from_stdin && options.files.len() > 1 {
        return Err(said!(
            "`-` 表示标准输入，只能单独使用",
            "`-` is for standard input alone"
        )
        .into());
    }
    let mut mark = "";
    let (root, sources) = if from_stdin {
        let bytes = input::stdin(limits::FILE_BYTES)?;
        if bytes.starts_with(BYTE_ORDER_MARK.as_bytes()) {
            mark = BYTE_ORDER_MARK;
        }
        let sources = read_bytes(STDIN.to_owned(), bytes, &mut faults);
        (PathBuf::new(), sources)
    } else if options.files.is_empty() {
        let project = Project::find(dirs)?;
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
        mark,
        shown: String::new(),
        changed: 0,
        mistakes: String::new(),
    };
    for (id, file) in sources.iter().filter(|(_, file)| file.whole) {
        let new = run.laid_out(id, file, &mut faults);
        run.show(file, &new)?;
    }
    if from_stdin || options.check || options.diff {
        print::result(&run.shown)?;
    } else {
        print::done(&run.shown)?;
    }
    faults.sort();
    print::faults(&faults, &sources)?;
    print::message(&run.mistakes)?;
    let stale = options.check && run.changed > 0;
    if stale {
        let files = counted(run.changed, "文件", "file");
        print::message(&said!(
            "{files}没有排好版：运行 `fcproto fmt`\n",
            "{files} not formatted: run `fcproto fmt`\n"
        ))?;
    }
    Ok(match Status::of(&faults) {
        _ if !run.mistakes.is_empty() => Status::Failed,
        Status::Fine => Status::fine_if(!stale),
        status => status,
    })
}

const BYTE_ORDER_MARK: &str = "\u{feff}";

struct Run<'a> {
    root: &'a Path,
    options: &'a Options,
    from_stdin: bool,
    /// The byte order mark of standard input; empty if it has none.
    mark: &'static str,
    /// The text for standard output.
    shown: String,
    /// The number of files whose layout is wrong, or was wrong.
    changed: usize,
    /// Messages about bugs of the formatter. They are not errors of the spec.
    mistakes: String,
}

impl Run<'_> {
    /// Returns the formatted text of a file, or its text unchanged if it cannot be formatted.
    fn laid_out(&mut self, id: FileId, file: &SourceFile, faults: &mut Faults) -> String {
        match format(id, file) {
            Ok(new) => return new,
            Err(Refused::Faults(of_file)) => faults.append(of_file),
            Err(Refused::NotTheSame) => {
                let path = &file.path;
                let line = said!(
                    "错误：`{path}` 保持不变：排版后含义会改变，这是 `fcproto fmt` 的缺陷",
                    "error: `{path}` is unchanged: formatting would change its meaning, which is a bug of `fcproto fmt`"
                );
                self.mistakes += &(print::leveled(&line) + "\n");
            }
        }
        file.text.clone()
    }

    /// Writes a file, or shows its change.
    fn show(&mut self, file: &SourceFile, new: &str) -> Result<(), Failure> {
        let writes = !self.options.check && !self.options.diff;
        if self.from_stdin && writes {
            self.shown += self.mark;
            self.shown += new;
            return Ok(());
        }
        if new == file.text {
            return Ok(());
        }
        self.changed += 1;
        let path = &file.path;
        if writes {
            replace_spec_file(self.root, path, new)?;
            writeln!(
                self.shown,
                "{} {path}",
                print::good(&said!("已排版", "formatted"))
            )?;
        } else if self.options.diff {
            self.shown += &print::change(path, &file.text, new);
        } else {
            writeln!(self.shown, "{path}")?;
        }
        Ok(())
    }
}
