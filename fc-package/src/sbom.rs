//! The software bill of materials of a language's packages: `CycloneDX` 1.6 in JSON.
//!
//! It has neither a time nor a serial number: the same packages have the same bill.

use crate::error::PackError;
use crate::files;
use serde_json::{Map, Value, json};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::path::Path;

/// The name of the file.
const FILE: &str = "sbom.cdx.json";

/// A package of an ecosystem.
#[derive(Clone, Debug, Default)]
pub struct Component {
    /// The type of package URL, such as `cargo`.
    pub kind: &'static str,
    /// The group of Maven, the scope of npm or the vendor of Debian. Empty if there is none.
    pub namespace: String,
    pub name: String,
    /// The exact version. Empty if several are accepted.
    pub version: String,
    /// The accepted versions, as the manifest writes them. Empty if there is one.
    pub requirement: String,
    /// An SPDX expression. Empty if it is not known.
    pub licence: String,
    /// A dependency that a build may leave out.
    pub is_optional: bool,
}

impl Component {
    /// Returns a component with only a type and a name.
    pub fn new(kind: &'static str, name: impl Into<String>) -> Self {
        Self {
            kind,
            name: name.into(),
            ..Self::default()
        }
    }

    /// Returns the package URL, which also identifies the component in the bill.
    fn url(&self) -> String {
        let mut url = format!("pkg:{}/", self.kind);
        if !self.namespace.is_empty() {
            url += &encoded(&self.namespace);
            url.push('/');
        }
        url += &encoded(&self.name);
        if !self.version.is_empty() {
            url.push('@');
            url += &encoded(&self.version);
        }
        url
    }

    /// Returns the component as the bill lists it, without empty facts.
    fn listed(&self) -> Map<String, Value> {
        let known = |fact: &str, value: Value| (!fact.is_empty()).then_some(value);
        let scope = if self.is_optional { "optional" } else { "" };
        let licence = json!([{ "expression": self.licence }]);
        let requirement = json!([{ "name": "fcproto:requirement", "value": self.requirement }]);
        let facts = [
            ("type", Some(json!("library"))),
            ("bom-ref", Some(json!(self.url()))),
            ("group", known(&self.namespace, json!(self.namespace))),
            ("name", Some(json!(self.name))),
            ("version", known(&self.version, json!(self.version))),
            ("scope", known(scope, json!(scope))),
            ("licenses", known(&self.licence, licence)),
            ("purl", Some(json!(self.url()))),
            ("properties", known(&self.requirement, requirement)),
        ];
        let facts = facts.into_iter();
        facts
            .filter_map(|(key, value)| Some((key.to_owned(), value?)))
            .collect()
    }
}

/// Encodes a part of a package URL. Package URL, "Character encoding": letters, digits and `.-_~:` stay.
fn encoded(part: &str) -> String {
    let mut text = String::new();
    for byte in part.bytes() {
        if byte.is_ascii_alphanumeric() || b".-_~:".contains(&byte) {
            text.push(char::from(byte));
        } else {
            // Writing to a String cannot fail.
            let _ = write!(text, "%{byte:02X}");
        }
    }
    text
}

/// A package, and its direct dependencies.
#[derive(Debug)]
pub struct Package {
    pub component: Component,
    pub dependencies: Vec<Component>,
}

/// The packages of a language.
#[derive(Debug)]
pub struct Packages {
    /// The package of the spec.
    pub main: Package,
    /// Further packages, such as the runtime.
    pub others: Vec<Package>,
}

/// Writes the bill of a language's packages.
pub fn write(directory: &Path, packages: &Packages) -> Result<(), PackError> {
    let Packages { main, others } = packages;
    let all = || std::iter::once(main).chain(others);
    let needed = all().flat_map(|it| &it.dependencies);
    let mut components: Vec<_> = others
        .iter()
        .map(|it| &it.component)
        .chain(needed)
        .collect();
    // A component is optional only if every package can do without it.
    components.sort_by_key(|it| it.is_optional);
    // A dependency on one of the packages has the URL of that package.
    let mut listed = BTreeMap::new();
    for component in components {
        let entry = listed.entry(component.url());
        entry.or_insert_with(|| component.listed());
    }
    let edges = all().map(|it| {
        let on: BTreeSet<_> = it.dependencies.iter().map(Component::url).collect();
        json!({ "ref": it.component.url(), "dependsOn": on })
    });
    let bill = json!({
        "$schema": "http://cyclonedx.org/schema/bom-1.6.schema.json",
        "bomFormat": "CycloneDX",
        "specVersion": "1.6",
        "version": 1,
        "metadata": {
            "lifecycles": [{ "phase": "build" }],
            "tools": {
                "components": [{
                    "type": "application",
                    "name": "fcproto",
                    "version": env!("CARGO_PKG_VERSION"),
                }],
            },
            "component": main.component.listed(),
        },
        "components": listed.values().collect::<Vec<_>>(),
        "dependencies": edges.collect::<Vec<_>>(),
    });
    let text = serde_json::to_string_pretty(&bill)?;
    files::write(&directory.join(FILE), text + "\n")
}
