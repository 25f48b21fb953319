//! Waivers of findings, from `waivers:`.

use super::{Location, Text};
use crate::names;
use md5::{Digest as _, Md5};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::fmt::Write as _;

/// A finding that is accepted for a time.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Waiver {
    /// Rule number and fingerprint of the finding: `FC0725-1a2b3c4d5e6f`.
    pub id: String,
    /// Reason for accepting it.
    #[serde(flatten)]
    pub reason: Text,
    /// Name of the person who accepted it.
    pub by: String,
    /// Last day or month of its validity: `YYYY-MM-DD` or `YYYY-MM`.
    #[serde(deserialize_with = "names::read_date")]
    pub until: String,
    /// Position in the spec: file, name and line.
    #[serde(rename = "place")]
    pub location: Location,
}

impl Waiver {
    /// Returns `true` if the waiver has expired on a day, `YYYY-MM-DD`. A month ends with its last day.
    #[must_use]
    pub fn is_over(&self, today: &str) -> bool {
        is_past(&self.until, today)
    }
}

/// Returns `true` if a day or month, `YYYY-MM-DD` or `YYYY-MM`, is before today. A month ends with its last day.
#[must_use]
pub fn is_past(last: &str, today: &str) -> bool {
    // Dates of the same form sort like their text.
    today.get(..last.len()).unwrap_or(today) > last
}

/// Returns the fingerprint of a finding for the id of its waiver: twelve hex digits of the MD5 of its parts.
#[must_use]
pub fn fingerprint<'p>(parts: impl IntoIterator<Item = &'p str>) -> String {
    let mut digest = Md5::new();
    for part in parts {
        digest.update(part.as_bytes());
        digest.update([0]);
    }
    let mut text = String::new();
    for byte in digest.finalize().iter().take(6) {
        // Writing to a String cannot fail.
        let _ = write!(text, "{byte:02x}");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_waiver_holds_to_the_end_of_its_last_day_or_month() {
        for (until, today, is_over) in [
            ("2026-12-31", "2026-12-30", false),
            ("2026-12-31", "2026-12-31", false),
            ("2026-12-31", "2027-01-01", true),
            ("2026-12", "2026-11-30", false),
            ("2026-12", "2026-12-31", false),
            ("2026-12", "2027-01-01", true),
            ("2027-01-05", "2027-01-06", true),
        ] {
            let location = Location {
                file: String::new(),
                name: String::new(),
                line: 1,
            };
            let text = String::new();
            let waiver = Waiver {
                id: "FC0725-1a2b3c4d5e6f".to_owned(),
                reason: Text {
                    zh: text.clone(),
                    en: text.clone(),
                },
                by: text,
                until: until.to_owned(),
                location,
            };
            assert_eq!(waiver.is_over(today), is_over, "{until} on {today}");
        }
    }
}
