//! Where the project is.

use std::path::PathBuf;

use crate::Failure;
use crate::args::Place;

/// The file that every spec has.
const PROTOCOL: &str = "protocol.yaml";

/// The project's root: the one named, or the nearest directory upwards that holds a spec.
pub fn root(place: &Place) -> Result<PathBuf, Failure> {
    if let Some(root) = &place.root {
        if !root.is_dir() {
            return Err(format!("`{}` is not a directory", root.display()).into());
        }
        return Ok(root.clone());
    }
    let here = std::env::current_dir().map_err(|error| {
        format!("cannot tell the current directory: {error}; name one with --root")
    })?;
    let protocol = place.spec.join(PROTOCOL);
    here.ancestors()
        .find(|directory| directory.join(&protocol).is_file())
        .map(PathBuf::from)
        .ok_or_else(|| {
            format!(
                "no `{}` here or in a directory above; go to the project, or name it with --root",
                protocol.display()
            )
            .into()
        })
}
