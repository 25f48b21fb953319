//! `fcproto record`.

use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};

use fc_codegen::inspect::{fingerprint, json};
use fc_reflect::Reflector;
use fc_spec::model::Model;
use fc_workshop::recording::{Origin, Recorder};

use crate::lang::{both, counted, said};
use crate::outcome::{Failure, Status, unwritable};
use crate::print;
use crate::recording::Recording;

/// Options of `fcproto record`.
#[derive(Debug, clap::Args)]
pub struct Options {
    #[command(flatten)]
    recording: Recording,
    #[arg(
        long,
        value_name = "FILE",
        help = both("写入的 MCAP 文件", "MCAP file to write")
    )]
    out: PathBuf,
}

/// Begins a recording in a file. The recorder writes whole chunks, so the file has no buffer.
pub fn recorder<'m>(model: &'m Model, path: &Path) -> Result<Recorder<'m, File>, Failure> {
    let origin = Origin {
        dump: json(model),
        fingerprint: fingerprint(model),
        program: concat!("fcproto ", env!("CARGO_PKG_VERSION")).to_owned(),
    };
    let file = File::create(path).map_err(unwritable(path))?;
    Ok(Recorder::new(model, file, &origin)?)
}

pub fn run(model: &Model, options: &Options) -> Result<Status, Failure> {
    let mut recorder = recorder(model, &options.out)?;
    let mut frames = 0_usize;
    let reflector = Reflector::new(model);
    options.recording.read(&reflector, &mut |record| {
        frames += 1;
        recorder.add(record).map_err(io::Error::other)
    })?;
    recorder.finish()?;
    let frames = counted(frames, "帧", "frame");
    let out = options.out.display();
    print::done(&said!("{frames}，写入 `{out}`\n", "{frames} in `{out}`\n"))?;
    Ok(Status::Fine)
}
