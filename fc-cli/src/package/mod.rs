//! `fcproto package`.

mod cpp;
mod files;
mod kotlin;
mod maven;
mod python;
mod rust;
mod sbom;
mod sums;
mod tool;
mod typescript;

use std::path::{Path, PathBuf};

use clap::ValueEnum;
use fc_codegen::inspect::fingerprint;
use fc_codegen::product::Product;
use fc_codegen::target::part;
use fc_codegen::version::{Ecosystem, Edition};
use fc_spec::model::Model;

use crate::generate;
use crate::lang::{both, said};
use crate::outcome::{Failure, Status, unwritable};
use crate::project::Project;
use crate::project_dirs::ProjectDirs;
use crate::spec::Spec;
use crate::versions::Shelf;
use crate::{input, print, progress};

use sbom::Packages;

/// Options of `fcproto package`.
#[derive(Debug, clap::Args)]
pub struct Options {
    #[arg(
        value_name = "LANGUAGE",
        help = both("要打包的语言 [默认：`fc.yaml` 中的全部]", "Languages to pack [default: all of `fc.yaml`]")
    )]
    languages: Vec<Language>,
    #[arg(
        long,
        value_name = "DIR",
        help = both("写到这个目录下", "Write below this directory")
    )]
    out: PathBuf,
}

/// A language with packages.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Language {
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

impl Language {
    fn product(self) -> Product {
        match self {
            Self::Rust => Product::Rust,
            Self::Typescript => Product::TypeScript,
            Self::Python => Product::Python,
            Self::Kotlin => Product::Kotlin,
            Self::Cpp => Product::Cpp,
        }
    }

    fn name(self) -> &'static str {
        self.product().name()
    }

    fn pack(self) -> fn(&Job<'_>) -> Result<Packages, Failure> {
        match self {
            Self::Rust => rust::pack,
            Self::Typescript => typescript::pack,
            Self::Python => python::pack,
            Self::Kotlin => kotlin::pack,
            Self::Cpp => cpp::pack,
        }
    }
}

/// The package of one language, and the places to build it.
struct Job<'p> {
    project: &'p Project,
    product: Product,
    edition: Edition,
    /// An empty directory for the packages.
    out: PathBuf,
    /// An empty directory for other files.
    work: PathBuf,
}

impl Job<'_> {
    /// Returns the directory of the package: the nearest one with this file, from the generated files upwards.
    fn package(&self, manifest: &str) -> Result<PathBuf, Failure> {
        let root = std::path::absolute(&self.project.root)?;
        let product = self.product;
        let place = self.project.targets.place(product);
        let place = place.unwrap_or(product.usual_place());
        let generated = root.join(place);
        let inside = generated.ancestors().take_while(|it| it.starts_with(&root));
        let mut found = inside.filter(|it| it.join(manifest).is_file());
        let found = found.next().map(Path::to_owned);
        found.ok_or_else(|| {
            said!(
                "`{place}` 只有生成的源码：它和上级目录中都没有 `{manifest}`；在那里写一个，或参照 `{usual}` 中的包",
                "`{place}` has only generated sources, because no `{manifest}` is there or in a directory above; write one, \
                 or follow the package in `{usual}`",
                usual = product.usual_place()
            )
            .into()
        })
    }

    fn version(&self, ecosystem: Ecosystem, number: &str) -> Result<String, Failure> {
        let is_part = |part: &str| !part.is_empty() && part.bytes().all(|it| it.is_ascii_digit());
        if number.split('.').count() > 3 || !number.split('.').all(is_part) {
            return Err(said!(
                "包的编号应为 `0.2.0` 这样的数，实际为 `{number}`；规范的版本由 `fcproto package` 加上",
                "the number of the package should be like `0.2.0`, but it is `{number}`; `fcproto package` adds the version of the spec"
            )
            .into());
        }
        Ok(self.edition.version(ecosystem, number))
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
            Ok(text) => print::done(&text)?,
            Err(failure) => {
                status = Status::Faulty;
                print::error(&said!("{name}：{failure}", "{name}: {failure}"))?;
            }
        }
    }
    Ok(status)
}

impl Options {
    /// Returns the languages to pack, in the order of the project's targets.
    fn languages(&self, project: &Project) -> Result<Vec<Language>, Failure> {
        let names: Vec<_> = self
            .languages
            .iter()
            .map(|it| it.name().to_owned())
            .collect();
        let targets = project.targets.clone().only(&names)?;
        let all = Language::value_variants().iter().copied();
        let chosen: Vec<_> = all
            .filter(|it| targets.products().any(|product| product == it.product()))
            .collect();
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

/// Packs a language and returns a summary.
fn pack(
    project: &Project,
    model: &Model,
    language: Language,
    out: &Path,
) -> Result<String, Failure> {
    let product = language.product();
    // On the same file system as the result, so that files can be moved.
    let work = tempfile::tempdir_in(out).map_err(unwritable(out))?;
    let job = Job {
        project,
        product,
        edition: edition(project, model, project.targets.audience(product))?,
        out: files::directory(&work.path().join("out"))?,
        work: files::directory(&work.path().join("work"))?,
    };
    let packages = language.pack()(&job)?;
    sbom::write(&job.out, &packages)?;
    let version = &packages.main.component.version;
    let name = language.name();
    let listed = sums::replace(out, name, &job.out)?;
    let packed = print::good(&said!("已打包", "packed"));
    let listed = print::first(listed.iter().map(|path| format!("  {path}\n")), "  ");
    Ok(format!("{packed} {name} {version}\n{listed}"))
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
