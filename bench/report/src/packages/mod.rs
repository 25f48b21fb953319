//! The measurements of the packages of other languages: a file for each language, and a block in the results page.

mod section;

use crate::Language;
use crate::section::whole;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};

/// The measurements of a package. Times are in microseconds.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Report {
    /// Name of the language.
    pub language: String,
    /// Date, as `YYYY-MM-DD`.
    pub date: String,
    /// Name of the processor.
    pub processor: String,
    /// Number of available cores.
    pub cores: usize,
    /// Versions of the language and of its peers, by name.
    pub versions: BTreeMap<String, String>,
    /// JSON library of the floor.
    pub json: String,
    /// Name of the peer for the comparison of calls. It is gRPC if the package measures gRPC.
    pub grpc: String,
    /// Goals of the package.
    #[serde(default)]
    pub goals: Goals,
    /// Figures of the codec for each message.
    pub codec: Vec<Codec>,
    /// Figures of calls for each number of calls in flight.
    pub calls: Vec<Calls>,
}

/// The goals of a package.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Goals {
    /// Longest time for small and medium messages, as a multiple of the floor.
    pub codec: Option<f64>,
    /// Least calls per second with the most calls in flight, as a multiple of those of the compared peer.
    pub calls: Option<f64>,
}

/// Figures of the codec for one message.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Codec {
    /// Name of the file in `bench/frames`: `small`, `medium` or `long`.
    pub message: String,
    /// Length of the frame, in bytes.
    pub bytes: usize,
    /// Times from a frame to a typed message.
    pub decode: Beside,
    /// Times from a typed message to a frame.
    pub encode: Beside,
}

/// The times of the floor and of the package.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Beside {
    /// Time of the floor, which is only JSON and MD5.
    pub least: f64,
    /// Time of the package.
    pub fc: f64,
}

/// Figures of calls for one number of calls in flight.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Calls {
    /// Number of calls in flight.
    pub in_flight: usize,
    /// The floor, the package, and the compared peer.
    pub peers: Vec<Peer>,
}

/// Figures of calls for one peer.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Peer {
    /// Name of the peer. `raw` is the floor, and `fc` is the package.
    pub name: String,
    /// Calls per second.
    pub rate: f64,
    /// Median latency. It is absent if several calls share a write.
    pub p50: Option<f64>,
    /// 99th percentile of the latency. It is absent in the same case.
    pub p99: Option<f64>,
    /// CPU time of both processes per call.
    pub cpu: f64,
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Reads all reports in `bench/packages`, sorted by file name.
///
/// # Errors
/// If a file cannot be read or is not a report.
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

/// Returns the block of the packages in the results page, between two marks.
#[must_use]
pub fn block(reports: &[Report], language: Language) -> String {
    format!("{BEGIN}{}{END}", whole(&section::section(reports), language))
}

/// Returns a page with its block of the packages replaced.
///
/// # Errors
/// If the page has no such block.
pub fn replaced(page: &str, block: &str) -> Result<String, String> {
    let parts = page.split_once(BEGIN).and_then(|(before, rest)| Some((before, rest.split_once(END)?.1)));
    let (before, after) = parts.ok_or("the page has no part for the packages")?;
    Ok(format!("{before}{block}{after}"))
}

/// Returns the paths of the results pages in both languages.
#[must_use]
pub fn pages() -> [(PathBuf, Language); 2] {
    [("guides", Language::Chinese), ("en/guides", Language::English)]
        .map(|(place, language)| (root().join("docs-site").join(place).join("performance-results.md"), language))
}
