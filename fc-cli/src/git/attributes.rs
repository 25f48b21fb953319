//! The entries of `.gitattributes` that make git call `fcproto`.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use fc_codegen::output::{MANIFEST, generated, generated_directory};

use super::{git, parts};
use crate::outcome::Failure;
use crate::project::Project;

/// The name of both drivers in git.
pub const DRIVER: &str = "fc";

/// Returns the lines that the project's `.gitattributes` lacks.
pub fn missing(project: &Project) -> Result<Vec<String>, Failure> {
    let root = &project.root;
    let spec = project.spec.to_string_lossy();
    let spec = spec.trim_end_matches('/');
    let mut lines = Vec::new();
    // The files need not exist.
    let probes = ["protocol.yaml", "commands/group.yaml"].map(|file| format!("{spec}/{file}"));
    let [is_compared, is_merged] = ["diff", "merge"].map(|attribute| {
        let values = values(root, attribute, probes.iter().map(String::as_str))?;
        Ok::<_, Failure>(values.values().all(|value| value == DRIVER))
    });
    if !(is_compared? && is_merged?) {
        lines.push(format!("/{spec}/**/*.yaml diff={DRIVER} merge={DRIVER}"));
    }
    let generated: BTreeSet<String> = generated(root)?.into_iter().collect();
    let mine = generated.iter().map(String::as_str).chain([MANIFEST]);
    let values = values(root, "merge", mine)?;
    let uncovered = values.iter().filter(|(_, value)| *value != DRIVER);
    let mut patterns = BTreeSet::new();
    for (path, _) in uncovered {
        patterns.insert(match generated_directory(root, path, &generated) {
            Some(directory) => format!("/{directory}/**"),
            None => format!("/{path}"),
        });
    }
    lines.extend(patterns.iter().map(|it| format!("{it} merge={DRIVER}")));
    Ok(lines)
}

/// Returns the value of an attribute for each path.
fn values<'p>(
    root: &Path,
    attribute: &str,
    paths: impl Iterator<Item = &'p str>,
) -> Result<BTreeMap<String, String>, Failure> {
    let paths: String = paths.flat_map(|path| [path, "\0"]).collect();
    let said = git(root, &["check-attr", "-z", "--stdin", attribute], &paths)?;
    let said: Vec<&str> = parts(&said).collect();
    let (triples, _) = said.as_chunks::<3>();
    let of = |[path, _, value]: &[&str; 3]| ((*path).to_owned(), (*value).to_owned());
    Ok(triples.iter().map(of).collect())
}
