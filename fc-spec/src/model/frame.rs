//! The binary frame: header, kinds and encodings.

use super::{Aliases, Text};
use crate::names;
use crate::vocabulary::{
    ByteOrder, DigestAlgorithm, EncodingRole, HeaderQuirk, HeaderRole, Kind, KindRole, PortRole,
};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// `frame:`.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Frame {
    /// Order of the bytes of every integer of the header.
    pub byte_order: ByteOrder,
    /// Header fields in the order in which they travel.
    pub header: Vec<HeaderField>,
    /// First bytes of a request (a command or a report).
    pub request_head: Vec<u8>,
    /// First bytes of a response (an answer or an acknowledgement).
    pub response_head: Vec<u8>,
    /// Values of the header's kind field.
    pub kinds: FrameKinds,
    /// Values of the header's encoding field, sorted.
    pub encodings: Vec<Encoding>,
    /// About the data area.
    #[serde(flatten)]
    pub data: Text,
}

impl Frame {
    /// Returns the length of the header in bytes.
    #[must_use]
    pub fn header_len(&self) -> usize {
        self.header.iter().map(|field| field.ty.size()).sum()
    }

    /// Returns the header field with this role.
    #[must_use]
    pub fn field(&self, role: HeaderRole) -> Option<&HeaderField> {
        self.header.iter().find(|field| field.role == Some(role))
    }

    /// Returns `true` if a header field has this quirk.
    #[must_use]
    pub fn has_quirk(&self, quirk: HeaderQuirk) -> bool {
        self.header.iter().any(|field| field.has_quirk(quirk))
    }

    /// Returns the encoding with this role. A checked model without an encoding field in the header has no encodings.
    #[must_use]
    pub fn encoding(&self, role: EncodingRole) -> Option<&Encoding> {
        self.encodings.iter().find(|encoding| encoding.role == role)
    }
}

/// One field of the header.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct HeaderField {
    /// Name in the source document, such as `GZipDataLength`.
    #[serde(deserialize_with = "names::read_line")]
    pub wire: String,
    /// Name in code, such as `gzip_data_length`.
    #[serde(deserialize_with = "names::read_snake")]
    pub name: String,
    /// Width and kind.
    #[serde(rename = "type")]
    pub ty: HeaderType,
    /// Number of bytes before it in the frame.
    pub offset: usize,
    /// Its role. `null` for a field that the runtime does not interpret.
    pub role: Option<HeaderRole>,
    /// Default value to send; only for fields without a role or with the role `status`.
    pub value: u64,
    /// Algorithm of a digest; `null` for any other field.
    pub algorithm: Option<DigestAlgorithm>,
    /// Leniencies of the decoder.
    pub quirks: Vec<HeaderQuirk>,
    /// Description.
    #[serde(flatten)]
    pub text: Text,
    /// Other words for it.
    pub aliases: Aliases,
}

impl HeaderField {
    /// Returns the byte range of the field in a frame.
    #[must_use]
    pub fn place(&self) -> Range<usize> {
        self.offset..self.offset.saturating_add(self.ty.size())
    }

    /// Returns the digest algorithm, by default MD5. `None` for a field with another role.
    #[must_use]
    pub fn digest(&self) -> Option<DigestAlgorithm> {
        (self.role == Some(HeaderRole::Digest))
            .then(|| self.algorithm.unwrap_or(DigestAlgorithm::Md5))
    }

    /// Returns `true` if the field is sent with the value in the spec. The values of other fields depend on the frame.
    #[must_use]
    pub fn is_sent_as_value(&self) -> bool {
        match self.role {
            None | Some(HeaderRole::Status) => true,
            Some(
                HeaderRole::Head
                | HeaderRole::Kind
                | HeaderRole::Code
                | HeaderRole::Id
                | HeaderRole::Encoding
                | HeaderRole::TotalLength
                | HeaderRole::PlainLength
                | HeaderRole::Digest,
            ) => false,
        }
    }

    /// Returns `true` if the field has this quirk.
    #[must_use]
    pub fn has_quirk(&self, quirk: HeaderQuirk) -> bool {
        self.quirks.contains(&quirk)
    }
}

