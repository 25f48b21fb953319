//! Finds the bytes of a JSON string that need attention.

/// Block size for long strings, in bytes.
const BLOCK: usize = 64;

/// Returns `true` if a byte ends a string, starts an escape or is not allowed in a string.
#[inline]
const fn is_special(byte: u8) -> bool {
    byte < 0x20 || byte == b'"' || byte == b'\\'
}

/// Returns the number of bytes before the first quote, backslash or control character.
#[inline]
pub(super) fn plain_run(bytes: &[u8]) -> usize {
    let mut run = 0;
    // Short strings end within the first words.
    for word in bytes.as_chunks::<8>().0.iter().take(BLOCK / 8) {
        let found = specials(u64::from_le_bytes(*word));
        if found != 0 {
            return run + (found.trailing_zeros() / 8) as usize;
        }
        run += 8;
    }
    run + plain_run_from(bytes.get(run..).unwrap_or_default())
}

/// Continues [`plain_run`] with blocks, which the compiler vectorizes, and then with single bytes.
fn plain_run_from(bytes: &[u8]) -> usize {
    let mut run = 0;
    for block in bytes.as_chunks::<BLOCK>().0 {
        let found = block
            .iter()
            .fold(0, |found, &byte| found | u8::from(is_special(byte)));
        if found != 0 {
            break;
        }
        run += BLOCK;
    }
    let rest = bytes.get(run..).unwrap_or_default();
    run + rest
        .iter()
        .position(|&byte| is_special(byte))
        .unwrap_or(rest.len())
}

/// Returns a word with the high bit set for each special byte. Only the lowest set bit is reliable, because a borrow
/// may set higher ones.
#[inline]
const fn specials(word: u64) -> u64 {
    const ONES: u64 = u64::from_ne_bytes([1; 8]);
    const HIGH: u64 = ONES << 7;
    const fn zeros(word: u64) -> u64 {
        word.wrapping_sub(ONES) & !word
    }
    let quote = zeros(word ^ (ONES * b'"' as u64));
    let backslash = zeros(word ^ (ONES * b'\\' as u64));
    let control = word.wrapping_sub(ONES * 0x20) & !word;
    (quote | backslash | control) & HIGH
}

#[cfg(test)]
mod tests {
    use super::plain_run;

    #[fc_test::test]
    fn first_special_byte_is_found_at_each_position() {
        for special in [b'"', b'\\', 0, b'\n', 0x1F] {
            for length in 0..200 {
                let mut bytes = vec![b'a'; length];
                assert_eq!(plain_run(&bytes), length);
                bytes.push(special);
                bytes.extend_from_slice(&[b'"', 0xE4, b'x']);
                assert_eq!(plain_run(&bytes), length);
            }
        }
    }

    #[fc_test::test]
    fn every_byte_is_told_apart() {
        for byte in 0..=u8::MAX {
            for length in [1, 8, 9, 64, 65, 200] {
                let plain = byte >= 0x20 && byte != b'"' && byte != b'\\';
                let expected = if plain { length } else { 0 };
                assert_eq!(plain_run(&vec![byte; length]), expected, "{byte:#x}");
            }
        }
    }
}
