//! Reads captured bytes in hexadecimal, and prints each frame with its errors.
//!
//! ```text
//! echo FC AA 01 … | cargo run --example decode
//! ```

#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "an example talks to its reader"
)]

use fc_generated::Fc;
use fc_generated::descriptors::OPERATIONS;
use fc_runtime::{Decoder, FrameId};
use std::error::Error;
use std::io::Read as _;

// #region decode
fn main() -> Result<(), Box<dyn Error>> {
    let mut text = String::new();
    std::io::stdin().read_to_string(&mut text)?;

    let mut decoder = Decoder::<Fc>::new();
    decoder.push(&bytes(&text)?);
    loop {
        match decoder.next() {
            Ok(Some(frame)) => {
                let id = frame.id();
                println!("{}", title(id));
                println!("  {}", String::from_utf8_lossy(frame.body()));
                println!("  {}", verdict(id, frame.body()));
            }
            Ok(None) => break,
            // 长度可信的坏帧会被跳过，后面的帧照常解析。
            // A bad frame with a trustworthy length is skipped, and the next frames are read.
            Err(error) => {
                println!("{}: {error}", error.name());
                if error.is_fatal() {
                    break;
                }
            }
        }
    }
    if let Err(error) = decoder.finish() {
        println!("{}: {error}", error.name());
    }
    Ok(())
}
// #endregion decode

/// Returns the operation, its side, and the id that ties both sides together.
fn title(id: FrameId) -> String {
    let name = OPERATIONS
        .iter()
        .find(|operation| operation.code == Some(id.code));
    let name = name.map_or("?", |operation| operation.name);
    let side = if id.response { "response" } else { "request" };
    format!("0x{:04X} {name} {side}, msgId {}", id.code, id.id)
}

/// Reads the body with the types of the spec. Returns `ok` or the error.
fn verdict(id: FrameId, body: &[u8]) -> String {
    let Some(operation) = OPERATIONS
        .iter()
        .find(|operation| operation.code == Some(id.code))
    else {
        return "the spec does not know this code".to_owned();
    };
    let side = if id.response {
        &operation.response
    } else {
        &operation.request
    };
    match (side.transcode)(body) {
        Ok(_) => "ok".to_owned(),
        Err(error) => format!("{}: {error}", error.name()),
    }
}

/// Returns the bytes of the hex digits in `text`, which may have other characters between them.
fn bytes(text: &str) -> Result<Vec<u8>, Box<dyn Error>> {
    let digits: Vec<u32> = text
        .chars()
        .filter_map(|character| character.to_digit(16))
        .collect();
    let mut bytes = Vec::with_capacity(digits.len() / 2);
    for pair in digits.chunks(2) {
        let [high, low] = pair else {
            return Err("there is half a byte at the end".into());
        };
        bytes.push(u8::try_from(high * 16 + low)?);
    }
    Ok(bytes)
}
