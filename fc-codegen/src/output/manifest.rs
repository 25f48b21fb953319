//! Which files are the generator's.

use fc_spec::model::Value;
use std::collections::{BTreeMap, BTreeSet};

/// Path of the manifest from the root.
pub const MANIFEST: &str = "fc-manifest.json";

/// Layout of the manifest; a reader of another one must not guess.
const FORMAT: i64 = 1;

/// Owned paths by product name. Names of products that this version does not make are kept.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Manifest {
    products: BTreeMap<String, BTreeSet<String>>,
}

/// The text of a manifest that two branches have changed, which began with `base`: whatever either has added, without what
/// either has taken away. `None` if one of them cannot be read; an empty `base` is none.
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

/// The file as JSON.
#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct Document {
    format: i64,
    #[serde(rename = "about")]
    _about: String,
    products: BTreeMap<String, BTreeSet<String>>,
}

impl Manifest {
    /// Reads the file.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn parse(text: &str) -> Result<Self, String> {
        let document: Document = serde_json::from_str(text).map_err(|error| error.to_string())?;
        if document.format != FORMAT {
            return Err(format!("its format is {}, not {FORMAT}", document.format));
        }
        Ok(Self {
            products: document.products,
        })
    }

    /// The file's text, one path to a line so that it merges well.
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

    /// Whether some product owns a path.
    pub fn owns(&self, path: &str) -> bool {
        self.products.values().any(|paths| paths.contains(path))
    }

    /// Owned paths with the names of their products.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &str)> {
        self.products.iter().flat_map(|(product, paths)| {
            paths
                .iter()
                .map(move |path| (product.as_str(), path.as_str()))
        })
    }

    /// What both sides say that began with the same one: whatever either has added, without what either has taken away.
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

    /// Gives a path to a product.
    pub fn add(&mut self, product: &str, path: &str) {
        self.products
            .entry(product.to_owned())
            .or_default()
            .insert(path.to_owned());
    }

    /// Takes a path from every product but this one.
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
    fn refuses_what_it_does_not_understand() {
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
