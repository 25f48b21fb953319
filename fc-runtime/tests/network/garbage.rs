//! Bytes that are not frames, or frames with false claims.

use super::common::{LIMITS, Toy, ToyHeader, command, frame, report};
use super::random::Random;
use fc_runtime::{FrameId, Header, Protocol};

/// An unused code.
const CODE: u16 = 0x0EEE;

/// Garbage between two frames.
pub struct Garbage {
    pub what: &'static str,
    pub bytes: Vec<u8>,
    /// The position of the next frame is still known.
    pub in_sync: bool,
}

/// A request whose header says `total` and `plain` for its lengths.
fn claims(id: FrameId, encoding: u8, total: u32, plain: u32) -> Vec<u8> {
    let mut bytes = frame(id, b"{}");
    let mut header = ToyHeader::read(&bytes).expect("a header");
    header.encoding = encoding;
    header.seal(total, plain, header.digest());
    header.write(&mut bytes);
    bytes
}

/// Garbage of some kind, on its way to a robot (`up`) or to an app.
pub fn some(random: &mut Random, up: bool) -> Garbage {
    // No call and no report has an id like this.
    let id = 1_600_000_000 + random.below(1000) as u32;
    let id = if up {
        command(CODE, id)
    } else {
        report(CODE, id)
    };
    let (what, bytes) = match random.below(6) {
        0 => {
            let length = 1 + random.below(200);
            (
                "random bytes",
                (0..length).map(|_| random.next() as u8).collect(),
            )
        }
        1 => {
            let mut bytes = frame(id, b"{}");
            bytes[1] = b'#';
            ("a wrong head", bytes)
        }
        2 => {
            let total = random.below(ToyHeader::LEN) as u32;
            (
                "a length below that of a header",
                claims(id, Toy::PLAIN, total, 2),
            )
        }
        3 => {
            let total = random.pick(&[u32::MAX, LIMITS.frame_bytes + 1]);
            (
                "a length beyond the limit",
                claims(id, Toy::PLAIN, total, 2),
            )
        }
        4 => {
            let plain = LIMITS.frame_bytes - ToyHeader::LEN as u32;
            (
                "a length that never comes",
                claims(id, Toy::PLAIN, LIMITS.frame_bytes, plain),
            )
        }
        _ => {
            let total = ToyHeader::LEN as u32 + 2;
            let bytes = claims(id, Toy::GZIP.unwrap(), total, u32::MAX);
            return Garbage {
                what: "a plain length beyond the limit",
                bytes,
                in_sync: true,
            };
        }
    };
    Garbage {
        what,
        bytes,
        in_sync: false,
    }
}
