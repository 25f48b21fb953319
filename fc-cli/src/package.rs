//! `fcproto package`.

use std::path::{Path, PathBuf};

use clap::ValueEnum;
use fc_codegen::inspect::fingerprint;
use fc_codegen::target::part;
use fc_codegen::version::Edition;
use fc_package::{Language, Packed};
use fc_spec::model::Model;

use crate::generate;
use crate::lang::{both, said};
use crate::outcome::{Failure, Status, unwritable};
use crate::project::Project;
use crate::project_dirs::ProjectDirs;
use crate::spec::Spec;
use crate::versions::Shelf;
use crate::{input, print, progress};

/// Options of `fcproto package`.
#[derive(Debug, clap::Args)]
pub struct Options {
    #[arg(
        value_name = "LANGUAGE",
        help = both("要打包的语言 [默认：`fc.yaml` 中的全部]", "Languages to pack [default: all of `fc.yaml`]")
    )]
    languages: Vec<LanguageName>,
    #[arg(
        long,
        value_name = "DIR",
        help = both("写到这个目录下", "Write below this directory")
    )]
    out: PathBuf,
}

/// The name of a language with packages.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum LanguageName {
    #[value(help = both("`.crate` 文件和 Cargo 的目录源", "`.crate` files and a directory source of Cargo"))]
    Rust,
    #[value(help = both("npm 包", "npm tarball"))]
    Typescript,
    #[value(help = both("wheel 和 sdist", "Wheel and source distribution"))]
    Python,
    #[value(help = both("Kotlin 和 Java 的 Maven 仓库", "Maven repository for Kotlin and Java"))]
    Kotlin,
    #[value(help = both("安装树的 `.tar.gz` 和 `.deb`", "Install tree as `.tar.gz` and `.deb`"))]
    Cpp,
}

impl From<LanguageName> for Language {
    fn from(name: LanguageName) -> Self {
        match name {
            LanguageName::Rust => Self::Rust,
            LanguageName::Typescript => Self::TypeScript,
            LanguageName::Python => Self::Python,
            LanguageName::Kotlin => Self::Kotlin,
            LanguageName::Cpp => Self::Cpp,
        }
    }
}

pub fn run(dirs: &ProjectDirs, options: &Options) -> Result<Status, Failure> {
    let project = Project::find(dirs)?;
    let languages = options.languages(&project)?;
    let names = languages.iter().map(|it| it.name().to_owned()).collect();
    let checking = generate::Options::checking(names);
    let status = generate::in_project(project.clone(), dirs, &checking)?;
    let spec = Spec::in_project(project.clone());
    let Some(model) = spec.model.filter(|_| status == Status::Fine) else {
        return Ok(status);
    };
    let out = std::path::absolute(&options.out)?;
    std::fs::create_dir_all(&out).map_err(unwritable(&out))?;
    let mut status = Status::Fine;
    for language in languages {
        let name = language.name();
        progress::doing(both("正在打包", "packing"));
        match pack(&project, &model, language, &out) {
            Ok(packed) => print::done(&summary(name, &packed))?,
            Err(failure) => {
                status = Status::Faulty;
                let reason = print::reason(failure.as_ref());
                print::error(&said!(
                    "{name}：{reason}",
                    "{name}: {reason}",
                    reason = reason
                ))?;
            }
        }
    }
    Ok(status)
}

impl Options {
    /// Returns the languages to pack, in the order of the project's targets.
    fn languages(&self, project: &Project) -> Result<Vec<Language>, Failure> {
        let languages = self.languages.iter().map(|it| Language::from(*it));
        let names: Vec<_> = languages.map(|it| it.name().to_owned()).collect();
        let targets = project.targets.clone().only(&names)?;
        let chosen = |it: &Language| targets.products().any(|product| product == it.product());
        let chosen: Vec<_> = Language::ALL.into_iter().filter(chosen).collect();
        if chosen.is_empty() {
            return Err(said!(
                "`fc.yaml` 的目标中没有可以打包的语言",
                "no target of `fc.yaml` is a language with packages"
            )
            .into());
        }
        Ok(chosen)
    }
}

fn pack(
    project: &Project,
    model: &Model,
    language: Language,
    out: &Path,
) -> Result<Packed, Failure> {
    let audience = project.targets.audience(language.product());
    let edition = edition(project, model, audience)?;
    let sources = fc_package::Project {
        root: &project.root,
        targets: &project.targets,
    };
    Ok(fc_package::pack(sources, language, &edition, out)?)
}

/// Returns the edition of a package: the release of the spec if it has the same content as the working tree.
fn edition(project: &Project, model: &Model, audience: Option<&str>) -> Result<Edition, Failure> {
    let here = fingerprint(&*part(model, audience)?);
    let shelf = Shelf::of(project.clone())?;
    let number = &model.protocol.version;
    if let Some(dump) = shelf.releases.named(number) {
        let released = generate::dumped(&dump.display().to_string(), &input::file(dump)?)?;
        if fingerprint(&*part(&released, audience)?) == here {
            return Ok(Edition::Release(number.clone()));
        }
    }
    Ok(Edition::Draft(here))
}

fn summary(language: &str, packed: &Packed) -> String {
    let Packed { version, paths } = packed;
    let packed = print::good(&said!("已打包", "packed"));
    let listed = print::first(paths.iter().map(|path| format!("  {path}\n")), "  ");
    format!("{packed} {language} {version}\n{listed}")
}
