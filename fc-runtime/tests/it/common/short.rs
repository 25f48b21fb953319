//! [`Toy`] with sixteen bits for message ids, so that they come round within a test.

use super::{Toy, ToyRequest, ToyResponse};
use fc_derive::Header;
use fc_runtime::{Defaults, OperationInfo, Protocol, Results};

/// The least that a header may have.
#[derive(Clone, Copy, Debug, Header)]
#[fc(byte_order = "little")]
pub struct Narrow {
    #[fc(role = "head")]
    pub head: [u8; 1],
    #[fc(role = "kind")]
    pub kind: u8,
    #[fc(role = "code")]
    pub code: u16,
    #[fc(role = "id")]
    pub id: u16,
    #[fc(role = "total_length")]
    pub total_length: u32,
}

/// [`Toy`] with another header.
#[derive(Clone, Copy, Debug, Default)]
pub struct Short;

impl Protocol for Short {
    type Header = Narrow;
    type Request = ToyRequest;
    type Response = ToyResponse;

    const NAME: &'static str = "short";
    const HOST: &'static str = Toy::HOST;
    const COMMAND_PORT: u16 = Toy::COMMAND_PORT;
    const DATA_PORT: u16 = Toy::DATA_PORT;
    const REQUEST_HEAD: &'static [u8] = b"?";
    const RESPONSE_HEAD: &'static [u8] = b"!";
    const STREAM: u8 = Toy::STREAM;
    const COMMAND: u8 = Toy::COMMAND;
    const REPORT: u8 = Toy::REPORT;
    const RESERVED_KINDS: &'static [u8] = &[];
    const PLAIN: u8 = 0;
    const GZIP: Option<u8> = None;
    const ZERO_PLAIN_LENGTH: bool = false;
    const RESULTS: Results = Toy::RESULTS;
    const DEFAULTS: Defaults = Toy::DEFAULTS;

    fn operations() -> &'static [OperationInfo] {
        &[]
    }
}
