//! The frames that the benchmarks of all languages read and write.

use crate::messages;
use fc_generated::Fc;
use fc_runtime::{Encoder, Message};
use std::path::{Path, PathBuf};

/// Number of stations in the medium frame, which has between 1 and 2 KB.
const FEW: usize = 10;

/// Returns the directory of the frames.
#[must_use]
pub fn directory() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../frames")
}

/// Returns the file names and contents of all frames.
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
    // Every frame has the code of the request for a station. Readers know the type of the body from the file name.
    let id = messages::station_id();
    Encoder::<Fc>::new().message(&mut frame, id, &messages::envelope(), message).expect("it fits");
    frame
}
