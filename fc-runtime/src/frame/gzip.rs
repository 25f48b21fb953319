//! Gzip members, with compressor and decompressor reused for the next frame.
//!
//! A new zlib state costs more than a small body, so both directions keep and reset their state. The eighteen bytes
//! around the deflated data are written and read here.

use flate2::{Compress, Compression, Crc, Decompress, FlushCompress, FlushDecompress, Status};

const MAGIC: [u8; 3] = [0x1F, 0x8B, 8];
const HEADER: [u8; 10] = [0x1F, 0x8B, 8, 0, 0, 0, 0, 0, 0, 0xFF];
const TRAILER: usize = 8;
/// Upper limit of the bytes that block headers add to incompressible data, besides a ninth bit per byte.
const BLOCKS: usize = 64;
/// Minimum room for the first step of inflating, in bytes.
const FIRST_ROOM: usize = 4096;

/// Compresses into gzip members.
#[derive(Debug)]
pub struct Deflater {
    level: u8,
    state: Compress,
}

impl Deflater {
    /// Creates a compressor with a level from 0 (store) to 9 (smallest). Higher levels count as 9.
    #[must_use]
    pub fn new(level: u8) -> Self {
        let level = level.min(9);
        Self {
            level,
            state: Compress::new(Compression::new(level.into()), false),
        }
    }

    /// Replaces `out` by the gzip member of `data`. If it is not shorter than `data`, returns `false`, and the content
    /// of `out` is undefined.
    pub fn member(&mut self, data: &[u8], out: &mut Vec<u8>) -> bool {
        out.clear();
        out.extend_from_slice(&HEADER);
        if data.len() <= HEADER.len() + TRAILER {
            return false;
        }
        // Room for the worst case, nine bits per byte, although such a result is dropped: reset clears only a state
        // that has reached its end. In zlib-rs 0.6.8, interrupted data remains and adds up to a panic.
        out.reserve_exact(data.len() + data.len() / 8 + BLOCKS);
        self.state.reset();
        let done = self.state.compress_vec(data, out, FlushCompress::Finish);
        if !matches!(done, Ok(Status::StreamEnd)) {
            *self = Self::new(self.level);
            return false;
        }
        if out.len() + TRAILER >= data.len() {
            return false;
        }
        let mut crc = Crc::new();
        crc.update(data);
        out.extend_from_slice(&crc.sum().to_le_bytes());
        out.extend_from_slice(&length_field(data.len()));
        true
    }
}

/// The reason why a member could not be inflated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InflateError {
    /// The data is not one intact member.
    Damaged,
    /// The length differs from the announced one.
    Length,
}

/// Inflates gzip members.
#[derive(Debug)]
pub struct Inflater {
    state: Decompress,
}

impl Default for Inflater {
    fn default() -> Self {
        Self {
            state: Decompress::new(false),
        }
    }
}

impl Inflater {
    /// Replaces `out` by the content of `member`, which must be exactly `plain` bytes long.
    ///
    /// Memory grows with the inflated bytes, never beyond `plain` bytes.
    ///
    /// # Errors
    /// The reason. The content of `out` is undefined then.
    pub fn inflate(
        &mut self,
        member: &[u8],
        plain: usize,
        out: &mut Vec<u8>,
    ) -> Result<(), InflateError> {
        out.clear();
        let deflated = skip_header(member).ok_or(InflateError::Damaged)?;
        self.state.reset(false);
        let mut filled = 0;
        let mut room = deflated.len().saturating_mul(4).max(FIRST_ROOM);
        let trailer = loop {
            let length = plain.min(room);
            out.reserve_exact(length.saturating_sub(out.len()));
            out.resize(length, 0);
            let target = out.get_mut(filled..).unwrap_or_default();
            let (rest, produced, ended) = if target.is_empty() {
                // The buffer is full, so the stream must end here. One more byte is too many.
                let step = self.step(deflated, &mut [0])?;
                if step.1 > 0 {
                    return Err(InflateError::Length);
                }
                step
            } else {
                self.step(deflated, target)?
            };
            filled += produced;
            if ended {
                break rest;
            }
            if filled < out.len() || produced == 0 {
                // The input is used up, but the stream is not complete.
                return Err(InflateError::Damaged);
            }
            room = room.saturating_mul(2);
        };
        out.truncate(filled);
        let mut crc = Crc::new();
        crc.update(out);
        let (sum, length) = trailer.split_at_checked(4).unwrap_or_default();
        if sum != crc.sum().to_le_bytes() || length != length_field(filled) {
            return Err(InflateError::Damaged);
        }
        if filled != plain {
            return Err(InflateError::Length);
        }
        Ok(())
    }

    /// Inflates into `target`. Returns the rest of `deflated`, the number of produced bytes, and `true` at the end of
    /// the stream.
    fn step<'a>(
        &mut self,
        deflated: &'a [u8],
        target: &mut [u8],
    ) -> Result<(&'a [u8], usize, bool), InflateError> {
        let used = |state: &Decompress| usize::try_from(state.total_in()).unwrap_or(usize::MAX);
        let before = self.state.total_out();
        let input = deflated.get(used(&self.state)..).unwrap_or_default();
        let status = self
            .state
            .decompress(input, target, FlushDecompress::None)
            .map_err(|_| InflateError::Damaged)?;
        let rest = deflated.get(used(&self.state)..).unwrap_or_default();
        let produced = usize::try_from(self.state.total_out() - before).unwrap_or(usize::MAX);
        Ok((rest, produced, status == Status::StreamEnd))
    }
}

/// Returns the last field of a member: its plain length modulo 2^32.
fn length_field(length: usize) -> [u8; 4] {
    let [a, b, c, d, ..] = (length as u64).to_le_bytes();
    [a, b, c, d]
}

/// Returns the bytes after the header of a member, which may contain optional fields.
fn skip_header(member: &[u8]) -> Option<&[u8]> {
    let mut rest = member.strip_prefix(&MAGIC)?;
    let flags = *rest.first()?;
    rest = rest.get(7..)?;
    if flags & 0b1110_0000 != 0 {
        return None;
    }
    if flags & 0b0000_0100 != 0 {
        let (length, after) = rest.split_first_chunk::<2>()?;
        rest = after.get(usize::from(u16::from_le_bytes(*length))..)?;
    }
    for text in [0b0000_1000, 0b0001_0000] {
        if flags & text != 0 {
            let end = rest.iter().position(|&byte| byte == 0)?;
            rest = rest.get(end + 1..)?;
        }
    }
    if flags & 0b0000_0010 != 0 {
        rest = rest.get(2..)?;
    }
    Some(rest)
}

#[cfg(test)]
mod tests;
