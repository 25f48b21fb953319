//! Checks texts and their language, wherever a mapping has them.

use crate::diagnostic::{Diagnostic, FaultCode, Faults};
use crate::language::ambiguous_scalar::misread;
use crate::language::grammar::TEXT;
use crate::names;
use crate::syntax::{Node, Style, quoted};
use crate::text;

/// Prefix of Chinese placeholder texts in a new operation.
pub(crate) const TO_BE_WRITTEN_ZH: &str = "（待写";
/// Prefix of English placeholder texts.
pub(crate) const TO_BE_WRITTEN_EN: &str = "(to be written";

/// Reports errors in `zh` and `en` of a mapping, which are texts or lists of words.
pub(super) fn check(node: Node<'_>, faults: &mut Faults) {
    for word in [TEXT.zh, TEXT.en]
        .into_iter()
        .flat_map(|key| key.items(node))
    {
        check_text(word, faults);
    }
    let [zh, en] =
        [TEXT.zh, TEXT.en].map(|key| key.of(node).filter(|text| text.as_scalar().is_some()));
    let [zh_sound, en_sound] =
        [zh, en].map(|text| text.is_some_and(|text| check_text(text, faults)));
    let (Some(zh), Some(en)) = (zh.filter(|_| zh_sound), en.filter(|_| en_sound)) else {
        return;
    };
    let [zh_text, en_text] = [zh, en].map(|node| node.as_str().unwrap_or_default());
    let to_be_written = [(zh, TO_BE_WRITTEN_ZH), (en, TO_BE_WRITTEN_EN)];
    let mut to_be_written = to_be_written.into_iter().filter(|(node, beginning)| {
        node.as_str()
            .is_some_and(|text| text.starts_with(beginning))
    });
    if let Some((first, _)) = to_be_written.next() {
        let message = text!("这段文本是占位文本", "this text is a placeholder");
        let fault = Diagnostic::warning(FaultCode::Placeholder, first.span(), message);
        let fault = to_be_written.fold(fault, |fault, (node, _)| {
            fault.also(node.span(), text!("这段也是", "this one as well"))
        });
        faults.push(fault.note(text!(
            "写上真正的文本：文档会显示占位文本",
            "replace it: the documentation shows placeholders"
        )));
        return;
    }
    if zh_text == en_text {
        let message = text!(
            "英文与中文相同",
            "the English text is the same as the Chinese one"
        );
        let fault = Diagnostic::error(FaultCode::SameText, en.span(), message);
        faults.push(fault.also(zh.span(), text!("相同的文本", "the same text")));
    } else if has_chinese(en_text) && !has_latin(en_text) {
        let message = text!("英文中没有英文", "the English text is not English");
        faults.push(Diagnostic::error(FaultCode::NotEnglish, en.span(), message));
    } else if !has_chinese(zh_text) && has_latin(zh_text) {
        let message = text!("中文中没有汉字", "the Chinese text contains no Chinese");
        faults.push(Diagnostic::warning(
            FaultCode::NotChinese,
            zh.span(),
            message,
        ));
    }
}

/// Reports an empty text, invisible characters and white space around the text. Returns `false` if further checks
/// cannot use the text.
fn check_text(node: Node<'_>, faults: &mut Faults) -> bool {
    let Some(scalar) = node.as_scalar() else {
        return false;
    };
    let text = match scalar.style {
        Style::Block => scalar.text.strip_suffix('\n').unwrap_or(scalar.text),
        Style::Plain | Style::Quoted => scalar.text,
    };
    if text.trim().is_empty() {
        let message = text!("文本为空", "the text is empty");
        let fault = Diagnostic::error(FaultCode::EmptyText, node.span(), message);
        faults.push(fault);
        return false;
    }
    // The shape check reports an ambiguous spelling.
    if node.as_plain().is_some_and(|text| misread(text).is_some()) {
        return false;
    }
    if let Some(hidden) = text.chars().find(|c| names::is_hidden(*c)) {
        let message = text!(
            "文本中有看不见的字符 U+{hidden}",
            "the text contains the invisible character U+{hidden}",
            hidden = format!("{:04X}", u32::from(hidden))
        );
        let fault = Diagnostic::error(FaultCode::HiddenCharacter, node.span(), message);
        faults.push(fault);
        return false;
    }
    if text.trim() != text {
        let message = text!(
            "文本的开头或结尾有空白",
            "the text starts or ends with white space"
        );
        let fault = Diagnostic::error(FaultCode::TextSpacing, node.span(), message);
        let is_simple = scalar.style == Style::Quoted && !text.contains('\n');
        faults.push(if is_simple {
            fault.fix(
                node.span(),
                quoted(text.trim()),
                text!("去掉它", "remove it"),
            )
        } else {
            fault
        });
    }
    true
}

pub(crate) fn has_chinese(text: &str) -> bool {
    text.chars().any(|c| matches!(c, '\u{3400}'..='\u{4DBF}' | '\u{4E00}'..='\u{9FFF}' | '\u{F900}'..='\u{FAFF}'))
}

fn has_latin(text: &str) -> bool {
    text.chars().any(|c| c.is_ascii_alphabetic())
}
