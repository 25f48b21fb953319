//! The generated package, asked for what it makes of a frame.

use super::hex;
use fc_generated::{Fc, for_each_message};
use fc_runtime::{
    Allowance, BodyError, Decoder, Empty, FrameId, Message, Protocol, json, read_enveloped,
    write_enveloped,
};
use fc_spec::model::{Body, Direction, Kind, Model};
use std::collections::HashMap;
use std::fmt;

/// What becomes of a frame.
#[derive(Clone, PartialEq)]
pub enum Verdict {
    /// It is refused, with the error's name, the path and the place in the body.
    Refused(&'static str, String, usize),
    /// It is taken: what the header says of it, and its data. That of a message of an operation is as it is written
    /// again.
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

/// The operations of the generated package.
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

/// As a frame of a stream has it.
fn alone<B: Message>(text: &[u8], allowance: Allowance) -> Result<Vec<u8>, BodyError> {
    Ok(json::to_vec(&json::decode::<B>(text, allowance)?))
}

impl Typed {
    /// The types by the codes that the model gives them.
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

    /// What the typed runtime makes of the frame that `bytes` begin with, if its body may cost so much.
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
            // Bytes of which no more is known.
            None if kind == Fc::STREAM => Ok(data),
            // Without a type there is nothing to write again.
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
