//! Gzip members, inflated no further than announced.

use flate2::{Compress, Compression, Crc, Decompress, FlushCompress, FlushDecompress, Status};

const MAGIC: [u8; 3] = [0x1F, 0x8B, 8];
const HEADER: [u8; 10] = [0x1F, 0x8B, 8, 0, 0, 0, 0, 0, 0, 0xFF];
const TRAILER: usize = 8;
/// Least room for a first step of inflating, in bytes.
const FIRST_ROOM: usize = 4096;

/// One member of `data`, unless that is not shorter. `level` from 0 (store) to 9 (smallest).
pub(crate) fn member(data: &[u8], level: u8) -> Option<Vec<u8>> {
    let room = data.len().checked_sub(HEADER.len() + TRAILER)?;
    let mut out = HEADER.to_vec();
    out.reserve_exact(room + TRAILER);
    let mut state = Compress::new(Compression::new(u32::from(level.min(9))), false);
    // No further than the room reserved above: what does not fit is sent plain.
    let done = state.compress_vec(data, &mut out, FlushCompress::Finish);
    if !matches!(done, Ok(Status::StreamEnd)) || out.len() + TRAILER >= data.len() {
        return None;
    }
    out.extend(trailer(data));
    Some(out)
}

/// Why a member was not inflated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum InflateError {
    /// Not one intact member.
    Damaged,
    /// Another length than announced.
    Length,
}

/// The content of a member, which has to be exactly `plain` bytes long. Memory grows with what really comes out, and
/// never beyond that.
pub(crate) fn inflate(member: &[u8], plain: usize) -> Result<Vec<u8>, InflateError> {
    let mut input = skip_header(member).ok_or(InflateError::Damaged)?;
    let mut state = Decompress::new(false);
    let mut out = Vec::new();
    let mut filled = 0;
    let mut room = input.len().saturating_mul(4).max(FIRST_ROOM);
    loop {
        let length = plain.min(room);
        out.reserve_exact(length.saturating_sub(out.len()));
        out.resize(length, 0);
        // Where all is full the stream has to end; a byte more is one too many.
        let mut beyond = [0];
        let is_full = filled == out.len();
        let target = if is_full {
            &mut beyond
        } else {
            out.get_mut(filled..).unwrap_or_default()
        };
        let (rest, produced, ended) = step(&mut state, input, target)?;
        input = rest;
        if is_full && produced > 0 {
            return Err(InflateError::Length);
        }
        filled += produced;
        if ended {
            break;
        }
        if filled < out.len() || produced == 0 {
            // The input is used up and the stream wants more of it.
            return Err(InflateError::Damaged);
        }
        room = room.saturating_mul(2);
    }
    out.truncate(filled);
    if input != trailer(&out) {
        return Err(InflateError::Damaged);
    }
    if filled != plain {
        return Err(InflateError::Length);
    }
    Ok(out)
}

/// Inflates on into `target`: what of the input is left, how many bytes were produced, and whether the stream has ended.
fn step<'a>(
    state: &mut Decompress,
    input: &'a [u8],
    target: &mut [u8],
) -> Result<(&'a [u8], usize, bool), InflateError> {
    let (read, written) = (state.total_in(), state.total_out());
    let status = state
        .decompress(input, target, FlushDecompress::None)
        .map_err(|_| InflateError::Damaged)?;
    let since = |before: u64, now: u64| usize::try_from(now - before).unwrap_or(usize::MAX);
    let rest = input
        .get(since(read, state.total_in())..)
        .unwrap_or_default();
    let produced = since(written, state.total_out());
    Ok((rest, produced, status == Status::StreamEnd))
}

/// The end of a member: checksum and length modulo 2^32 of its content.
fn trailer(content: &[u8]) -> [u8; TRAILER] {
    let mut crc = Crc::new();
    crc.update(content);
    let length = (content.len() as u64) & u64::from(u32::MAX);
    (u64::from(crc.sum()) | length << 32).to_le_bytes()
}

/// What follows the header of a member, with the optional fields that some compressors write.
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