/// The width of a header field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HeaderType {
    /// One byte.
    U8,
    /// Two bytes.
    U16,
    /// Four bytes.
    U32,
    /// Eight bytes.
    U64,
    /// Bytes such as `bytes(16)`. The byte order does not apply to them.
    Bytes(usize),
}

impl HeaderType {
    /// Returns the width in bytes.
    #[must_use]
    pub fn size(self) -> usize {
        match self {
            Self::U8 => 1,
            Self::U16 => 2,
            Self::U32 => 4,
            Self::U64 => 8,
            Self::Bytes(len) => len,
        }
    }
}

/// The kinds of frames. In a dump they are a list, sorted by value.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(into = "Vec<FrameKind>", try_from = "Vec<FrameKind>")]
#[schemars(with = "Vec<FrameKind>")]
pub struct FrameKinds {
    /// Raw bytes.
    pub stream: FrameKind,
    /// Commands and their answers.
    pub command: FrameKind,
    /// Reports and their acknowledgements.
    pub report: FrameKind,
    /// Reserved kinds, which are refused; sorted by value.
    pub reserved: Vec<FrameKind>,
}

impl FrameKinds {
    /// Returns the frame kind of an operation.
    #[must_use]
    pub fn of(&self, kind: Kind) -> &FrameKind {
        match kind {
            Kind::Stream => &self.stream,
            Kind::Command => &self.command,
            Kind::Report => &self.report,
        }
    }

    /// Returns the frame kind with this value.
    #[must_use]
    pub fn with_value(&self, value: u8) -> Option<&FrameKind> {
        let used = [&self.stream, &self.command, &self.report];
        let mut kinds = used.into_iter().chain(&self.reserved);
        kinds.find(|kind| kind.value == value)
    }

    /// Returns all frame kinds, sorted by value.
    #[must_use]
    pub fn each(&self) -> Vec<&FrameKind> {
        let used = [&self.stream, &self.command, &self.report];
        let mut kinds: Vec<_> = used.into_iter().chain(&self.reserved).collect();
        kinds.sort_by_key(|kind| kind.value);
        kinds
    }
}

impl From<FrameKinds> for Vec<FrameKind> {
    fn from(kinds: FrameKinds) -> Self {
        kinds.each().into_iter().cloned().collect()
    }
}

impl TryFrom<Vec<FrameKind>> for FrameKinds {
    type Error = &'static str;

    fn try_from(kinds: Vec<FrameKind>) -> Result<Self, Self::Error> {
        let (mut stream, mut command, mut report) = (None, None, None);
        let mut reserved = Vec::new();
        for kind in kinds {
            let place = match kind.role {
                KindRole::Stream => &mut stream,
                KindRole::Command => &mut command,
                KindRole::Report => &mut report,
                KindRole::Reserved => {
                    reserved.push(kind);
                    continue;
                }
            };
            if place.replace(kind).is_some() {
                return Err("two frame kinds have the same role");
            }
        }
        match (stream, command, report) {
            (Some(stream), Some(command), Some(report)) => Ok(Self {
                stream,
                command,
                report,
                reserved,
            }),
            _ => Err("streams, commands and reports have a frame kind each"),
        }
    }
}

/// A value of the kind field.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct FrameKind {
    /// Value on the wire.
    pub value: u8,
    /// Its name in the spec, such as `stream`, `command`, `protobuf`, `report`.
    #[serde(deserialize_with = "names::read_snake")]
    pub name: String,
    /// Its role.
    pub role: KindRole,
    /// Port it travels on.
    pub port: PortRole,
    /// Description.
    #[serde(flatten)]
    pub text: Text,
}

/// A value of the encoding field.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Encoding {
    /// Value on the wire.
    pub value: u8,
    /// Its name in the spec, `plain` or `gzip`.
    #[serde(deserialize_with = "names::read_snake")]
    pub name: String,
    /// Compression of the data.
    pub role: EncodingRole,
    /// Description.
    #[serde(flatten)]
    pub text: Text,
}
