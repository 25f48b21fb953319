//! Helpers that several tests share: the spec's model, and every message type by its name.

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

/// Returns the project's root.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .parent()
        .unwrap()
        .to_owned()
}

/// Returns the model of the spec below `root`.
pub fn model(root: &Path) -> Model {
    let mut faults = Faults::new();
    let sources = read_dir(root, Path::new("spec"), &mut faults);
    let model = load(&sources, &mut faults).model();
    model.unwrap_or_else(|| panic!("{}", render(&faults, &sources, Format::Text, Lang::En)))
}

/// The functions of a message type that is known only by its name.
#[derive(Clone, Copy)]
pub struct Type {
    /// Its name.
    pub name: &'static str,
    /// Reads the keys of the type and writes them again.
    pub transcode: fn(&[u8]) -> Result<Vec<u8>, BodyError>,
    /// The same with the envelope of a request.
    pub request: fn(&[u8]) -> Result<Vec<u8>, BodyError>,
    /// The same with the envelope of a response.
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

    /// Returns the type of this name. Without a name, returns the type of a body without keys.
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

/// Copies a folder and everything in it.
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

/// Returns every file below a folder, by its relative path.
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
