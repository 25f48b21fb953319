//! The list of generated files.

use fc_spec::model::Value;
use std::collections::{BTreeMap, BTreeSet};

/// The path of the manifest, relative to the root.
pub const MANIFEST: &str = "fc-manifest.json";

/// The format of the manifest. Other formats are refused.
const FORMAT: i64 = 1;

/// Paths by product name. Names of products that this version does not know are kept.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Manifest {
    products: BTreeMap<String, BTreeSet<String>>,
}

/// Merges two versions of a manifest with their common `base`. The result has all additions of both sides, and none of
/// their removals. Returns `None` if one of them cannot be read. An empty `base` is an empty manifest.
#[must_use]
pub fn merge_manifests(base: &str, ours: &str, theirs: &str) -> Option<String> {
    let base = if base.is_empty() {
        Manifest::default()
    } else {
        Manifest::parse(base).ok()?
    };
    let ours = Manifest::parse(ours).ok()?;
    let theirs = Manifest::parse(theirs).ok()?;
    Some(Manifest::merge(&base, ours, &theirs).print())
}

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct Document {
    format: i64,
    #[serde(rename = "about")]
    _about: String,
    products: BTreeMap<String, BTreeSet<String>>,
}

impl Manifest {
    /// Reads a manifest.
    ///
    /// # Errors
    /// The reason why it cannot be read.
    pub fn parse(text: &str) -> Result<Self, String> {
        let document: Document = serde_json::from_str(text).map_err(|error| error.to_string())?;
        if document.format != FORMAT {
            return Err(format!("its format is {}, not {FORMAT}", document.format));
        }
        Ok(Self {
            products: document.products,
        })
    }

    /// Returns the text of the file. Each path is on its own line, so that it merges well.
    pub fn print(&self) -> String {
        let text = |text: &str| Value::String(text.to_owned());
        let products = self.products.iter().map(|(product, paths)| {
            (
                product.clone(),
                Value::Array(paths.iter().map(|path| text(path)).collect()),
            )
        });
        let document = Value::Object(vec![
            (
                "format".to_owned(),
                Value::Number(fc_spec::model::Number::Int(FORMAT.into())),
            ),
            (
                "about".to_owned(),
                text(
                    "Files that `fcproto generate` wrote and may overwrite or remove; it touches no others.",
                ),
            ),
            ("products".to_owned(), Value::Object(products.collect())),
        ]);
        document.pretty() + "\n"
    }

    /// Returns `true` if a product owns the path.
    pub fn owns(&self, path: &str) -> bool {
        self.products.values().any(|paths| paths.contains(path))
    }

    /// Returns the paths with the names of their products.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &str)> {
        self.products.iter().flat_map(|(product, paths)| {
            paths
                .iter()
                .map(move |path| (product.as_str(), path.as_str()))
        })
    }

    /// Merges two versions. The result has all additions of both sides, and none of their removals.
    fn merge(base: &Self, ours: Self, theirs: &Self) -> Self {
        let has = |manifest: &Self, product: &str, path: &str| {
            let paths = manifest.products.get(product);
            paths.is_some_and(|paths| paths.contains(path))
        };
        let mut merged = ours;
        for (product, path) in theirs.iter() {
            if !has(base, product, path) {
                merged.add(product, path);
            }
        }
        for (product, paths) in &mut merged.products {
            paths.retain(|path| !has(base, product, path) || has(theirs, product, path));
        }
        merged.products.retain(|_, paths| !paths.is_empty());
        merged
    }

    /// Adds a path to a product.
    pub fn add(&mut self, product: &str, path: &str) {
        self.products
            .entry(product.to_owned())
            .or_default()
            .insert(path.to_owned());
    }

    /// Removes a path from every product except this one.
    pub fn leave_to(&mut self, product: &str, path: &str) {
        for (name, paths) in &mut self.products {
            if name != product {
                paths.remove(path);
            }
        }
        self.products.retain(|_, paths| !paths.is_empty());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn survives_a_round_trip() {
        let mut manifest = Manifest::default();
        manifest.add("rust", "b.rs");
        manifest.add("rust", "a.rs");
        manifest.add("markdown", "参考.md");
        let text = manifest.print();
        assert!(
            matches!(Manifest::parse(&text), Ok(read) if read == manifest),
            "{text}"
        );
    }

    #[test]
    fn two_sides_add_and_take_away() {
        let text = |paths: &[(&str, &str)]| {
            let mut manifest = Manifest::default();
            for (product, path) in paths {
                manifest.add(product, path);
            }
            manifest.print()
        };
        let base = text(&[("rust", "a.rs"), ("rust", "b.rs"), ("old", "c")]);
        let ours = text(&[("rust", "b.rs"), ("rust", "ours.rs"), ("old", "c")]);
        let theirs = text(&[("rust", "a.rs"), ("rust", "b.rs"), ("new", "d")]);
        let merged = text(&[("rust", "b.rs"), ("rust", "ours.rs"), ("new", "d")]);
        assert_eq!(merge_manifests(&base, &ours, &theirs), Some(merged));
        let both = text(&[("a", "a"), ("b", "b")]);
        assert_eq!(
            merge_manifests("", &text(&[("a", "a")]), &text(&[("b", "b")])),
            Some(both)
        );
        assert_eq!(merge_manifests(&base, "<<<<<<<", &theirs), None);
    }

    #[test]
    fn refuses_unknown_lines() {
        for text in [
            "",
            "<<<<<<< HEAD",
            "{}",
            r#"{"format":2,"about":"","products":{}}"#,
            r#"{"format":1,"about":"","products":{},"more":1}"#,
        ] {
            assert!(Manifest::parse(text).is_err(), "{text}");
        }
    }
}
