//! `fcproto generate`.

use std::path::PathBuf;

use fc_codegen::emit::generate;
use fc_codegen::output::{Plan, plan};
use fc_codegen::package::items::clashes;
use fc_codegen::target::part;
use fc_spec::model::{Dump, Model};

use crate::lang::{both, counted, said};
use crate::outcome::{Failure, Status};
use crate::project::Project;
use crate::project_dirs::ProjectDirs;
use crate::spec::Spec;
use crate::versions::Shelf;
use crate::{input, plugin, print, progress, watch};

/// Options of `fcproto generate`.
#[derive(Debug, Default, clap::Args)]
pub struct Options {
    #[arg(
        long,
        help = both("什么也不写；有文件过期就显示差异并以 1 退出", "Write nothing; show stale files and exit with 1 if any")
    )]
    check: bool,
    #[arg(
        long,
        conflicts_with_all = ["check", "from", "as_of"],
        help = both("每次修改后重新生成，直到 Ctrl-C", "Generate again after each change, until Ctrl-C")
    )]
    watch: bool,
    #[arg(
        long,
        value_name = "TARGETS",
        value_delimiter = ',',
        help = both("只生成 `fc.yaml` 中的这些目标", "Generate only these targets of `fc.yaml`")
    )]
    only: Vec<String>,
    #[arg(
        long = "for",
        value_name = "AUDIENCE",
        requires = "out",
        help = both("只含规范中这个受众的内容", "Include only the part of this audience of the spec")
    )]
    audience: Option<String>,
    #[arg(
        long,
        value_name = "DIR",
        help = both("写到这个目录下，而不是项目中", "Write below this directory instead of the project")
    )]
    out: Option<PathBuf>,
    #[arg(
        long,
        value_name = "FILE",
        help = both("读取 `fcproto inspect` 的输出，`-` 为标准输入", "Read output of `fcproto inspect`, `-` for standard input")
    )]
    from: Option<PathBuf>,
    #[arg(
        long,
        value_name = "RELEASE",
        requires = "out",
        conflicts_with = "from",
        help = both("生成这次发布的内容，例如 `2026.12`", "Generate this release, such as `2026.12`")
    )]
    as_of: Option<String>,
}

pub fn run(dirs: &ProjectDirs, options: &Options) -> Result<Status, Failure> {
    if options.watch {
        return watch::run(dirs, |dirs| once(dirs, options));
    }
    once(dirs, options)
}

fn once(dirs: &ProjectDirs, options: &Options) -> Result<Status, Failure> {
    in_project(Project::find(dirs)?, dirs, options)
}

/// Generates or checks the files of a project. Messages use `dirs` in commands for the user.
pub fn in_project(
    project: Project,
    dirs: &ProjectDirs,
    options: &Options,
) -> Result<Status, Failure> {
    let dump = if let Some(path) = &options.from {
        Some((path.display().to_string(), input::text(path)?))
    } else if let Some(release) = &options.as_of {
        let path = Shelf::of(project.clone())?.released(release)?;
        Some((path.display().to_string(), input::file(&path)?))
    } else {
        None
    };
    if let Some((name, text)) = dump {
        return make(&dumped(&name, &text)?, &name, project, dirs, options);
    }
    let spec = Spec::in_project(project);
    spec.show_faults()?;
    match &spec.model {
        Some(model) => {
            let read = counted(spec.files(), "文件", "file");
            make(model, &read, spec.project, dirs, options)
        }
        None => Ok(spec.status()),
    }
}

impl Options {
    /// Returns the options of a run that checks the files of these targets, or of all, and writes nothing.
    pub fn checking(only: Vec<String>) -> Self {
        Self {
            check: true,
            only,
            ..Self::default()
        }
    }
}

/// Returns the model from the output of `fcproto inspect`.
pub fn dumped(name: &str, text: &str) -> Result<Model, Failure> {
    Ok(Dump::read(text).map_err(|error| {
        said!(
            "`{name}`：{error}",
            "`{name}`: {error}",
            error = error.text()
        )
    })?)
}

