//! `availability:` and `available:`: the audiences, machines and releases of a thing.

use super::{Location, Text};
use crate::names;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Declarations of the audiences, machines and releases for `available`.
#[derive(Clone, Debug, Default, Serialize, Deserialize, JsonSchema)]
pub struct Availability {
    /// Audiences: kinds of app.
    pub audiences: Vec<Declared>,
    /// Lines of machines.
    pub hardware: Vec<Declared>,
    /// Series of releases, such as those of a firmware.
    pub releases: Vec<Declared>,
}

impl Availability {
    /// Returns `true` if the spec declares no audiences, machines and releases.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.audiences.is_empty() && self.hardware.is_empty() && self.releases.is_empty()
    }

    /// Returns the audience with this name, if there is one.
    #[must_use]
    pub fn audience(&self, name: &str) -> Option<&Declared> {
        find(&self.audiences, name)
    }

    /// Returns the line of machines with this name, if there is one.
    #[must_use]
    pub fn machine(&self, name: &str) -> Option<&Declared> {
        find(&self.hardware, name)
    }

    /// Returns the series of releases with this name, if there is one.
    #[must_use]
    pub fn series(&self, name: &str) -> Option<&Declared> {
        find(&self.releases, name)
    }
}

/// An audience, a line of machines or a series of releases.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Declared {
    /// Name, such as `debugging_app`.
    #[serde(deserialize_with = "names::read_snake")]
    pub name: String,
    /// Title.
    #[serde(flatten)]
    pub title: Text,
    /// Position in the spec: file, name and line.
    #[serde(rename = "place")]
    pub location: Location,
}

/// Audiences, machines and releases that have a thing. An empty list or map sets no limit.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Available {
    /// Names of the audiences that have it.
    #[serde(rename = "for")]
    pub audiences: Vec<String>,
    /// Names of the lines of machines that have it.
    pub hardware: Vec<String>,
    /// First release that has it, by series.
    pub from: BTreeMap<String, String>,
    /// Last release that has it, by series.
    pub until: BTreeMap<String, String>,
}

impl Available {
    /// Returns `true` if this audience has it.
    #[must_use]
    pub fn is_for(&self, audience: &str) -> bool {
        self.audiences.is_empty() || self.audiences.iter().any(|name| name == audience)
    }

    /// Returns the first and the last release of each series that has a limit.
    pub fn releases(&self) -> impl Iterator<Item = (&str, Option<&str>, Option<&str>)> {
        let until_alone = self.until.keys().filter(|it| !self.from.contains_key(*it));
        self.from.keys().chain(until_alone).map(|series| {
            let first = self.from.get(series).map(String::as_str);
            let last = self.until.get(series).map(String::as_str);
            (series.as_str(), first, last)
        })
    }
}

fn find<'d>(declared: &'d [Declared], name: &str) -> Option<&'d Declared> {
    declared.iter().find(|declared| declared.name == name)
}
