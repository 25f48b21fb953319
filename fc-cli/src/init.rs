//! `fcproto init`.

use std::fs;
use std::path::{Path, PathBuf};

use crate::lang::{both, said};
use crate::outcome::{Failure, Status, unreadable, unwritable};
use crate::project_dirs::ProjectDirs;
use crate::{generate, print};

/// Options of `fcproto init`.
#[derive(Debug, clap::Args)]
pub struct Options {
    #[arg(
        value_name = "DIR",
        help = both("要创建的目录；已存在时须为空", "Directory to create; if it exists, it must be empty")
    )]
    directory: PathBuf,
    #[arg(
        long,
        value_name = "DIR",
        help = both("含有 `fc-runtime` 和 `fc-derive` 的源码目录", "Checkout with `fc-runtime` and `fc-derive`")
    )]
    runtime: Option<PathBuf>,
}

/// A template in both languages.
macro_rules! template {
    ($path:literal) => {
        [
            include_str!(concat!("../templates/init/zh/", $path)),
            include_str!(concat!("../templates/init/", $path)),
        ]
    };
}

/// Files of the project in Chinese and in English.
const FILES: [(&str, [&str; 2]); 8] = [
    ("fc.yaml", template!("fc.yaml")),
    (".gitattributes", template!("gitattributes")),
    ("README.md", template!("README.md")),
    ("spec/protocol.yaml", template!("spec/protocol.yaml")),
    ("spec/commands/light.yaml", [LIGHT, LIGHT]),
    ("examples/robot.rs", template!("examples/robot.rs")),
    ("examples/app.rs", template!("examples/app.rs")),
    ("tests/talk.rs", template!("tests/talk.rs")),
];

/// A group of operations with texts in both languages.
const LIGHT: &str = include_str!("../templates/init/spec/commands/light.yaml");

/// The `.gitignore` of the project.
const IGNORED: &str = include_str!("../templates/init/gitignore");

/// The `Cargo.toml` of the project, with placeholders for the sources of [`CRATES`].
const MANIFEST: &str = include_str!("../templates/init/Cargo.toml.in");

/// The crates that the project depends on.
const CRATES: [&str; 2] = ["fc-derive", "fc-runtime"];

pub fn run(dirs: &ProjectDirs, options: &Options) -> Result<Status, Failure> {
    let directory = &options.directory;
    if dirs.root.is_some() || dirs.spec.is_some() {
        return Err(said!(
            "`fcproto init DIR` 在 DIR 中建立项目；它没有 --root 和 --spec",
            "`fcproto init DIR` creates a project in DIR; leave out --root and --spec"
        )
        .into());
    }
    let manifest = manifest(options.runtime.as_deref())?;
    refuse_existing_files(directory)?;
    let files = FILES.map(|(path, [zh, en])| (path, both(zh, en)));
    let others = [(".gitignore", IGNORED), ("Cargo.toml", manifest.as_str())];
    for (path, text) in files.into_iter().chain(others) {
        write(&directory.join(path), text)?;
    }
    let dirs = ProjectDirs {
        root: Some(directory.clone()),
        spec: None,
    };
    let status = generate::run(&dirs, &generate::Options::default())?;
    let (created, directory) = (
        print::good(&said!("已建立", "created")),
        directory.display(),
    );
    print::done(&said!(
        "{created} {directory}\n下一步见其中的 README.md；在那里运行 `cargo test`，它的机器人和 app 就会互相通信\n",
        "{created} {directory}\nnext: read its README.md; `cargo test` there runs its robot and its app\n"
    ))?;
    Ok(status)
}

/// Refuses a directory that contains anything except `.git`.
fn refuse_existing_files(directory: &Path) -> Result<(), Failure> {
    let entries = match fs::read_dir(directory) {
        Ok(entries) => entries,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(()),
        Err(error) => return Err(unreadable(directory)(error)),
    };
    for entry in entries {
        let name = entry?.file_name();
        if name != ".git" {
            let (directory, name) = (directory.display(), name.to_string_lossy());
            return Err(said!(
                "`{directory}` 不是空目录：里面有 `{name}`；请指定别的目录",
                "`{directory}` is not empty: it has `{name}`; name another directory"
            )
            .into());
        }
    }
    Ok(())
}

fn manifest(runtime: Option<&Path>) -> Result<String, Failure> {
    let built_from = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    // A program from a registry has no checkout around it.
    let has = |checkout: &&Path| CRATES.iter().all(|name| checkout.join(name).is_dir());
    let checkout = runtime.or_else(|| Some(built_from.as_path()).filter(has));
    let mut manifest = MANIFEST.to_owned();
    // Cargo packs no crate with a dependency that has only a path.
    let version = format!("version = {:?}", env!("CARGO_PKG_VERSION"));
    for name in CRATES {
        let from = match checkout {
            Some(checkout) => format!("{}, {version}", path_of(&checkout.join(name))?),
            None => version.clone(),
        };
        manifest = manifest.replace(&format!("{{{{{name}}}}}"), &from);
    }
    Ok(manifest)
}

fn path_of(path: &Path) -> Result<String, Failure> {
    let path = path.canonicalize().map_err(|error| {
        let path = path.display();
        said!(
            "没有 `{path}`（{error}）；用 --runtime 指定一份源码",
            "there is no `{path}` ({error}); name a checkout with --runtime"
        )
    })?;
    // TOML and Rust quote and escape this in the same way.
    Ok(format!("path = {:?}", path.to_string_lossy()))
}

fn write(path: &Path, text: &str) -> Result<(), Failure> {
    let made = path.parent().map_or(Ok(()), fs::create_dir_all);
    let written = made.and_then(|()| fs::write(path, text));
    written.map_err(unwritable(path))
}
