//! Checks scalars.

use super::expected::{describe, list_words, wrong_kind};
use crate::diagnostic::{Diagnostic, FaultCode, Faults, nearest};
use crate::language::ambiguous_scalar::{agreed_number, misread};
use crate::language::grammar::unit::{self, UNITS};
use crate::language::grammar::{FIELD, Kind};
use crate::language::scalar;
use crate::model::Type;
use crate::names;
use crate::source::Span;
use crate::syntax::width::{self, half_width, half_width_text};
use crate::syntax::{Node, Style, quoted};
use crate::text;
use crate::vocabulary::Meaning;

/// The kind that a value most likely has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Wanted {
    Text,
    Number,
    Either,
}

impl Wanted {
    /// Returns the kind for the `type` of the field that holds the value.
    pub(super) fn of(field: Node<'_>) -> Self {
        let ty = FIELD.r#type.read(field);
        let Some((mut ty, _)) = ty.filter(|_| FIELD.wire.of(field).is_none()) else {
            return Self::Either;
        };
        while let Type::Array(item) = ty {
            ty = *item;
        }
        match ty {
            Type::String | Type::Base64 => Self::Text,
            Type::Int(_) | Type::Float(_) | Type::TimestampMs | Type::TimestampS => Self::Number,
            _ => Self::Either,
        }
    }
}

/// Reports a scalar that other YAML readers interpret differently, or that is cut off by a comment.
pub(super) fn check_spelling(node: Node<'_>, wanted: Wanted, faults: &mut Faults) {
    let Some(text) = node.as_plain() else {
        return;
    };
    if scalar::has_leading_zero(text) {
        faults.push(leading_zero(text, node.span(), wanted));
        return;
    }
    if let Some(fault) = misread_fault(node, text, wanted) {
        faults.push(fault);
        return;
    }
    if scalar::bool(node).is_none() && scalar::number(node).is_none() {
        let quotes = text.starts_with(['“', '‘', '＂']).then(|| node.slip());
        let is_whole = |slip: &Diagnostic| slip.primary.span.start == node.span().start;
        faults.extend(quotes.flatten().filter(is_whole));
        faults.extend(node.cut_off());
    }
}

fn misread_fault(node: Node<'_>, text: &str, wanted: Wanted) -> Option<Diagnostic> {
    let other = misread(text)?;
    let span = node.span();
    let message = text!(
        "不加引号的 `{text}` 会被有的 YAML 解析器当成{other}",
        "some YAML parsers read an unquoted `{text}` as {other}",
        other = other
    );
    let fault = Diagnostic::error(FaultCode::AmbiguousWord, span, message);
    let number = match wanted {
        Wanted::Number => agreed_number(text).or_else(|| number_of(text)),
        Wanted::Either => agreed_number(text),
        Wanted::Text => None,
    };
    Some(match number {
        Some(number) => {
            let message = text!(
                "改写为 `{number}`，所有解析器都当成数值",
                "write `{number}`, which all of them read as a number"
            );
            fault.fix(span, number, message)
        }
        None if wanted == Wanted::Number => fault.note(text!(
            "把数值写成十进制或 `0x…`",
            "write the number in decimal or as `0x…`"
        )),
        None => fault.quote(text),
    })
}

fn leading_zero(text: &str, span: Span, wanted: Wanted) -> Diagnostic {
    let digits = text.trim_start_matches(['0', '-', '+']);
    let digits = if digits.is_empty() { "0" } else { digits };
    let sign = if text.starts_with('-') { "-" } else { "" };
    let number = format!("{sign}{digits}");
    let message = text!(
        "有的 YAML 解析器把 `{text}` 当成八进制",
        "some YAML parsers read `{text}` as octal"
    );
    let fault = Diagnostic::error(FaultCode::LeadingZero, span, message);
    match wanted {
        Wanted::Number => fault.fix(span, number, text!("去掉前导零", "remove the zeros")),
        Wanted::Text => fault.quote(text),
        Wanted::Either => {
            let bare = text!(
                "如果是数值，去掉前导零",
                "remove the zeros if it is a number"
            );
            let in_quotes = text!("如果是文本，加上引号", "quote it if it is text");
            let fault = fault.fix(span, number, bare);
            fault.fix(span, quoted(text), in_quotes)
        }
    }
}

