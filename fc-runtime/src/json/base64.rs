//! Bytes sent as base64.

use super::{BodyError, BodyErrorKind, FromJson, Reader, ToJson, Writer};
use base64::Engine;
use base64::engine::general_purpose;

/// Bytes sent as a base64 string (RFC 4648, standard alphabet, padded).
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub struct Bytes64(pub Vec<u8>);

impl From<Vec<u8>> for Bytes64 {
    fn from(bytes: Vec<u8>) -> Self {
        Self(bytes)
    }
}

impl FromJson for Bytes64 {
    fn read(reader: &mut Reader<'_>) -> Result<Self, BodyError> {
        reader.peek();
        let start = reader.clone();
        let text = reader.string()?;
        match engine().decode(text.as_bytes()) {
            Ok(bytes) => Ok(Self(bytes)),
            Err(error) => Err(start.fault(
                BodyErrorKind::BadBase64,
                format!("{error}; send padded base64 of the standard alphabet"),
            )),
        }
    }
}

impl ToJson for Bytes64 {
    fn write(&self, writer: &mut Writer<'_>) {
        writer.base64(&self.0);
    }
}

/// The fastest codec of this machine.
#[cfg(any(
    target_arch = "x86_64",
    all(target_arch = "aarch64", target_feature = "neon")
))]
fn engine() -> &'static impl Engine {
    use base64::engine::Simd;
    use std::sync::LazyLock;
    static ENGINE: LazyLock<Simd> = LazyLock::new(|| Simd::standard(general_purpose::PAD));
    &*ENGINE
}

/// The fastest codec of this machine.
#[cfg(not(any(
    target_arch = "x86_64",
    all(target_arch = "aarch64", target_feature = "neon")
)))]
fn engine() -> &'static impl Engine {
    &general_purpose::STANDARD
}

/// Appends the base64 of `bytes`.
pub(super) fn encode(bytes: &[u8], out: &mut Vec<u8>) {
    let start = out.len();
    let length = bytes.len().div_ceil(3) * 4;
    out.resize(start + length, b'=');
    let room = out.get_mut(start..).unwrap_or_default();
    // The room fits exactly, which is the only way for this to fail.
    let written = engine().encode_slice(bytes, room).unwrap_or(0);
    debug_assert_eq!(written, length);
}
