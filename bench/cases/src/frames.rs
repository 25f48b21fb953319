//! Frames that the benchmarks of all languages read and write: the same bytes for each of them.

use crate::messages;
use fc_generated::Fc;
use fc_runtime::{Encoder, Message};
use std::path::{Path, PathBuf};

/// Stations of the list that makes a message between 1 and 2 KB.
const FEW: usize = 10;

/// Where they lie.
#[must_use]
pub fn directory() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../frames")
}

/// Names of files, and their bytes.
#[must_use]
pub fn all() -> Vec<(&'static str, Vec<u8>)> {
    vec![
        ("small.bin", frame(&messages::small(messages::STATION))),
        ("medium.bin", frame(&messages::stations(FEW))),
        ("long.bin", frame(&messages::stations(messages::STATIONS))),
    ]
}

fn frame<M: Message>(message: &M) -> Vec<u8> {
    let mut frame = Vec::new();
    // The list has no code of its own yet; which type a body has, the reader is told.
    let id = messages::station_id();
    Encoder::<Fc>::new().message(&mut frame, id, &messages::envelope(), message).expect("it fits");
    frame
}
