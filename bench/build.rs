//! Compiles the protobuf of the peers without `protoc`, and records the version of the compiler for the report.

use std::process::Command;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    println!("cargo::rerun-if-changed=proto/bench.proto");
    let descriptors = protox::compile(["proto/bench.proto"], ["proto"])?;
    tonic_prost_build::configure().compile_fds(descriptors)?;

    let rustc = std::env::var("RUSTC")?;
    let version = Command::new(rustc).arg("--version").output()?.stdout;
    println!("cargo::rustc-env=FC_BENCH_RUSTC={}", String::from_utf8(version)?.trim());
    Ok(())
}
