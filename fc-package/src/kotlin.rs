//! The jars for Kotlin and Java, in a Maven repository.

use crate::error::PackError;
use crate::files;
use crate::job::Job;
use crate::maven::{Coordinates, seal};
use crate::sbom::{Package, Packages};
use crate::tool::Tool;
use fc_codegen::version::Ecosystem;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

const JAR: Tool = Tool {
    name: "jar",
    get: "apt install openjdk-17-jdk-headless",
};

/// The script of the package, which needs no Gradle.
const COMPILE: Tool = Tool {
    name: "./compile",
    get: "cp -r stubs/kotlin/{compile,tool,runtime} DIR",
};

/// The file with group, number and versions of dependencies, which Gradle reads too.
const PROPERTIES: &str = "gradle.properties";

/// The time of all entries, so that the same classes make the same jar.
const DATE: &str = "--date=2000-01-01T00:00:00Z";

/// A jar with its sources.
struct Part<'p> {
    /// The directory of the part in the package.
    name: &'p str,
    coordinates: Coordinates,
    dependencies: Vec<Coordinates>,
}

/// Compiles the package with its script, and lays out a repository with runtime and generated code.
pub fn pack(job: &Job<'_>) -> Result<Packages, PackError> {
    let package = job.package(PROPERTIES)?;
    let file = package.join(PROPERTIES);
    let properties = Properties::read(&file)?;
    let number = properties.get("version")?;
    let version = job.version(Ecosystem::Maven, number)?;
    let (group, base) = (properties.get("group")?, properties.get("artifact")?);
    let runtime = Coordinates::new(group, &format!("{base}-runtime"), number);
    let parts = [
        Part {
            name: "runtime",
            coordinates: runtime.clone(),
            dependencies: vec![
                Coordinates::new(
                    "org.jetbrains.kotlin",
                    "kotlin-stdlib",
                    properties.get("kotlinVersion")?,
                ),
                Coordinates::new(
                    "org.jetbrains.kotlinx",
                    "kotlinx-coroutines-core-jvm",
                    properties.get("coroutinesVersion")?,
                ),
            ],
        },
        Part {
            name: "generated",
            coordinates: Coordinates::new(group, &format!("{base}-generated"), &version),
            dependencies: vec![runtime],
        },
    ];
    // A relative program begins at the directory of this process on some systems.
    let mut compile = Command::new(package.join(COMPILE.name));
    COMPILE.finish(
        compile
            .args(parts.iter().map(|it| it.name))
            .current_dir(&package),
    )?;
    for part in &parts {
        part.lay_out(job, &package)?;
    }
    let [runtime, generated] = parts.map(|it| Package {
        component: it.coordinates.component(),
        dependencies: it.dependencies.iter().map(Coordinates::component).collect(),
    });
    Ok(Packages {
        main: generated,
        others: vec![runtime],
    })
}

impl Part<'_> {
    fn lay_out(&self, job: &Job<'_>, package: &Path) -> Result<(), PackError> {
        let Self {
            name, coordinates, ..
        } = self;
        let directory = coordinates.directory(&job.out)?;
        let (artifact, version) = (&coordinates.artifact, &coordinates.version);
        let manifest = job.work.join(format!("{name}.manifest"));
        let module = artifact.replace('-', ".");
        files::write(
            &manifest,
            format!(
                "Automatic-Module-Name: {module}\nImplementation-Title: {artifact}\nImplementation-Version: {version}\n"
            ),
        )?;
        let classes = package.join("build").join(name);
        let sources = package.join(name).join("src/main/kotlin");
        for (classifier, contents, texts) in [
            ("", Some(classes), texts(package, "LICENSE")?),
            ("-sources", Some(sources), Vec::new()),
            // Without Dokka, which only Gradle runs, the jar that repositories demand has the README.
            ("-javadoc", None, texts(package, "README")?),
        ] {
            let jar = directory.join(coordinates.file(classifier, "jar"));
            let mut arguments = vec![
                "--create".to_owned(),
                DATE.to_owned(),
                format!("--file={}", jar.display()),
                format!("--manifest={}", manifest.display()),
            ];
            let mut add = |directory: &Path, entry: &str| {
                arguments.extend(["-C".to_owned(), directory.display().to_string()]);
                arguments.push(entry.to_owned());
            };
            if let Some(contents) = &contents {
                add(contents, ".");
            }
            for text in &texts {
                add(package, text);
            }
            JAR.run(package, arguments)?;
        }
        let description = format!("{artifact}: messages and calls of a robot protocol");
        let pom = coordinates.pom(&description, &self.dependencies);
        files::write(&directory.join(coordinates.file("", "pom")), pom)?;
        seal(&directory)
    }
}

/// Returns the names of the files in a directory that begin with these letters.
fn texts(directory: &Path, start: &str) -> Result<Vec<String>, PackError> {
    let entries = files::entries(directory)?.into_iter();
    let names = entries.filter(|path| path.is_file()).filter_map(|path| {
        let name = path.file_name()?.to_string_lossy().into_owned();
        name.starts_with(start).then_some(name)
    });
    Ok(names.collect())
}

/// The settings of a package: lines `key=value`.
struct Properties {
    file: PathBuf,
    values: BTreeMap<String, String>,
}

impl Properties {
    fn read(file: &Path) -> Result<Self, PackError> {
        let text = files::read(file)?;
        let lines = text.lines().filter(|line| !line.starts_with('#'));
        let values = lines.filter_map(|line| line.split_once('='));
        let values = values.map(|(key, value)| (key.trim().to_owned(), value.trim().to_owned()));
        Ok(Self {
            file: file.to_owned(),
            values: values.collect(),
        })
    }

    fn get(&self, key: &str) -> Result<&str, PackError> {
        let value = self.values.get(key).map(String::as_str);
        let value = value.filter(|it| !it.is_empty());
        value.ok_or_else(|| PackError::NoProperty {
            file: self.file.clone(),
            key: key.to_owned(),
        })
    }
}
