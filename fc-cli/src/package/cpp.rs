//! The install tree of the C++ package, as `.tar.gz` and `.deb`.

use fc_codegen::version::Ecosystem;

use super::tool::Tool;
use super::{Job, files};
use crate::input;
use crate::lang::said;
use crate::outcome::Failure;

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
pub fn pack(job: &Job<'_>) -> Result<String, Failure> {
    let package = job.package("CMakeLists.txt")?;
    let [source, build] = [&package, &job.work].map(|it| it.display().to_string());
    let configure = ["-S", &source, "-B", &build];
    let configure = configure.into_iter().chain(OPTIONS);
    CMAKE.run(&package, configure.clone())?;
    if !job.work.join("CPackConfig.cmake").is_file() {
        return Err(said!(
            "`{source}/CMakeLists.txt` 缺少 `include(CPack)`",
            "`{source}/CMakeLists.txt` lacks `include(CPack)`"
        )
        .into());
    }
    let cache = input::file(&job.work.join("CMakeCache.txt"))?;
    let mut lines = cache.lines();
    let number = lines.find_map(|line| line.strip_prefix("CMAKE_PROJECT_VERSION:STATIC="));
    let version = job.version(Ecosystem::Debian, number.unwrap_or_default())?;
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
    std::fs::remove_dir_all(&leftovers).map_err(|error| files::unwritable(&leftovers, &error))?;
    Ok(version)
}
