//! What several tests need: the spec's model, and every message type by its name.

#[cfg(feature = "client")]
pub mod arbitrary;
pub mod nested;
#[cfg(all(feature = "client", feature = "server"))]
pub mod programs;

use fc_generated::{Fc, for_each_message};
use fc_runtime::{BodyError, Empty, Message, Protocol, read_enveloped, transcode, write_enveloped};
use fc_spec::diagnostic::{Faults, Format, render};
use fc_spec::load::load;
use fc_spec::model::{Lang, Model};
use fc_spec::syntax::read_dir;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// The project's root.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .parent()
        .unwrap()
        .to_owned()
}

/// The model of the spec below `root`.
pub fn model(root: &Path) -> Model {
    let mut faults = Faults::new();
    let sources = read_dir(root, Path::new("spec"), &mut faults);
    let model = load(&sources, &mut faults).model();
    model.unwrap_or_else(|| panic!("{}", render(&faults, &sources, Format::Text, Lang::En)))
}

/// What can be done with a message type that is known by name alone.
#[derive(Clone, Copy)]
pub struct Type {
    /// Its name.
    pub name: &'static str,
    /// Reads the own keys and writes them again.
    pub transcode: fn(&[u8]) -> Result<Vec<u8>, BodyError>,
    /// The same beside the envelope of a request.
    pub request: fn(&[u8]) -> Result<Vec<u8>, BodyError>,
    /// The same beside the envelope of a response.
    pub response: fn(&[u8]) -> Result<Vec<u8>, BodyError>,
}

impl Type {
    const fn of<M: Message>(name: &'static str) -> Self {
        Self {
            name,
            transcode: transcode::<M>,
            request: enveloped::<<Fc as Protocol>::Request, M>,
            response: enveloped::<<Fc as Protocol>::Response, M>,
        }
    }

    /// The type of this name; that of a body without keys if there is no name.
    pub fn named(name: Option<&str>) -> Self {
        let Some(name) = name else {
            return Self::of::<Empty>("Empty");
        };
        let found = TYPES.iter().find(|ty| ty.name == name);
        *found.unwrap_or_else(|| panic!("{name} is not generated"))
    }
}

macro_rules! types {
    ($($message:ident;)*) => {
        /// Every message type.
        pub const TYPES: &[Type] = &[$(Type::of::<fc_generated::$message>(stringify!($message))),*];
    };
}
for_each_message!(types);

fn enveloped<E: Message, B: Message>(text: &[u8]) -> Result<Vec<u8>, BodyError> {
    let read = read_enveloped::<E, B>(text, Fc::DEFAULTS.limits.json())?;
    let mut out = Vec::new();
    write_enveloped(&read.envelope, &read.body?, &mut out);
    Ok(out)
}

/// Copies a folder with all that is in it.
pub fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap() {
        let place = entry.unwrap().path();
        let target = to.join(place.file_name().unwrap());
        if place.is_dir() {
            copy(&place, &target);
        } else {
            fs::copy(&place, &target).unwrap();
        }
    }
}

/// Every file below a folder, by its path from there.
pub fn tree(root: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut files = BTreeMap::new();
    let mut folders = vec![root.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let place = entry.unwrap().path();
            if place.is_dir() {
                folders.push(place);
            } else {
                let path = place
                    .strip_prefix(root)
                    .unwrap()
                    .to_string_lossy()
                    .into_owned();
                files.insert(path, fs::read(&place).unwrap());
            }
        }
    }
    files
}