/// Generates or checks the files of a model. `read` names its source in messages.
fn make(
    model: &Model,
    read: &str,
    project: Project,
    dirs: &ProjectDirs,
    options: &Options,
) -> Result<Status, Failure> {
    let root = options.out.as_ref().unwrap_or(&project.root);
    if options.out.is_some() {
        project.check_apart(root)?;
    }
    let targets = project.targets.only(&options.only)?;
    let part = part(model, options.audience.as_deref())?;
    let model = &*part;
    // Errors of a spec have already been reported with their places.
    if let Some(clash) = clashes(model, &targets.languages()).first() {
        return Err(format!("`{read}`: {clash}").into());
    }
    progress::doing(both("正在生成", "generating"));
    let mut artifacts = generate(model, &targets)?;
    for target in targets.plugins() {
        artifacts.extend(plugin::run(target, model, &project.root)?);
    }
    if let Some(out) = &options.out.as_ref().filter(|_| !options.check) {
        std::fs::create_dir_all(out).map_err(|error| {
            let out = out.display();
            said!(
                "无法创建 `{out}`：{error}",
                "cannot create `{out}`: {error}"
            )
        })?;
    }
    let plan = plan(artifacts, root, &options.only)?;

    let read = said!("读取 {read}\n", "read       {read}\n");
    if options.check {
        return check(&plan, &read, dirs, options);
    }
    plan.write()?;
    print::done(&(read + &summary(&plan)))?;
    Ok(Status::Fine)
}

fn check(
    plan: &Plan,
    read: &str,
    dirs: &ProjectDirs,
    options: &Options,
) -> Result<Status, Failure> {
    if plan.is_fresh() {
        let count = counted(plan.unchanged.len(), "文件", "file");
        let current = print::good(&said!("最新", "up to date"));
        print::done(&format!("{read}{current} {count}\n"))?;
        return Ok(Status::Fine);
    }
    let mut out = String::new();
    for file in plan.diffs() {
        out += &print::diff(&file.text);
        out.push('\n');
    }
    for path in &plan.foreign {
        out += &said!(
            "{path}：占用了位置，却不是生成器写的\n\n",
            "{path}: exists, but the generator did not write it\n\n"
        );
    }
    print::result(&out)?;

    let stale = plan.created.len() + plan.updated.len() + plan.orphaned.len() + plan.foreign.len();
    let verb = if stale == 1 { "is" } else { "are" };
    let files = counted(stale, "文件", "file");
    let command = command(dirs, options);
    print::error(&said!(
        "{files}已过期；运行 `{command}`",
        "{files} {verb} stale; run `{command}`"
    ))?;
    Ok(Status::Faulty)
}

/// Returns a summary of the changed files.
fn summary(plan: &Plan) -> String {
    let mut out = String::new();
    for (what, changed) in [
        (both("新建", "created"), &plan.created),
        (both("更新", "updated"), &plan.updated),
        (both("删除", "removed"), &plan.orphaned),
    ] {
        if changed.is_empty() {
            continue;
        }
        let files = counted(changed.len(), "文件", "file");
        out += &said!("{what} {files}\n", "{what:<10} {files}\n");
        let indent = "             ";
        let lines = changed.iter();
        out += &print::first(lines.map(|it| format!("{indent}{}\n", it.path)), indent);
    }
    if !plan.unchanged.is_empty() {
        let unchanged = counted(plan.unchanged.len(), "文件", "file");
        out += &said!("不变 {unchanged}\n", "unchanged  {unchanged}\n");
    }
    out
}

/// Returns the command that brings the files up to date, with the options of this run.
fn command(dirs: &ProjectDirs, options: &Options) -> String {
    let path = |path: &Option<PathBuf>| path.as_ref().map(|it| it.display().to_string());
    let only = options.only.join(",");
    let options = [
        ("--only", Some(only).filter(|it| !it.is_empty())),
        ("--for", options.audience.clone()),
        ("--out", path(&options.out)),
        ("--from", path(&options.from)),
        ("--as-of", options.as_of.clone()),
        ("--root", path(&dirs.root)),
        ("--spec", path(&dirs.spec)),
    ];
    let mut command = "fcproto generate".to_owned();
    for (option, value) in options {
        command.extend(value.map(|value| format!(" {option} {}", shell_words::quote(&value))));
    }
    command
}
