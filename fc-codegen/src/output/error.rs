//! The reasons why output cannot be written.

use super::manifest::MANIFEST;
use fc_spec::model::Text;
use std::io;

/// The reason why output cannot be written. Only an [`Io`](Self::Io) error can leave part of the changes on the disk.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum OutputError {
    /// An artifact or the manifest names a path that may lead out of the root.
    #[error("`{path}` cannot be written: {}", why.en)]
    BadPath {
        /// The path.
        path: String,
        /// The reason why the path is bad.
        why: Text,
    },
    /// Two artifacts have the same path, or paths that differ only in case.
    #[error("two artifacts are called `{path}`; rename one of the things they are made from")]
    Duplicate {
        /// The path of the second artifact.
        path: String,
    },
    /// A part of a path below the root is a symbolic link.
    #[error("`{path}` is a symbolic link; replace it by what it points to, or delete it")]
    Symlink {
        /// The link.
        path: String,
    },
    /// A path leads to a directory, a pipe or a device.
    #[error("`{path}` is not a regular file; delete it")]
    NotAFile {
        /// The path.
        path: String,
    },
    /// Files with other contents are in the places of artifacts, and the manifest does not list them.
    #[error(
        "{} would have to be overwritten, but `{MANIFEST}` does not list {}: move or delete {} and \
         run `fcproto generate` again",
        list(.paths),
        if .paths.len() == 1 { "it" } else { "them" },
        if .paths.len() == 1 { "it" } else { "them" },
    )]
    Foreign {
        /// The paths, sorted.
        paths: Vec<String>,
    },
    /// The manifest cannot be read.
    #[error(
        "`{MANIFEST}` cannot be read: {why}. Restore it from version control, or delete it: \
         generated files that are up to date are then taken over, others have to be deleted first"
    )]
    Manifest {
        /// The reason why it cannot be read.
        why: String,
    },
    /// The operating system refused.
    #[error("cannot {action} `{path}`: {source}")]
    Io {
        /// The failed action, as a verb.
        action: &'static str,
        /// The path.
        path: String,
        /// The error of the operating system.
        source: io::Error,
    },
}

impl OutputError {
    /// Returns a sentence for the user.
    #[must_use]
    pub fn text(&self) -> Text {
        let zh = match self {
            Self::BadPath { path, why } => format!("无法写入 `{path}`：{}", why.zh),
            Self::Duplicate { path } => {
                format!("有两个产物都叫 `{path}`；请给其中一个的来源改名")
            }
            Self::Symlink { path } => {
                format!("`{path}` 是符号链接；请换成它指向的内容，或将它删除")
            }
            Self::NotAFile { path } => format!("`{path}` 不是普通文件；请将它删除"),
            Self::Foreign { paths } => {
                let named = paths.iter().take(3).map(|path| format!("`{path}`"));
                let named = named.collect::<Vec<_>>().join("、");
                let more = match paths.len() {
                    count @ 4.. => format!(" 等 {count} 个文件"),
                    _ => String::new(),
                };
                format!(
                    "必须覆盖 {named}{more}，但 `{MANIFEST}` 中没有列出：请移走或删除，再运行 `fcproto generate`"
                )
            }
            Self::Manifest { why } => format!(
                "无法读取 `{MANIFEST}`：{why}。请从版本库恢复，或将它删除：此后，与最新内容一致的生成文件会被接管，其余的要先删除"
            ),
            Self::Io { path, source, .. } => format!("无法读写 `{path}`：{source}"),
        };
        let en = self.to_string();
        Text { zh, en }
    }
}

/// Returns up to three paths by name, and the number of the others.
fn list(paths: &[String]) -> String {
    let named: Vec<String> = paths
        .iter()
        .take(3)
        .map(|path| format!("`{path}`"))
        .collect();
    let rest = paths.len().saturating_sub(named.len());
    if rest == 0 {
        named.join(", ")
    } else {
        format!("{} and {rest} more", named.join(", "))
    }
}
