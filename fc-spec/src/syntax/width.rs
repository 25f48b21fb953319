//! Characters that look like those of YAML.

use crate::model::Text;
use crate::text;

/// Returns the ASCII character for a character of a Chinese keyboard or a word processor.
pub(crate) fn half_width(character: char) -> Option<char> {
    Some(match character {
        '\u{ff01}'..='\u{ff5e}' => {
            char::from_u32(u32::from(character).checked_sub(0xFEE0)?).unwrap_or(character)
        }
        '\u{3000}' | '\u{a0}' => ' ',
        '“' | '”' | '„' => '"',
        '‘' | '’' => '\'',
        '【' => '[',
        '】' => ']',
        '、' => ',',
        '。' => '.',
        '–' | '—' | '−' => '-',
        _ => return None,
    })
}

/// Returns a text with all such characters replaced.
pub(crate) fn half_width_text(text: &str) -> String {
    let characters = text.chars();
    characters
        .map(|character| half_width(character).unwrap_or(character))
        .collect()
}

/// Returns a character with its name, for a message.
pub(crate) fn describe(character: char) -> Text {
    match character {
        '\u{3000}' => text!("全角空格（U+3000）", "a full-width space (U+3000)"),
        '\u{a0}' => text!("不换行空格（U+00A0）", "a no-break space (U+00A0)"),
        '“' | '”' | '„' | '‘' | '’' => text!(
            "排版引号 `{character}`",
            "a typographic quote `{character}`"
        ),
        '–' | '—' | '−' => text!("破折号 `{character}`", "a dash `{character}`"),
        _ => text!("全角字符 `{character}`", "a full-width `{character}`"),
    }
}
