//! Decodes frames with the generated package.

use super::hex;
use fc_generated::{Fc, for_each_message};
use fc_runtime::{
    Allowance, BodyError, Decoder, Empty, FrameId, Message, Protocol, json, read_enveloped,
    write_enveloped,
};
use fc_spec::model::{Body, Direction, Kind, Model};
use std::collections::HashMap;
use std::fmt;

/// The result of decoding a frame.
#[derive(Clone, PartialEq)]
pub enum Verdict {
    /// The frame is refused: the name of the error, the path and the offset in the body.
    Refused(&'static str, String, usize),
    /// The frame is accepted: the content of its header, and its data. The message of a known operation is decoded and
    /// encoded again.
    Taken {
        response: bool,
        kind: u8,
        code: u16,
        id: u32,
        data: Vec<u8>,
    },
}

impl Verdict {
    pub fn name(&self) -> &'static str {
        match self {
            Self::Refused(name, ..) => name,
            Self::Taken { .. } => "taken",
        }
    }
}

impl fmt::Debug for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Refused(name, path, offset) => write!(f, "{name} at `{path}` ({offset})"),
            Self::Taken {
                response,
                kind,
                code,
                id,
                data,
            } => write!(
                f,
                "taken: response {response}, kind {kind}, code {code:04x}, id {id}, {} = {}",
                hex(data),
                String::from_utf8_lossy(data)
            ),
        }
    }
}

type Transcode = fn(&[u8], Allowance) -> Result<Vec<u8>, BodyError>;

/// Transcoders for the messages of the generated package, by kind, code and direction.
pub struct Typed {
    bodies: HashMap<(u8, u16, bool), Transcode>,
}

macro_rules! types {
    ($($message:ident;)*) => {
        const TYPES: &[(&str, Transcode, Transcode, Transcode)] = &[$((
            stringify!($message),
            enveloped::<<Fc as Protocol>::Request, fc_generated::$message>,
            enveloped::<<Fc as Protocol>::Response, fc_generated::$message>,
            alone::<fc_generated::$message>,
        )),*];
    };
}
for_each_message!(types);

fn enveloped<E: Message, B: Message>(
    text: &[u8],
    allowance: Allowance,
) -> Result<Vec<u8>, BodyError> {
    let read = read_enveloped::<E, B>(text, allowance)?;
    let mut out = Vec::new();
    write_enveloped(&read.envelope, &read.body?, &mut out);
    Ok(out)
}

/// Transcodes a message without an envelope, as in a stream.
fn alone<B: Message>(text: &[u8], allowance: Allowance) -> Result<Vec<u8>, BodyError> {
    Ok(json::to_vec(&json::decode::<B>(text, allowance)?))
}

impl Typed {
    /// Assigns the types of the package to the codes of the model.
    pub fn new(model: &Model) -> Self {
        let mut bodies = HashMap::new();
        for operation in &model.operations {
            let kind = match operation.kind() {
                Kind::Command => Fc::COMMAND,
                Kind::Report => Fc::REPORT,
                Kind::Stream => Fc::STREAM,
            };
            let Some(code) = operation.code.value else {
                continue;
            };
            let typed = |body: &Body| {
                let mut types = TYPES.iter();
                let row = types.find(|(name, ..)| *name == body.ty.name());
                row.expect("it is generated")
            };
            if let Some(messages) = operation.messages() {
                bodies.insert((kind, code, false), typed(&messages.request).1);
                bodies.insert((kind, code, true), typed(&messages.response).2);
            } else if let Some(body) = operation.body(Direction::Request) {
                bodies.insert((kind, code, false), typed(body).3);
            }
        }
        Self { bodies }
    }

    /// Returns the verdict of the typed runtime on the first frame of `bytes`. `allowance` limits the cost of its body.
    pub fn verdict(&self, bytes: &[u8], allowance: Allowance) -> Verdict {
        let mut decoder = Decoder::<Fc>::new();
        decoder.push(bytes);
        let (id, data) = match decoder.next() {
            Ok(Some(frame)) => (frame.id(), frame.body().to_vec()),
            Ok(None) => return Verdict::Refused("truncated", String::new(), 0),
            Err(error) => return Verdict::Refused(error.name(), String::new(), 0),
        };
        let FrameId {
            response,
            kind,
            code,
            id,
        } = id;
        let known = self.bodies.get(&(kind, code, response));
        let body = match known {
            Some(transcode) => transcode(&data, allowance),
            // The content of an unknown stream is opaque.
            None if kind == Fc::STREAM => Ok(data),
            // Without a type, only the envelope is read, and the data stays unchanged.
            None if response => {
                enveloped::<<Fc as Protocol>::Response, Empty>(&data, allowance).map(|_| data)
            }
            None => enveloped::<<Fc as Protocol>::Request, Empty>(&data, allowance).map(|_| data),
        };
        match body {
            Ok(data) => Verdict::Taken {
                response,
                kind,
                code,
                id,
                data,
            },
            Err(error) => Verdict::Refused(error.name(), error.path().to_owned(), error.offset()),
        }
    }
}
