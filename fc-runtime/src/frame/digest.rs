//! The digest over a frame's data area, in one place so that its crate can be exchanged.

/// MD5 of `data`: a checksum against damage on the way, not against anybody's intent.
#[must_use]
pub fn digest(data: &[u8]) -> [u8; 16] {
    fast_md5::digest(data)
}

/// The same, piece by piece.
#[cfg(feature = "server")]
pub(crate) struct Digesting(fast_md5::Md5);

#[cfg(feature = "server")]
impl Digesting {
    pub(crate) fn new() -> Self {
        Self(fast_md5::Md5::new())
    }

    pub(crate) fn update(&mut self, piece: &[u8]) {
        self.0.update(piece);
    }

    pub(crate) fn finish(self) -> [u8; 16] {
        self.0.finalize()
    }
}

#[cfg(test)]
mod tests {
    use super::digest;
    use md5::{Digest, Md5};

    #[fc_test::test]
    fn agrees_with_another_implementation_at_every_length_around_block_ends() {
        let data: Vec<u8> = (0..300_u16).map(|n| n.to_le_bytes()[0]).collect();
        for length in 0..data.len() {
            let (data, _) = data.split_at(length);
            let expected: [u8; 16] = Md5::digest(data).into();
            assert_eq!(digest(data), expected, "of {length} bytes");
        }
    }
}
