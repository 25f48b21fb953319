//! The parts of an operation that only streams have, and the bodies of all operations.

use super::operation::{Body, Exchange, Operation};
use crate::vocabulary::Direction;

/// Frames without a response.
#[derive(Clone, Debug)]
pub struct Stream {
    /// The content of a frame.
    pub content: Content,
    /// The name of the command that starts the stream, if stated.
    pub started_by: Option<String>,
    /// The name of the command that stops the stream, if stated.
    pub stopped_by: Option<String>,
}

/// The content of a stream frame.
#[derive(Clone, Debug)]
pub enum Content {
    /// Raw bytes, with their media type if stated.
    Bytes(Option<String>),
    /// A JSON object with these keys, without an envelope.
    Json(Body),
}

impl Stream {
    /// Returns the commands that start and stop the stream.
    pub fn commands(&self) -> impl Iterator<Item = &str> {
        [&self.started_by, &self.stopped_by]
            .into_iter()
            .filter_map(Option::as_deref)
    }
}

impl Content {
    /// Returns the media type. `None` for bytes without a stated media type.
    #[must_use]
    pub fn media_type(&self) -> Option<&str> {
        match self {
            Self::Bytes(media_type) => media_type.as_deref(),
            Self::Json(_) => Some(JSON),
        }
    }

    /// Returns the JSON body. `None` for bytes.
    #[must_use]
    pub fn json(&self) -> Option<&Body> {
        match self {
            Self::Bytes(_) => None,
            Self::Json(body) => Some(body),
        }
    }
}

impl Operation {
    /// Returns the data of a stream. `None` for commands and reports.
    #[must_use]
    pub fn stream(&self) -> Option<&Stream> {
        match &self.exchange {
            Exchange::Stream(stream) => Some(stream),
            Exchange::Command { .. } | Exchange::Report { .. } => None,
        }
    }

    /// Returns the JSON body in this direction. `None` for the bytes of a stream and for its missing response.
    #[must_use]
    pub fn body(&self, direction: Direction) -> Option<&Body> {
        match (&self.exchange, direction) {
            (Exchange::Command { messages, .. } | Exchange::Report { messages, .. }, _) => {
                Some(messages.body(direction))
            }
            (Exchange::Stream(stream), Direction::Request) => stream.content.json(),
            (Exchange::Stream(_), Direction::Response) => None,
        }
    }

    /// Returns all JSON bodies, the request first.
    pub fn bodies(&self) -> impl Iterator<Item = &Body> {
        let directions = self.directions().iter();
        directions.filter_map(|direction| self.body(*direction))
    }
}

/// The media type of JSON.
const JSON: &str = "application/json";
