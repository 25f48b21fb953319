//! The wheel and the source distribution.

use std::path::Path;

use fc_codegen::version::Ecosystem;

use super::tool::{Tool, unpack};
use super::{Job, files};
use crate::lang::said;
use crate::outcome::Failure;

const PYTHON: Tool = Tool {
    name: "python3",
    get: "apt install python3",
};

/// Packs the sources. The version is set in the packed files, and the wheel is made of them.
pub fn pack(job: &Job<'_>) -> Result<String, Failure> {
    let package = job.package("pyproject.toml")?;
    PYTHON
        .run(&job.work, ["-c", "import build"])
        .map_err(|failure| {
            said!(
                "{failure}\n`build` 用 `python3 -m pip install build` 安装",
                "{failure}\nget `build` with `python3 -m pip install build`"
            )
        })?;
    build(&package, &job.work, &["--sdist"])?;
    unpack(&files::with_ending(&job.work, ".tar.gz")?, &job.work)?;
    let mut packed = files::entries(&job.work)?.into_iter();
    let packed = packed.find(|it| it.is_dir()).unwrap_or_default();
    let version = files::set_toml_version(&packed.join("pyproject.toml"), "project", |number| {
        job.version(Ecosystem::Python, number)
    })?;
    build(&packed, &job.out, &[])?;
    Ok(version)
}

/// Builds without isolation: an isolated environment would need an index of packages.
fn build(package: &Path, out: &Path, options: &[&str]) -> Result<(), Failure> {
    let out = out.display().to_string();
    let fixed = ["-m", "build", "--no-isolation", "--outdir", &out];
    PYTHON.run(package, fixed.into_iter().chain(options.iter().copied()))?;
    Ok(())
}