/// Reports errors in a value that must be one scalar.
pub(super) fn check_scalar(kind: &Kind, node: Node<'_>, at: Span, faults: &mut Faults) {
    let Some(scalar) = node.as_scalar() else {
        wrong_kind(&describe(kind), node, at, faults);
        return;
    };
    let wanted = match kind {
        Kind::Int { .. } | Kind::Number => Wanted::Number,
        Kind::Scalar => Wanted::Either,
        _ => Wanted::Text,
    };
    let may_be_misread = !matches!(kind, Kind::Code | Kind::Date | Kind::Bool);
    if may_be_misread && node.as_plain().is_some_and(scalar::has_leading_zero) {
        faults.push(leading_zero(scalar.text, node.span(), wanted));
        return;
    }
    // Quotes do not fix a value of the wrong kind.
    let Some(fault) = check_form(kind, node, scalar.text, scalar.style) else {
        match kind {
            Kind::Date | Kind::Code | Kind::Bool => {}
            Kind::Text | Kind::Scalar | Kind::Number => check_spelling(node, wanted, faults),
            _ => {
                let text = node.as_plain();
                faults.extend(text.and_then(|text| misread_fault(node, text, wanted)));
            }
        }
        return;
    };
    faults.push(match kind {
        Kind::Text | Kind::Scalar => fault,
        _ => full_width(node, scalar.text).unwrap_or(fault),
    });
}

/// Returns the error for a value with full-width characters from a Chinese input method.
fn full_width(node: Node<'_>, text: &str) -> Option<Diagnostic> {
    node.as_plain()?;
    let character = text.chars().find(|c| half_width(*c).is_some())?;
    let message = text!(
        "应为 ASCII 字符，实际为{character}",
        "expected ASCII, found {character}",
        character = width::describe(character)
    );
    let fault = Diagnostic::error(FaultCode::FullWidth, node.span(), message);
    let wanted = half_width_text(text);
    let wanted = wanted.trim_end_matches(['.', ',', ';']);
    // These units need quotes.
    let wanted = match wanted {
        "%" | "N" => quoted(wanted),
        _ => wanted.to_owned(),
    };
    Some(fault.fix(
        node.span(),
        wanted,
        text!("改为半角", "write it in half-width"),
    ))
}

/// Returns the error for a scalar that is not a value of its kind.
fn check_form(kind: &Kind, node: Node<'_>, text: &str, style: Style) -> Option<Diagnostic> {
    let span = node.span();
    match kind {
        Kind::Bool => scalar::bool(node)
            .is_none()
            .then(|| bad_bool(text, style, span)),
        Kind::Text => check_text(node),
        Kind::Int { min, max } => check_int(node, *min, *max),
        Kind::Number => scalar::number(node)
            .is_none()
            .then(|| bad_number(text, span)),
        Kind::Code => scalar::code(node)
            .is_none()
            .then(|| bad_code(text, style, span)),
        Kind::Date => names::date(text).is_none().then(|| bad_date(text, span)),
        Kind::Name => (!names::is_snake(text)).then(|| bad_name(text, span)),
        Kind::TypeName => (!names::is_pascal(text)).then(|| bad_type_name(text, span)),
        Kind::ConflictId => (!names::is_conflict_id(text)).then(|| {
            let message = text!(
                "`{text}` 不是疑问的编号",
                "`{text}` is not the id of a conflict"
            );
            Diagnostic::error(FaultCode::BadConflictId, span, message).note(text!(
                "写 C 和至少三位数字，例如 C040",
                "write C and at least three digits, such as C040"
            ))
        }),
        Kind::MediaType => (!names::is_media_type(text)).then(|| {
            let message = text!("`{text}` 不是媒体类型", "`{text}` is not a media type");
            Diagnostic::error(FaultCode::BadMediaType, span, message).note(text!(
                "写成小写的 `type/subtype`，例如 `image/png`",
                "write `type/subtype` in lower case, such as `image/png`"
            ))
        }),
        Kind::Unit => (!UNITS.iter().any(|(unit, ..)| *unit == text)).then(|| bad_unit(text, span)),
        Kind::Word(words) => {
            let is_known = kind.word(text).is_some();
            (!is_known).then(|| bad_word(text, words, span))
        }
        _ => None,
    }
}

