//! The install tree of the C++ package, as `.tar.gz` and `.deb`.

use crate::error::{PackError, unwritable};
use crate::files;
use crate::job::Job;
use crate::sbom::{Component, Package, Packages};
use crate::tool::Tool;
use fc_codegen::version::Ecosystem;
use std::path::Path;

const CMAKE: Tool = Tool {
    name: "cmake",
    get: "apt install cmake g++",
};

const CPACK: Tool = Tool {
    name: "cpack",
    get: "apt install cmake",
};

/// Options for the libraries alone. Larger sources save most of the time, which goes to headers.
const OPTIONS: [&str; 4] = [
    "-DCMAKE_BUILD_TYPE=Release",
    "-DCMAKE_UNITY_BUILD=ON",
    "-DFC_EXAMPLES=OFF",
    "-DFC_TESTS=OFF",
];

/// Builds the libraries, and packs what the package installs.
pub fn pack(job: &Job<'_>) -> Result<Packages, PackError> {
    let package = job.package("CMakeLists.txt")?;
    let [source, build] = [&package, &job.work].map(|it| it.display().to_string());
    let configure = ["-S", &source, "-B", &build];
    let configure = configure.into_iter().chain(OPTIONS);
    CMAKE.run(&package, configure.clone())?;
    if !job.work.join("CPackConfig.cmake").is_file() {
        return Err(PackError::NoCpack(package));
    }
    let cache = files::read(&job.work.join("CMakeCache.txt"))?;
    let cached = |key: &str| cache.lines().find_map(|line| line.strip_prefix(key));
    let number = cached("CMAKE_PROJECT_VERSION:STATIC=").unwrap_or_default();
    let version = job.version(Ecosystem::Debian, number)?;
    let option = format!("-DCPACK_PACKAGE_VERSION={version}");
    CMAKE.run(&package, configure.chain([option.as_str()]))?;
    CMAKE.run(&package, ["--build", &build, "--parallel"])?;
    let out = job.out.display().to_string();
    let forms = if cfg!(target_os = "linux") {
        "TGZ;DEB"
    } else {
        "TGZ"
    };
    CPACK.run(&job.work, ["-G", forms, "-B", &out])?;
    let leftovers = job.out.join("_CPack_Packages");
    std::fs::remove_dir_all(&leftovers).map_err(unwritable(&leftovers))?;
    let config = files::read(&job.work.join("CPackConfig.cmake"))?;
    let name = cached("CMAKE_PROJECT_NAME:STATIC=").unwrap_or_default();
    let mut dependencies = debian_dependencies(&config);
    dependencies.extend(cached("ASIO_INCLUDE:PATH=").and_then(|it| asio(Path::new(it))));
    Ok(Packages {
        main: Package {
            component: Component {
                version,
                ..Component::new("generic", name)
            },
            dependencies,
        },
        others: Vec::new(),
    })
}

/// Returns the packages of Debian that users install: `name (>= 1.2), other`.
fn debian_dependencies(config: &str) -> Vec<Component> {
    let key = "set(CPACK_DEBIAN_PACKAGE_DEPENDS \"";
    let list = config.lines().find_map(|line| line.strip_prefix(key));
    let list = list.and_then(|it| it.strip_suffix("\")"));
    let listed = list.unwrap_or_default().split(',').map(str::trim);
    let listed = listed.filter(|it| !it.is_empty());
    let component = |text: &str| {
        let (name, requirement) = text.split_once(' ').unwrap_or((text, ""));
        Component {
            namespace: "debian".to_owned(),
            requirement: requirement.trim_matches(['(', ')']).to_owned(),
            ..Component::new("deb", name)
        }
    };
    listed.map(component).collect()
}

/// Returns Asio, whose headers are compiled into the libraries.
fn asio(headers: &Path) -> Option<Component> {
    let text = files::read(&headers.join("asio/version.hpp")).ok()?;
    let mut lines = text.lines();
    // `#define ASIO_VERSION 102201 // 1.22.1`
    let version = lines.find_map(|line| line.strip_prefix("#define ASIO_VERSION "));
    let (_, version) = version?.split_once("// ")?;
    Some(Component {
        version: version.trim().to_owned(),
        ..Component::new("generic", "asio")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn debian_dependencies_are_split_at_commas() {
        let config = "set(CPACK_DEBIAN_PACKAGE_DEPENDS \"libc6 (>= 2.34), zlib1g\")\n";
        let found = debian_dependencies(config);
        let found = found.iter().map(|it| (&*it.name, &*it.requirement));
        assert!(found.eq([("libc6", ">= 2.34"), ("zlib1g", "")]));
        assert!(debian_dependencies("").is_empty());
    }
}
