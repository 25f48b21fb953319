//! One run of a generator. It has a separate process, so that its peak memory can be measured.

use super::ALL;
use crate::cost::peak_memory;
use fc_codegen::emit::generate;
use fc_codegen::output::plan;
use fc_codegen::product::Product;
use fc_codegen::target::Targets;
use fc_spec::diagnostic::Faults;
use fc_spec::{load, syntax};
use std::path::Path;
use std::time::Instant;

/// Number of steps whose seconds [`ours`] prints.
pub const STEPS: usize = 4;

/// Runs `generate-once ROOT PRODUCT`. Generates files below `ROOT` from `ROOT/spec`. `all` selects all products.
///
/// Prints the seconds of reading, checking, generating and writing, and the peak memory in MiB.
pub fn ours(root: &str, products: &str) {
    let root = Path::new(root);
    let only = match products {
        ALL => Product::ALL.to_vec(),
        one => vec![Product::named(one).expect("a product")],
    };
    let mut seconds = Vec::with_capacity(STEPS);
    let mut last = Instant::now();
    let mut step = || {
        seconds.push(last.elapsed().as_secs_f64());
        last = Instant::now();
    };
    let mut faults = Faults::new();
    let sources = syntax::read_dir(root, Path::new("spec"), &mut faults);
    step();
    let Some(model) = load::load(&sources, &mut faults).model() else {
        faults.iter().for_each(|fault| eprintln!("{}", fault.message.en));
        panic!("the spec has faults");
    };
    step();
    let artifacts = generate(&model, &Targets::of(only)).expect("no audience is named");
    step();
    plan(artifacts, root, &[]).and_then(|plan| plan.write()).expect("the files are written");
    step();
    let seconds: Vec<String> = seconds.iter().map(ToString::to_string).collect();
    println!("{} {}", seconds.join(" "), peak_memory());
}

/// Runs `generate-prost ROOT`. Generates a file in `ROOT` from `ROOT/synthetic.proto`. Prints seconds and peak memory.
pub fn prost(root: &str) {
    let start = Instant::now();
    let descriptors = protox::compile(["synthetic.proto"], [root]).expect("a sound file");
    prost_build::Config::new().out_dir(root).compile_fds(descriptors).expect("the file is written");
    println!("{} {}", start.elapsed().as_secs_f64(), peak_memory());
}

/// Runs `read-once ROOT`. Only reads the files of `ROOT/spec`. Prints seconds, peak memory, and the bytes read.
pub fn read(root: &str) {
    let start = Instant::now();
    let mut bytes = 0;
    for directory in ["spec", "spec/commands"] {
        for entry in std::fs::read_dir(Path::new(root).join(directory)).expect("a directory") {
            let path = entry.expect("an entry").path();
            if path.extension().is_some_and(|extension| extension == "yaml") {
                bytes += std::fs::read(path).expect("a file").len();
            }
        }
    }
    println!("{} {} {bytes}", start.elapsed().as_secs_f64(), peak_memory());
}
