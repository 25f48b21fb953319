//! Detects the format of an input and turns it into bytes.

use super::hex::HexText;
use crate::error::InputError;
use base64::Engine as _;
use base64::alphabet;
use base64::engine::DecodePaddingMode;
use base64::engine::general_purpose::{GeneralPurpose, GeneralPurposeConfig};
use fc_spec::model::Model;
use fc_spec::text;

/// A format of recorded bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Hexadecimal digits, with any spaces, `0x`, commas and positions, as `xxd` and `hexdump -C` print them.
    Hex,
    /// The bytes themselves.
    Binary,
    /// Base64 (RFC 4648, standard or URL alphabet).
    Base64,
    /// A capture of network packets, pcap or pcapng.
    Capture,
    /// The text of `tcpdump -x` or `tcpdump -X`.
    Tcpdump,
    /// A recording in MCAP. Reading it needs the feature `record`.
    Recording,
}

/// The first bytes of a recording in MCAP.
const RECORDING: &[u8] = b"\x89MCAP";

/// The first bytes of captures: pcap in both byte orders and resolutions, and pcapng.
const CAPTURES: [[u8; 4]; 5] = [
    [0xA1, 0xB2, 0xC3, 0xD4],
    [0xD4, 0xC3, 0xB2, 0xA1],
    [0xA1, 0xB2, 0x3C, 0x4D],
    [0x4D, 0x3C, 0xB2, 0xA1],
    [0x0A, 0x0D, 0x0D, 0x0A],
];

impl Format {
    /// Returns the format of an input that begins with these bytes.
    #[must_use]
    pub fn detect(model: &Model, beginning: &[u8]) -> Self {
        let frame = &model.frame;
        let is_frame = [&frame.request_head, &frame.response_head]
            .iter()
            .any(|head| beginning.starts_with(head));
        if !is_frame && CAPTURES.iter().any(|magic| beginning.starts_with(magic)) {
            return Self::Capture;
        }
        if !is_frame && beginning.starts_with(RECORDING) {
            return Self::Recording;
        }
        let is_text = |byte: &u8| byte.is_ascii_graphic() || byte.is_ascii_whitespace();
        if is_frame || !beginning.iter().all(is_text) {
            return Self::Binary;
        }
        let has = |words: &[u8]| beginning.windows(words.len()).any(|found| found == words);
        if beginning.first().is_some_and(u8::is_ascii_digit) && (has(b" IP ") || has(b" IP6 ")) {
            return Self::Tcpdump;
        }
        let is_base64 = |byte: &u8| {
            byte.is_ascii_alphanumeric() || byte.is_ascii_whitespace() || b"+/=-_".contains(byte)
        };
        let has_other_letters = beginning.iter().any(|byte| {
            byte.is_ascii_alphabetic() && !byte.is_ascii_hexdigit() && !b"xX".contains(byte)
        });
        if has_other_letters && beginning.iter().all(is_base64) {
            Self::Base64
        } else {
            Self::Hex
        }
    }
}

/// Turns an input into the bytes that it represents, piece by piece.
pub(super) enum Unpacker {
    Hex(HexText),
    /// The bytes themselves.
    Binary,
    /// The digits that wait for others.
    Base64(Vec<u8>),
}

/// Padding is optional, because tools leave it out.
const LENIENT: GeneralPurposeConfig =
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent);
const BASE64: GeneralPurpose = GeneralPurpose::new(&alphabet::STANDARD, LENIENT);

impl Unpacker {
    /// Appends the bytes of the next part of the input to `out`.
    pub(super) fn push(&mut self, input: &[u8], out: &mut Vec<u8>) -> Result<(), InputError> {
        match self {
            Self::Hex(dump) => dump.push(input, out),
            Self::Binary => {
                out.extend_from_slice(input);
                Ok(())
            }
            Self::Base64(kept) => {
                for byte in input {
                    match byte {
                        b'-' => kept.push(b'+'),
                        b'_' => kept.push(b'/'),
                        byte if byte.is_ascii_whitespace() => {}
                        byte => kept.push(*byte),
                    }
                }
                let whole = kept.len() / 4 * 4;
                decode_base64(kept, whole, out)
            }
        }
    }

    /// Ends the input.
    pub(super) fn finish(&mut self, out: &mut Vec<u8>) -> Result<(), InputError> {
        match self {
            Self::Hex(dump) => dump.finish(out),
            Self::Binary => Ok(()),
            Self::Base64(kept) => {
                let all = kept.len();
                decode_base64(kept, all, out)
            }
        }
    }
}

/// Decodes the first `count` digits. Padding can end each group of four.
fn decode_base64(kept: &mut Vec<u8>, count: usize, out: &mut Vec<u8>) -> Result<(), InputError> {
    let digits: Vec<u8> = kept.drain(..count).collect();
    let groups = digits.split_inclusive(|digit| *digit == b'=');
    for group in groups.filter(|group| *group != b"=") {
        BASE64.decode_vec(group, out).map_err(|_| {
            InputError(text!(
                "输入不是 base64；用 --input 指定格式",
                "the input is not base64; name its format with --input"
            ))
        })?;
    }
    Ok(())
}