fn bad_unit(text: &str, span: Span) -> Diagnostic {
    let message = text!("没有单位 `{text}`", "there is no unit `{text}`");
    let fault = Diagnostic::error(FaultCode::UnknownUnit, span, message);
    let units = UNITS.iter().map(|(unit, ..)| *unit);
    match unit::meant(text).or_else(|| nearest(text, units.filter(|unit| unit.len() > 1))) {
        Some(near) if near == "%" || near == "N" => fault.fix(
            span,
            quoted(near),
            text!("是否想写 `{near}`？", "did you mean `{near}`?"),
        ),
        near => {
            let note = text!(
                "单位有：{units}",
                "the units are {units}",
                units = list_words(UNITS)
            );
            fault.suggest(near, Some(note))
        }
    }
}

/// Returns the error for a number, with a fix if it is a number in another language.
fn bad_number(text: &str, span: Span) -> Diagnostic {
    let message = text!("`{text}` 不是数值", "`{text}` is not a number");
    let fault = Diagnostic::error(FaultCode::BadNumber, span, message);
    match number_of(text) {
        Some(number) => fault.write(number),
        None => fault,
    }
}

/// Returns the plain form of numbers such as `1_000`, `+5`, `.5` and `5.`.
fn number_of(text: &str) -> Option<String> {
    let plain = text.trim().replace('_', "");
    let unsigned = plain.trim_start_matches(['+', '-']);
    let sign = if plain.starts_with('-') { "-" } else { "" };
    let whole = if unsigned.starts_with('.') { "0" } else { "" };
    let fraction = if unsigned.ends_with('.') { "0" } else { "" };
    let number = format!("{sign}{whole}{unsigned}{fraction}");
    let is_agreed = misread(&number).is_none() && scalar::number_text(&number).is_some();
    (is_agreed && number != text).then_some(number)
}

/// Returns the error for a text that other readers could take for a number or boolean.
fn check_text(node: Node<'_>) -> Option<Diagnostic> {
    let text = node.as_plain()?;
    let taken_for = match (scalar::bool(node), scalar::number(node)) {
        (Some(_), _) => text!("布尔值", "boolean"),
        (_, Some(_)) => text!("数值", "number"),
        _ => return None,
    };
    let message = text!(
        "应为文本，实际为{taken_for}",
        "expected a text, found a {taken_for}",
        taken_for = taken_for
    );
    Some(Diagnostic::error(FaultCode::WrongKind, node.span(), message).quote(text))
}

fn check_int(node: Node<'_>, min: i128, max: i128) -> Option<Diagnostic> {
    let text = node.as_str().unwrap_or_default();
    match scalar::int(node) {
        None => {
            let message = text!("`{text}` 不是整数", "`{text}` is not an integer");
            let fault = Diagnostic::error(FaultCode::BadInteger, node.span(), message);
            let better = number_of(text).filter(|number| scalar::int_text(number).is_some());
            Some(match better {
                _ if node.as_plain().is_none() && scalar::int_text(text).is_some() => {
                    fault.unquote(text)
                }
                Some(number) => fault.write(number),
                None => fault,
            })
        }
        Some(value) if (min..=max).contains(&value) => None,
        Some(value) => {
            let message = text!(
                "{value} 不在 {min}..={max} 之内",
                "{value} is outside {min}..={max}"
            );
            let code = FaultCode::IntegerRange;
            Some(Diagnostic::error(code, node.span(), message))
        }
    }
}

