//! The reasons why a package cannot be built.

use fc_spec::model::Text;
use fc_spec::{text, text_error};
use std::io;
use std::path::{Path, PathBuf};
use toml_edit::TomlError;

/// The maximum size of a text file, in bytes.
pub const LONGEST: u64 = 256 << 20;

/// The reason why a package cannot be built.
#[derive(Debug)]
#[non_exhaustive]
pub enum PackError {
    /// A file cannot be read.
    Unreadable(PathBuf, io::Error),
    /// A file or a directory cannot be written.
    Unwritable(PathBuf, io::Error),
    /// A path leads to a directory, a pipe or a device.
    NotAFile(PathBuf),
    /// A file is not UTF-8.
    NotUtf8(PathBuf),
    /// A text file has more than 256 MiB.
    TooLarge(PathBuf),
    /// The operating system refused another operation.
    Io(io::Error),
    /// A tool or a manifest has unexpected JSON.
    Json(serde_json::Error),
    /// A manifest is not TOML.
    Toml(TomlError),
    /// The generated files are not part of a package.
    NoManifest {
        /// The directory of the generated files, relative to the project.
        place: String,
        /// The name of the missing file.
        manifest: String,
        /// The directory of the same product without `fc.yaml`, which has an example.
        usual: &'static str,
    },
    /// The number of a package does not consist of one to three numbers with dots.
    Number(String),
    /// A table of a TOML file has no version.
    NoVersion {
        /// The file.
        file: PathBuf,
        /// The name of the table.
        table: String,
    },
    /// A file of properties lacks a key.
    NoProperty {
        /// The file.
        file: PathBuf,
        /// The key.
        key: String,
    },
    /// A directory is not a crate.
    NotACrate(PathBuf),
    /// The `CMakeLists.txt` of this directory does not include `CPack`.
    NoCpack(PathBuf),
    /// A tool has not written a file with this ending.
    NoResult {
        /// The directory to write to.
        directory: PathBuf,
        /// The ending.
        ending: String,
    },
    /// A tool is not installed.
    NoTool {
        /// The name of the program.
        name: &'static str,
        /// The command or page to get it.
        get: &'static str,
    },
    /// A tool cannot be run.
    Tool {
        /// The name of the program.
        name: &'static str,
        /// The error of the operating system.
        error: io::Error,
    },
    /// A tool failed.
    Failed {
        /// The program with its arguments.
        command: String,
        /// The last lines of its output.
        lines: String,
    },
    /// Python cannot import the module `build`. The error is that of the attempt.
    NoBuild(Box<PackError>),
}

impl PackError {
    /// Returns the message in both languages. Errors of the system and of other libraries are only in English.
    #[must_use]
    pub fn text(&self) -> Text {
        match self {
            Self::Unreadable(path, error) => {
                let path = path.display();
                text!(
                    "无法读取 `{path}`：{error}",
                    "cannot read `{path}`: {error}"
                )
            }
            Self::Unwritable(path, error) => {
                let path = path.display();
                text!(
                    "无法写入 `{path}`：{error}",
                    "cannot write `{path}`: {error}"
                )
            }
            Self::NotAFile(path) => {
                let path = path.display();
                text!("`{path}` 不是普通文件", "`{path}` is not a regular file")
            }
            Self::NotUtf8(path) => {
                let path = path.display();
                text!(
                    "`{path}` 不是 UTF-8；请另存为 UTF-8",
                    "`{path}` is not UTF-8; save it as UTF-8"
                )
            }
            Self::TooLarge(path) => {
                let (path, most) = (path.display(), LONGEST >> 20);
                text!(
                    "`{path}` 超过 {most} MiB",
                    "`{path}` is larger than {most} MiB"
                )
            }
            Self::Io(error) => text!("{error}", "{error}"),
            Self::Json(error) => text!("{error}", "{error}"),
            Self::Toml(error) => text!("{error}", "{error}"),
            Self::NoManifest {
                place,
                manifest,
                usual,
            } => text!(
                "`{place}` 只有生成的源码：它和上级目录中都没有 `{manifest}`；在那里写一个，或参照 `{usual}` 中的包",
                "`{place}` has only generated sources, because no `{manifest}` is there or in a directory above; write one, \
                 or follow the package in `{usual}`"
            ),
            Self::Number(number) => text!(
                "包的编号应为 `0.2.0` 这样的数，实际为 `{number}`；规范的版本由 `fcproto package` 加上",
                "the number of the package should be like `0.2.0`, but it is `{number}`; `fcproto package` adds the version of the spec"
            ),
            Self::NoVersion { file, table } => {
                let file = file.display();
                text!(
                    "`{file}` 的 `[{table}]` 中没有 `version`",
                    "`[{table}]` of `{file}` has no `version`"
                )
            }
            Self::NoProperty { file, key } => {
                let file = file.display();
                text!("`{file}` 中没有 `{key}=…`", "`{file}` has no `{key}=…`")
            }
            Self::NotACrate(directory) => {
                let directory = directory.display();
                text!("`{directory}` 不是 crate", "`{directory}` is not a crate")
            }
            Self::NoCpack(directory) => {
                let directory = directory.display();
                text!(
                    "`{directory}/CMakeLists.txt` 缺少 `include(CPack)`",
                    "`{directory}/CMakeLists.txt` lacks `include(CPack)`"
                )
            }
            Self::NoResult { directory, ending } => {
                let directory = directory.display();
                text!(
                    "`{directory}` 中没有 `{ending}`",
                    "`{directory}` has no `{ending}`"
                )
            }
            Self::NoTool { name, get } => text!(
                "没有找到 `{name}`；安装方法：{get}",
                "`{name}` is not installed; get it with {get}"
            ),
            Self::Tool { name, error } => {
                text!("无法运行 `{name}`：{error}", "cannot run `{name}`: {error}")
            }
            Self::Failed { command, lines } => {
                text!(
                    "`{command}` 失败：\n{lines}",
                    "`{command}` failed:\n{lines}"
                )
            }
            Self::NoBuild(error) => text!(
                "{error}\n`build` 用 `python3 -m pip install build` 安装",
                "{error}\nget `build` with `python3 -m pip install build`",
                error = error.text()
            ),
        }
    }
}

text_error!(PackError);

impl From<io::Error> for PackError {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}

impl From<serde_json::Error> for PackError {
    fn from(error: serde_json::Error) -> Self {
        Self::Json(error)
    }
}

impl From<TomlError> for PackError {
    fn from(error: TomlError) -> Self {
        Self::Toml(error)
    }
}

/// Adds the path to an error in reading it.
pub fn unreadable(path: &Path) -> impl Fn(io::Error) -> PackError {
    move |error| PackError::Unreadable(path.to_owned(), error)
}

/// Adds the path to an error in writing it.
pub fn unwritable(path: &Path) -> impl Fn(io::Error) -> PackError {
    move |error| PackError::Unwritable(path.to_owned(), error)
}
