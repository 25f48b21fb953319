//! What the packages of other languages have measured of themselves: one file each, and a part of the page.

mod section;

use crate::Language;
use crate::section::whole;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};

/// What a package has measured of itself. Times are in microseconds.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Report {
    /// Name of the language.
    pub language: String,
    /// Day, as `YYYY-MM-DD`.
    pub date: String,
    /// Name of the processor.
    pub processor: String,
    /// Cores that may be used.
    pub cores: usize,
    /// Versions by name: of the language, and of what it is measured beside.
    pub versions: BTreeMap<String, String>,
    /// What the floor of the codec reads and writes JSON with.
    pub json: String,
    /// Which of the peers calls are compared with: gRPC, where it is measured.
    pub grpc: String,
    /// What has to be reached.
    #[serde(default)]
    pub goals: Goals,
    /// By message.
    pub codec: Vec<Codec>,
    /// By calls in flight.
    pub calls: Vec<Calls>,
}

/// What a package has to reach.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Goals {
    /// Most that small and medium messages take, as a multiple of the floor.
    pub codec: Option<f64>,
    /// Least calls per second with the most in flight, as a multiple of those of what it is compared with.
    pub calls: Option<f64>,
}

/// What a message costs.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Codec {
    /// `small`, `medium` or `long`: the file in `bench/frames`.
    pub message: String,
    /// Bytes of its frame.
    pub bytes: usize,
    /// From a frame to a typed message.
    pub decode: Beside,
    /// From a typed message to a frame.
    pub encode: Beside,
}

/// The package beside the floor.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Beside {
    /// JSON and MD5 alone.
    pub least: f64,
    /// The package.
    pub fc: f64,
}

/// What calls cost with so many in flight.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Calls {
    /// How many.
    pub in_flight: usize,
    /// The floor, the package, and what that is compared with.
    pub peers: Vec<Peer>,
}

/// One of those that call.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Peer {
    /// Its name; `raw` is the floor, `fc` the package.
    pub name: String,
    /// Calls per second.
    pub rate: f64,
    /// Time of the middle call; absent where calls go in one write.
    pub p50: Option<f64>,
    /// Time of one of the slowest of a hundred.
    pub p99: Option<f64>,
    /// CPU of both processes for a call.
    pub cpu: f64,
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The reports that are there, by their names.
///
/// # Errors
/// If one cannot be read, or is no report.
pub fn read() -> io::Result<Vec<Report>> {
    let mut paths: Vec<PathBuf> = std::fs::read_dir(root().join("bench/packages"))?
        .map(|entry| entry.map(|entry| entry.path()))
        .collect::<io::Result<_>>()?;
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "json"));
    paths.sort();
    paths
        .iter()
        .map(|path| {
            let report = serde_json::from_slice(&std::fs::read(path)?);
            report.map_err(|error| io::Error::other(format!("{}: {error}", path.display())))
        })
        .collect()
}

const BEGIN: &str =
    "<!-- Written by `cargo run --manifest-path bench/Cargo.toml -p fc-bench-report`; do not edit. -->\n\n";
const END: &str = "<!-- Up to here. -->\n";

/// Their part of the page, with the marks around it.
#[must_use]
pub fn block(reports: &[Report], language: Language) -> String {
    format!("{BEGIN}{}{END}", whole(&section::section(reports), language))
}

/// A page with this part in place of the one that it has.
///
/// # Errors
/// If it has none.
pub fn replaced(page: &str, block: &str) -> Result<String, String> {
    let parts = page.split_once(BEGIN).and_then(|(before, rest)| Some((before, rest.split_once(END)?.1)));
    let (before, after) = parts.ok_or("the page has no part for the packages")?;
    Ok(format!("{before}{block}{after}"))
}

/// The pages in both languages.
#[must_use]
pub fn pages() -> [(PathBuf, Language); 2] {
    [("guides", Language::Chinese), ("en/guides", Language::English)]
        .map(|(place, language)| (root().join("docs-site").join(place).join("performance-results.md"), language))
}
