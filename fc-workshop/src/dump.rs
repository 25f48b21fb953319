//! Lines of hexadecimal dumps, as `xxd`, `hexdump -C` and `tcpdump -x` print them.

/// Returns the part of a line after its position, such as `00000010: ` or `0000   `, or `None` without a position.
pub(crate) fn positioned(line: &[u8]) -> Option<&[u8]> {
    let line = line.strip_prefix(b"0x").unwrap_or(line);
    let digits = line
        .iter()
        .take_while(|byte| byte.is_ascii_hexdigit())
        .count();
    let (position, rest) = line.split_at_checked(digits)?;
    let is_position = (4..=16).contains(&position.len());
    let has_colon = rest.starts_with(b":");
    let is_apart = [&b"  "[..], b"\t"].iter().any(|gap| rest.starts_with(gap));
    // `hexdump -C` ends with the length alone.
    let is_alone = rest.is_empty() && position.len() == 8 && position.starts_with(b"0000");
    if !is_position || !(has_colon || is_apart || is_alone) {
        return None;
    }
    Some(rest.strip_prefix(b":").unwrap_or(rest).trim_ascii_start())
}

/// Returns the digits of a line without its position and its characters.
pub(crate) fn columns(rest: &[u8]) -> &[u8] {
    let mut end = 0;
    let mut bytes = 0;
    let mut at = rest;
    loop {
        let digits = at
            .iter()
            .take_while(|byte| byte.is_ascii_hexdigit())
            .count();
        if digits == 0 || digits % 2 != 0 {
            break;
        }
        bytes += digits / 2;
        end += digits;
        at = at.get(digits..).unwrap_or_default();
        let gap = at.iter().take_while(|byte| **byte == b' ').count();
        // `hexdump -C` has a wider gap in the middle.
        let is_middle = gap == 2 && bytes == 8;
        if gap == 0 || gap > 1 && !is_middle {
            break;
        }
        end += gap;
        at = at.get(gap..).unwrap_or_default();
    }
    rest.get(..end).unwrap_or_default()
}
