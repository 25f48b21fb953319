//! The certificate as JSON.

use super::{Certificate, Outcome};
use crate::decode;
use fc_spec::model::Text;
use serde::Serialize;
use std::time::UNIX_EPOCH;

/// The certificate in its files.
#[derive(Serialize)]
pub(super) struct Written<'c> {
    format: u32,
    passed: bool,
    address: &'c str,
    protocol: &'c str,
    version: &'c str,
    fingerprint: &'c str,
    program: &'c str,
    /// Seconds since 1970.
    start: u64,
    duration_ms: u64,
    /// Absent if all trials were wanted.
    #[serde(skip_serializing_if = "<[String]>::is_empty")]
    only: &'c [String],
    trials: Vec<Trial<'c>>,
}

#[derive(Serialize)]
struct Trial<'c> {
    name: &'c str,
    demand: &'c Text,
    result: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    reason: Option<&'c Text>,
    /// Bytes in hexadecimal.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    sent: Vec<String>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    received: Vec<String>,
}

impl<'c> Trial<'c> {
    fn new(trial: &'c super::Trial) -> Self {
        let (result, reason, failure) = match &trial.outcome {
            Outcome::Passed => ("passed", None, None),
            Outcome::Skipped(reason) => ("skipped", Some(reason), None),
            Outcome::Failed(failure) => ("failed", Some(&failure.reason), Some(failure)),
        };
        let all = |bytes: &[Vec<u8>]| bytes.iter().map(|bytes| shown(bytes)).collect();
        Self {
            name: &trial.name,
            demand: &trial.demand,
            result,
            reason,
            sent: failure.map_or_else(Vec::new, |it| all(&it.sent)),
            received: failure.map_or_else(Vec::new, |it| all(&it.received)),
        }
    }
}

/// Returns a trial as one line of JSON, without the end of the line.
#[must_use]
pub fn line(trial: &super::Trial) -> String {
    // Strings cannot fail to serialize.
    serde_json::to_string(&Trial::new(trial)).unwrap_or_default()
}

impl<'c> Written<'c> {
    pub(super) fn new(certificate: &'c Certificate) -> Self {
        let start = certificate.start.duration_since(UNIX_EPOCH);
        let milliseconds = certificate.duration.as_millis();
        Self {
            format: 1,
            passed: certificate.is_passed(),
            address: &certificate.address,
            protocol: &certificate.protocol,
            version: &certificate.version,
            fingerprint: &certificate.fingerprint,
            program: &certificate.program,
            start: start.map_or(0, |start| start.as_secs()),
            duration_ms: u64::try_from(milliseconds).unwrap_or(u64::MAX),
            only: &certificate.only,
            trials: certificate.trials.iter().map(Trial::new).collect(),
        }
    }
}

/// Returns the certificate as JSON.
#[must_use]
pub fn text(certificate: &Certificate) -> String {
    // Strings and numbers cannot fail to serialize.
    serde_json::to_string_pretty(&Written::new(certificate)).unwrap_or_default() + "\n"
}

/// Returns bytes in hexadecimal. Long ones are cut.
fn shown(bytes: &[u8]) -> String {
    const LONGEST: usize = 512;
    let start = bytes.get(..LONGEST).unwrap_or(bytes);
    let mut text = decode::hex(start);
    if start.len() < bytes.len() {
        text.push('…');
    }
    text
}
