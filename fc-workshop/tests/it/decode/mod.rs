//! `decode` over bytes in every form.

mod capture;
mod damage;
mod formats;
mod random;
mod texts;
mod vectors;

use fc_reflect::{Direction, Packing, Reflector};
use fc_spec::model::Model;
use fc_workshop::capture::Ports;
use fc_workshop::decode::{self, DecodeError, Format, Source};
use serde_json::Value;
use std::io::Read;

/// The lines of JSON for an input, and the result of reading it.
pub fn read(
    model: &Model,
    input: impl Read + Send,
    format: Option<Format>,
    ports: &[u16],
) -> (Vec<Value>, Result<(), DecodeError>) {
    let reflector = Reflector::new(model);
    let mut lines = Vec::new();
    let source = Source {
        input,
        format,
        ports: Ports::new(model, ports),
    };
    let result = decode::read(&reflector, source, &mut |record| {
        lines.push(serde_json::from_str(&decode::json(record)).unwrap());
        Ok(())
    });
    (lines, result)
}

/// The lines of JSON for a readable input.
pub fn lines(model: &Model, input: &[u8], format: Option<Format>) -> Vec<Value> {
    let (lines, result) = read(model, input, format, &[]);
    result.unwrap();
    lines
}

/// The name of the only error of a line, or an empty string.
pub fn error(line: &Value) -> &str {
    line["errors"][0]["name"].as_str().unwrap_or_default()
}

/// A request with the example of an operation.
pub fn sampled(model: &Model, name: &str, id: u32) -> Vec<u8> {
    let operation = model.operation(name).expect(name);
    let reflector = Reflector::new(model);
    let frame = reflector.sample(operation, Direction::Request, id, Packing::Plain);
    frame.unwrap().unwrap()
}
