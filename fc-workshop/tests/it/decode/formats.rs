//! Formats of the input.

use super::{error, lines, read, sampled};
use crate::support::small;
use fc_workshop::decode::Format;
use std::fmt::Write as _;

fn hex(bytes: &[u8], between: &str) -> String {
    let digits: Vec<_> = bytes.iter().map(|byte| format!("{byte:02x}")).collect();
    digits.join(between)
}

/// Returns a dump with a line per 16 bytes. `line` writes the position, the bytes and the characters of each.
fn dump(bytes: &[u8], line: impl Fn(usize, &[u8]) -> String) -> String {
    let mut text = String::new();
    for (number, bytes) in bytes.chunks(16).enumerate() {
        text += &line(number * 16, bytes);
        text.push('\n');
    }
    text
}

fn characters(bytes: &[u8]) -> String {
    let shown = |byte: &u8| match byte {
        b' '..=b'~' => char::from(*byte),
        _ => '.',
    };
    bytes.iter().map(shown).collect()
}

#[test]
fn every_format_of_text_is_detected() {
    let model = small();
    let frames = [sampled(&model, "dimmed", 7), sampled(&model, "dimmed", 8)].concat();
    let base64 = |url: bool| {
        use base64::Engine as _;
        use base64::engine::general_purpose::{STANDARD, URL_SAFE_NO_PAD};
        if url {
            URL_SAFE_NO_PAD.encode(&frames)
        } else {
            STANDARD.encode(&frames)
        }
    };
    let canonical = dump(&frames, |at, bytes| {
        let (left, right) = bytes.split_at(bytes.len().min(8));
        let digits = format!("{}  {}", hex(left, " "), hex(right, " "));
        format!("{at:08x}  {digits:<49} |{}|", characters(bytes))
    });
    let canonical = canonical + &format!("{:08x}\n", frames.len());
    let xxd = dump(&frames, |at, bytes| {
        let pairs: Vec<_> = bytes.chunks(2).map(|pair| hex(pair, "")).collect();
        format!("{at:08x}: {:<39}  {}", pairs.join(" "), characters(bytes))
    });
    let wireshark = dump(&frames, |at, bytes| {
        format!("{at:04x}   {:<47}   {}", hex(bytes, " "), characters(bytes))
    });
    let mut array = String::from("{ ");
    for byte in &frames {
        write!(array, "0x{byte:02X}, ").unwrap();
    }
    let escaped: String = frames
        .iter()
        .fold(String::new(), |text, byte| text + &format!("\\x{byte:02x}"));
    for (name, input) in [
        ("digits", hex(&frames, "")),
        ("digits in capitals", hex(&frames, "").to_uppercase()),
        ("digits with spaces", hex(&frames, " ")),
        ("digits with colons", hex(&frames, ":")),
        ("digits in lines", hex(&frames, "\r\n")),
        ("array", array + "}"),
        ("escapes", escaped),
        ("xxd", xxd),
        ("hexdump -C", canonical),
        ("wireshark", wireshark),
        ("base64", base64(false)),
        ("base64 for URLs", base64(true)),
    ] {
        let found = lines(&model, input.as_bytes(), None);
        let ids: Vec<_> = found.iter().map(|line| line["msg_id"].as_u64()).collect();
        assert_eq!(ids, [Some(7), Some(8)], "{name}: {input}\n{found:?}");
        assert!(
            found.iter().all(|line| error(line).is_empty()),
            "{name}: {found:?}"
        );
    }
    assert_eq!(lines(&model, &frames, None).len(), 2, "binary");
}

#[test]
fn wrong_text_is_named_with_its_line() {
    let model = small();
    let frame = hex(&sampled(&model, "dimmed", 7), " ");
    for (input, format, expected) in [
        (
            format!("{frame}\n12 zz"),
            Some(Format::Hex),
            "`z` in line 2",
        ),
        (format!("{frame}\n1"), None, "one hexadecimal digit"),
        (format!("{frame}\n*\n{frame}"), None, "hexdump -v"),
        ("TEE/?".to_owned(), Some(Format::Base64), "not base64"),
        ("TEE/".to_owned(), Some(Format::Capture), "not intact pcap"),
    ] {
        let (found, result) = read(&model, input.as_bytes(), format, &[]);
        let error = result.expect_err(&input).to_string();
        assert!(error.contains(expected), "{error}");
        // The frames before the error are shown.
        assert_eq!(
            found.first().is_some_and(|line| line["msg_id"] == 7),
            input.contains(&frame)
        );
    }
}