fn bad_bool(text: &str, style: Style, span: Span) -> Diagnostic {
    let message = match style {
        Style::Plain => text!(
            "应为 `true` 或 `false`，实际为 `{text}`",
            "expected `true` or `false`, found `{text}`"
        ),
        Style::Quoted | Style::Block => text!(
            "应为 `true` 或 `false`，实际为文本 \"{text}\"",
            "expected `true` or `false`, found the text \"{text}\""
        ),
    };
    let fault = Diagnostic::error(FaultCode::BadBool, span, message);
    if style == Style::Quoted && matches!(text, "true" | "false") {
        return fault.unquote(text);
    }
    match text.to_ascii_lowercase().as_str() {
        "on" | "yes" | "y" | "1" | "true" => fault.write("true"),
        "off" | "no" | "n" | "0" | "false" => fault.write("false"),
        _ => fault,
    }
}

/// Returns the error for a date, with a fix if it has another common format.
fn bad_date(text: &str, span: Span) -> Diagnostic {
    let message = text!("`{text}` 不是日期", "`{text}` is not a date");
    let fault = Diagnostic::error(FaultCode::BadDate, span, message);
    let parts = text.trim().split(['-', '/', '.']);
    let parts: Vec<_> = parts.map(|part| format!("{part:0>2}")).collect();
    let date = parts.join("-");
    match names::date(&date) {
        Some(_) => fault.write(date),
        None => fault.note(text!(
            "日期写成 2024-01 或 2024-01-31",
            "dates are written 2024-01 or 2024-01-31"
        )),
    }
}

fn bad_code(text: &str, style: Style, span: Span) -> Diagnostic {
    let message = text!("`{text}` 不是功能码", "`{text}` is not a valid code");
    let fault = Diagnostic::error(FaultCode::BadCode, span, message);
    let digits = text
        .strip_prefix("0x")
        .or_else(|| text.strip_prefix("0X"))
        .or(Some(text).filter(|text| scalar::has_leading_zero(text)))
        .and_then(|digits| u16::from_str_radix(digits, 16).ok())
        .or_else(|| text.parse().ok());
    match digits.map(|code| format!("0x{code:04X}")) {
        Some(spelling) if style == Style::Plain => fault.write(spelling),
        Some(spelling) => fault.unquote(spelling),
        None => fault.note(text!(
            "功能码是 `0x` 加四位大写十六进制数字，例如 0x0A01",
            "a code is `0x` and four upper-case hex digits, such as 0x0A01"
        )),
    }
}

fn bad_name(text: &str, span: Span) -> Diagnostic {
    let message = text!(
        "`{text}` 不是 snake_case 名称",
        "`{text}` is not a snake_case name"
    );
    let fault = Diagnostic::error(FaultCode::BadName, span, message);
    let better = names::snake(text);
    if names::is_snake(&better) {
        fault.write(better)
    } else {
        fault.note(text!("名称由小写字母和数字组成，各段以 `_` 连接，以字母开头", "a name consists of lower-case letters and digits in parts joined by `_`, and starts with a letter"))
    }
}

fn bad_type_name(text: &str, span: Span) -> Diagnostic {
    let message = text!(
        "`{text}` 不是 PascalCase 名称",
        "`{text}` is not a PascalCase name"
    );
    let fault = Diagnostic::error(FaultCode::BadTypeName, span, message);
    let better = names::pascal(&names::snake(text));
    if names::is_pascal(&better) {
        fault.write(better)
    } else {
        fault.note(text!(
            "类型名由字母和数字组成，以大写字母开头",
            "a type name consists of letters and digits and starts with an upper-case letter"
        ))
    }
}

fn bad_word(text: &str, words: &[Meaning], span: Span) -> Diagnostic {
    let message = text!("这里不能写 `{text}`", "`{text}` is not allowed here");
    let fault = Diagnostic::error(FaultCode::BadWord, span, message);
    let near = nearest(text, words.iter().map(|(word, ..)| *word));
    let note = text!(
        "可以写：{words}",
        "expected one of {words}",
        words = list_words(words)
    );
    fault.suggest(near, Some(note))
}
