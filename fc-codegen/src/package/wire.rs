//! Facts about the wire: header, frame kinds, ports, result codes, times and limits.

use super::context::Context;
use crate::package::items::Spelled;
use fc_spec::model::{
    Ack, ByteOrder, DigestAlgorithm, EncodingRole, HeaderField, HeaderQuirk, Model, ResultCode,
    ResultRole,
};

/// The facts about the wire.
pub struct WireFacts<'p, 'm> {
    /// The name of the protocol.
    pub name: &'m str,
    /// The address of the robot.
    pub host: &'m str,
    /// The ports, by name, such as `command_port`.
    pub ports: Vec<(String, u16)>,
    /// The bytes of a frame.
    pub frame: FrameFacts<'p, 'm>,
    /// The results that the runtime responds with.
    pub results: Vec<ResultFact<'p, 'm>>,
    /// The times of calls.
    pub times: Vec<(&'static str, u32)>,
    /// The maximum age of a request, in ms.
    pub max_age_ms: Option<u32>,
    /// The timeout and the retries of an acknowledgement.
    pub ack: Ack,
    /// The limits.
    pub limits: [(&'static str, u32); 6],
}

/// The bytes of a frame.
pub struct FrameFacts<'p, 'm> {
    /// The byte order of integers.
    pub byte_order: ByteOrder,
    /// The fields of the header.
    pub header: &'p [Spelled<'m, HeaderField>],
    /// The algorithm of the digest in the header.
    pub digest: Option<DigestAlgorithm>,
    /// The first bytes of requests and of responses: `request_head`.
    pub heads: [(&'static str, &'m [u8]); 2],
    /// The values of the kind field, by name, such as `stream`.
    pub kinds: [(&'static str, u8); 3],
    /// The reserved kinds, which are refused.
    pub reserved_kinds: Vec<u8>,
    /// The value of the encoding field for uncompressed data.
    pub plain: u8,
    /// The value of the encoding field for gzip data.
    pub gzip: Option<u8>,
    /// `true` if a plain frame may state 0 as the length of its data.
    pub takes_zero_plain_length: bool,
}

/// A result that the runtime responds with.
pub struct ResultFact<'p, 'm> {
    /// The occasion.
    pub role: &'static str,
    /// The result code; a checked model has one.
    pub result: Option<&'p Spelled<'m, ResultCode>>,
}

impl ResultFact<'_, '_> {
    /// Returns the number of the code, and its Chinese text.
    pub fn code_and_text(&self) -> (i64, &str) {
        let result = self.result;
        result.map_or((0, ""), |it| (it.code, &*it.text.zh))
    }
}

impl<'p, 'm> WireFacts<'p, 'm> {
    /// Collects the facts about a protocol's wire.
    pub fn build(context: &'p Context<'m>) -> Self {
        let model = context.model();
        let ports = model.transport.ports.each().into_iter();
        let ports = ports.map(|port| (format!("{}_port", port.role.name()), port.number));
        let results = ResultRole::ALL.iter().map(|role| {
            let mut results = context.package.results.iter();
            ResultFact {
                role: role.name(),
                result: results.find(|result| result.role == Some(*role)),
            }
        });
        let (calls, limits) = (&model.calls, &model.limits);
        Self {
            name: &model.protocol.id,
            host: &model.transport.host,
            ports: ports.collect(),
            frame: FrameFacts::build(model, &context.package.header),
            results: results.collect(),
            times: vec![
                ("call_timeout", calls.timeout_ms),
                ("handler_timeout", calls.handler_timeout_ms),
            ],
            max_age_ms: calls.max_age_ms,
            ack: calls.ack,
            limits: [
                ("frame_bytes", limits.frame_bytes),
                ("inflated_bytes", limits.inflated_bytes),
                ("json_depth", limits.json_depth),
                ("in_flight", limits.in_flight),
                ("queued_reports", limits.queued_reports),
                ("connections", limits.connections),
            ],
        }
    }
}

impl<'p, 'm> FrameFacts<'p, 'm> {
    /// Returns `true` if integers begin with their most significant byte.
    pub fn is_big_endian(&self) -> bool {
        self.byte_order == ByteOrder::Big
    }

    fn build(model: &'m Model, header: &'p [Spelled<'m, HeaderField>]) -> Self {
        let frame = &model.frame;
        let kinds = &frame.kinds;
        let encoding = |role| frame.encoding(role).map(|encoding| encoding.value);
        Self {
            byte_order: frame.byte_order,
            header,
            digest: frame.header.iter().find_map(HeaderField::digest),
            heads: [
                ("request_head", &frame.request_head),
                ("response_head", &frame.response_head),
            ],
            kinds: [
                ("stream", kinds.stream.value),
                ("command", kinds.command.value),
                ("report", kinds.report.value),
            ],
            reserved_kinds: kinds.reserved.iter().map(|kind| kind.value).collect(),
            plain: encoding(EncodingRole::Plain).unwrap_or_default(),
            gzip: encoding(EncodingRole::Gzip),
            takes_zero_plain_length: frame.has_quirk(HeaderQuirk::ZeroWhenPlain),
        }
    }
}
