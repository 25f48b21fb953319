//! What a stream is beside what all operations have in common.

use super::operation::{Body, Exchange, Operation};
use crate::vocabulary::Direction;

/// Frames that one side sends and nobody answers.
#[derive(Clone, Debug)]
pub struct Stream {
    /// What a frame carries.
    pub content: Content,
    /// Name of the command after which it is sent, if one is stated.
    pub started_by: Option<String>,
    /// Name of the command after which it is no longer sent, if one is stated.
    pub stopped_by: Option<String>,
}

/// What a frame of a stream carries.
#[derive(Clone, Debug)]
pub enum Content {
    /// Bytes that the protocol says no more of than their media type, and that only where it is stated.
    Bytes(Option<String>),
    /// A JSON object with these keys, and no envelope beside them.
    Json(Body),
}

impl Stream {
    /// The commands that start and stop it.
    pub fn commands(&self) -> impl Iterator<Item = &str> {
        [&self.started_by, &self.stopped_by]
            .into_iter()
            .filter_map(Option::as_deref)
    }
}

impl Content {
    /// Media type of its bytes; `None` where none is stated.
    #[must_use]
    pub fn media_type(&self) -> Option<&str> {
        match self {
            Self::Bytes(media_type) => media_type.as_deref(),
            Self::Json(_) => Some(JSON),
        }
    }

    /// What is JSON; `None` for other bytes.
    #[must_use]
    pub fn json(&self) -> Option<&Body> {
        match self {
            Self::Bytes(_) => None,
            Self::Json(body) => Some(body),
        }
    }
}

impl Operation {
    /// What a stream is beside what all operations have; `None` for commands and reports.
    #[must_use]
    pub fn stream(&self) -> Option<&Stream> {
        match &self.exchange {
            Exchange::Stream(stream) => Some(stream),
            Exchange::Command { .. } | Exchange::Report { .. } => None,
        }
    }

    /// What travels this way as JSON; `None` for the bytes of a stream, and for its answer.
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

    /// All that travels as JSON, the request first.
    pub fn bodies(&self) -> impl Iterator<Item = &Body> {
        let directions = self.directions().iter();
        directions.filter_map(|direction| self.body(*direction))
    }
}

/// The media type of JSON.
const JSON: &str = "application/json";
