//! Invisible characters.

use crate::diagnostic::{Diagnostic, FaultCode, Faults};
use crate::model::Text;
use crate::source::{FileId, Span};
use crate::text;

/// Reports every invisible character that changes the meaning of a file. These are control characters, line ends that
/// editors treat differently, and marks that change the direction of text.
pub(super) fn check(file: FileId, text: &str, faults: &mut Faults) {
    let mut from = 0;
    while let Some(found) = text.as_bytes().get(from..).and_then(suspect) {
        let at = from + found;
        from = at + 1;
        let mut characters = text.get(at..).unwrap_or_default().chars();
        let Some(character) = characters.next() else {
            continue;
        };
        if let Some(name) = name(character, characters.next()) {
            let span = Span::new(file, at, at + character.len_utf8());
            let code_point = u32::from(character);
            faults.push(
                Diagnostic::error(FaultCode::ControlCharacter, span, name)
                    .label(text!(
                        "这里是 U+{code_point:04X}",
                        "U+{code_point:04X} here"
                    ))
                    .fix(span, "", text!("删除它", "delete it")),
            );
        }
    }
}

/// Returns the position of the first byte that can start a character with a [`name`].
fn suspect(bytes: &[u8]) -> Option<usize> {
    let begins = |byte: &u8| {
        matches!(
            byte,
            0..=8 | 0x0B..=0x1F | 0x7F | 0xC2 | 0xD8 | 0xE2 | 0xEF
        )
    };
    bytes.iter().position(begins)
}

/// Returns a text without the characters that [`check`] reports.
pub(crate) fn visible(text: &str) -> String {
    let characters = text.chars();
    characters
        .filter(|character| name(*character, None).is_none())
        .collect()
}

/// Returns `true` if [`check`] has reported the character at byte `at` or the one before it.
pub(super) fn faulted(text: &str, at: usize) -> bool {
    let Some((before, behind)) = text.split_at_checked(at) else {
        return false;
    };
    let mut behind = behind.chars();
    let (here, next) = (behind.next(), behind.next());
    before
        .chars()
        .next_back()
        .is_some_and(|last| name(last, here).is_some())
        || here.is_some_and(|here| name(here, next).is_some())
}

fn name(character: char, next: Option<char>) -> Option<Text> {
    match character {
        '\t' | '\n' => None,
        '\r' if next == Some('\n') => None,
        '\r' => Some(text!("一行之中的回车符", "a carriage return inside a line")),
        '\0'..='\u{1f}' | '\u{7f}'..='\u{9f}' => Some(text!("控制字符", "a control character")),
        '\u{2028}' | '\u{2029}' => Some(text!("Unicode 行分隔符", "a Unicode line separator")),
        '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}' | '\u{200e}' | '\u{200f}' | '\u{61c}' => {
            Some(text!(
                "改变文字方向的标记",
                "a mark that changes the direction of text"
            ))
        }
        '\u{200b}' | '\u{2060}' => Some(text!("零宽空格", "a zero-width space")),
        '\u{fffe}' | '\u{ffff}' => Some(text!(
            "不是字符的码位",
            "a code point that is not a character"
        )),
        '\u{feff}' => Some(text!(
            "不在文件开头的字节序标记",
            "a byte order mark that is not at the start of the file"
        )),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_character_with_a_name_is_suspect() {
        for character in '\0'..=char::MAX {
            let mut bytes = [0; 4];
            let bytes = character.encode_utf8(&mut bytes).as_bytes();
            if name(character, None).is_some() {
                assert_eq!(suspect(bytes), Some(0), "{character:?}");
            }
        }
    }
}
