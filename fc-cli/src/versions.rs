//! Reads the versions of the spec that a command line names.

use std::path::{Path, PathBuf};

use fc_codegen::target::Targets;
use fc_diff::release::Releases;
use fc_diff::{Finding, Packages, ProjectSpec, Version, VersionError};
use fc_spec::diagnostic::{Format, render};

use crate::lang::{both, lang, said};
use crate::outcome::{Failure, Reported, Status, unreadable};
use crate::print;
use crate::progress;
use crate::project::Project;
use crate::project_dirs::ProjectDirs;

/// The versions to compare.
#[derive(Debug, clap::Args)]
pub struct Named {
    #[arg(
        value_name = "OLD",
        help = both("旧版本 [默认：上一次发布]", "Old version [default: the last release]")
    )]
    pub old: Option<String>,
    #[arg(
        value_name = "NEW",
        help = both("新版本 [默认：本项目]", "New version [default: this project]")
    )]
    pub new: Option<String>,
}

/// The places to look for versions.
pub struct Shelf {
    /// The project, or the current directory without one.
    pub project: Project,
    /// The releases of the spec.
    pub releases: Releases,
}

impl Shelf {
    /// Returns the shelf of a project.
    pub fn of(project: Project) -> Result<Self, Failure> {
        let home = project.root.join(&project.spec);
        let directory = home.join(fc_diff::release::DIRECTORY);
        let releases = Releases::beside(&home).map_err(unreadable(&directory))?;
        Ok(Self { project, releases })
    }

    /// Returns the shelf of the project. Without a project, uses the current directory if `is_needed` is `false`.
    pub fn find(dirs: &ProjectDirs, is_needed: bool) -> Result<Self, Failure> {
        match Project::find(dirs) {
            Ok(project) => Self::of(project),
            Err(error) if is_needed => Err(error.into()),
            Err(_) => Self::of(Project {
                root: ".".into(),
                spec: "spec".into(),
                targets: Targets::default(),
            }),
        }
    }

    /// Reads the versions of a command line. Shows the errors of both specs if one has any.
    pub fn named(&self, versions: &Named) -> Result<[Version; 2], Failure> {
        let old = match &versions.old {
            Some(old) => old.clone(),
            None => self.last()?,
        };
        let new = versions.new.clone();
        self.both(&old, &new.unwrap_or_else(|| self.here()))
    }

    /// Reads two versions. Shows the errors of both specs if one has any.
    pub fn both(&self, old: &str, new: &str) -> Result<[Version; 2], Failure> {
        match (self.read(old)?, self.read(new)?) {
            (Some(old), Some(new)) => Ok([old, new]),
            _ => Err(Reported(Status::Faulty).into()),
        }
    }

    /// Returns the name of the last release.
    fn last(&self) -> Result<String, Failure> {
        match self.releases.last() {
            Some((number, _)) => Ok(number.to_string()),
            None => Err(
                said!(
                    "没有可供比较的发布版本；请写明版本，例如 git:main，或用 `fcproto release` 发布第一个版本",
                    "there is no release to compare with; name a version, such as git:main, or make the first release with `fcproto release`"
                )
                .into(),
            ),
        }
    }

    /// Returns the file with the dump of a release.
    pub fn released(&self, name: &str) -> Result<PathBuf, Failure> {
        let path = self.releases.named(name).map(Path::to_owned);
        Ok(path.ok_or_else(|| self.releases.without(name))?)
    }

    /// Returns the name of the working tree.
    pub fn here(&self) -> String {
        compared(&self.project).working_tree()
    }

    /// Reads a version. Shows the errors of its spec and returns `None` if it has any.
    fn read(&self, name: &str) -> Result<Option<Version>, Failure> {
        progress::doing(both(
            "正在读取规范的两个版本",
            "reading two versions of the spec",
        ));
        match compared(&self.project).read(name) {
            Ok(version) => Ok(Some(version)),
            Err(VersionError::Faulty {
                name,
                sources,
                faults,
            }) => {
                print::message(&render(&faults, &sources, Format::Colored, lang()))?;
                print::error(&said!(
                    "`{name}` 的规范有错误",
                    "the spec of `{name}` has errors"
                ))?;
                Ok(None)
            }
            Err(error) => Err(error.into()),
        }
    }

    /// Compares two versions and applies the waivers of the new one.
    pub fn compare(
        &self,
        old: &Version,
        new: &Version,
        today: &str,
    ) -> Result<Vec<Finding>, Failure> {
        progress::doing(both("正在比较", "comparing"));
        let project = compared(&self.project);
        Ok(project.compare(&self.releases, [old, new], today)?)
    }

    /// Returns the path of a file of the spec, relative to the root.
    pub fn file(&self, path: &str) -> PathBuf {
        self.project.spec.join(path)
    }
}

/// Returns the spec of a project for a comparison of its versions.
pub fn compared(project: &Project) -> ProjectSpec<'_> {
    ProjectSpec {
        root: &project.root,
        spec: &project.spec,
        packages: Packages {
            id_types: project.targets.has_id_types(),
        },
    }
}

/// Returns the named day, or today.
pub fn today(named: Option<&str>) -> String {
    named.map_or_else(|| jiff::Zoned::now().date().to_string(), str::to_owned)
}

/// Parses a day of the command line.
pub fn day(text: &str) -> Result<String, String> {
    let day: jiff::civil::Date = text.parse().map_err(|_| {
        said!(
            "日期的写法应如 2026-12-31",
            "a day is written like 2026-12-31"
        )
    })?;
    Ok(day.to_string())
}
