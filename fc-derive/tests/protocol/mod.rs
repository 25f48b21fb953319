//! A protocol for programs that are only compiled.

#![allow(dead_code, unreachable_pub, missing_docs)]

use fc_derive::{Command, Envelope, Header, Message};
use fc_runtime::{AckPolicy, Defaults, Limits, OperationInfo, Protocol, ResultText, Results};
use std::time::Duration;

#[derive(Clone, Copy, Header)]
#[fc(byte_order = "big")]
pub struct FrameHeader {
    #[fc(role = "head")]
    head: [u8; 1],
    #[fc(role = "kind")]
    kind: u8,
    #[fc(role = "code")]
    code: u16,
    #[fc(role = "id")]
    id: u32,
    #[fc(role = "encoding")]
    encoding: u8,
    #[fc(role = "total_length")]
    total_length: u32,
    #[fc(role = "plain_length")]
    plain_length: u32,
    #[fc(role = "digest")]
    digest: [u8; 16],
}

#[derive(Message, Envelope)]
#[fc(envelope = "request")]
pub struct Asked {}

#[derive(Message, Envelope)]
#[fc(envelope = "response")]
pub struct Answered {
    #[fc(role = "result_code")]
    code: i32,
}

#[derive(Message, Command)]
#[fc(code = 0x0A04, name = "drive", effect = "motion", response = Driven)]
pub struct Drive {}

#[derive(Message)]
pub struct Driven {}

/// Has the code of [`Drive`].
#[derive(Message, Command)]
#[fc(code = 0x0A04, name = "steer", effect = "motion", response = Driven)]
pub struct Steer {}

#[derive(Clone, Copy, Debug, Default)]
pub struct Fc;

const NONE: ResultText = ResultText { code: 0, text: "" };

impl Protocol for Fc {
    type Header = FrameHeader;
    type Request = Asked;
    type Response = Answered;

    const NAME: &'static str = "test";
    const HOST: &'static str = "127.0.0.1";
    const COMMAND_PORT: u16 = 0;
    const DATA_PORT: u16 = 0;
    const REQUEST_HEAD: &'static [u8] = b"?";
    const RESPONSE_HEAD: &'static [u8] = b"!";
    const STREAM: u8 = 0;
    const COMMAND: u8 = 1;
    const REPORT: u8 = 3;
    const RESERVED_KINDS: &'static [u8] = &[];
    const PLAIN: u8 = 0;
    const GZIP: Option<u8> = Some(1);
    const ZERO_PLAIN_LENGTH: bool = false;
    const RESULTS: Results =
        Results { success: NONE, protocol: NONE, timeout: NONE, invalid: NONE, expired: NONE };
    const DEFAULTS: Defaults = Defaults {
        call_timeout: Duration::ZERO,
        handler_timeout: Duration::ZERO,
        max_age: None,
        ack: AckPolicy { timeout: Duration::ZERO, retries: 0 },
        limits: Limits {
            frame_bytes: 0,
            inflated_bytes: 0,
            json_depth: 0,
            inflate_ratio: Limits::INFLATE_RATIO,
            json_values: Limits::JSON_VALUES,
            json_list_bytes: Limits::JSON_LIST_BYTES,
            in_flight: 0,
            queued_reports: 0,
            connections: 0,
        },
    };

    fn operations() -> &'static [OperationInfo] {
        &[]
    }
}
