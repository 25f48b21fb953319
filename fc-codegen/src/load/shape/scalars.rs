//! Scalars that are not what they should be.

use super::{describe, wrong_kind};
use crate::diagnostic::{Diagnostic, FaultCode, Faults, nearest};
use crate::load::grammar::Kind;
use crate::load::{names, scalar};
use crate::syntax::{Node, Span, Style};

/// A plain scalar that other YAML readers take for something else; `true` if it was reported.
pub(super) fn check_spelling(node: Node<'_>, faults: &mut Faults) -> bool {
    let Some(text) = node.as_plain() else {
        return false;
    };
    if scalar::is_ambiguous(text) {
        faults.push(
            Diagnostic::error(
                FaultCode::AmbiguousWord,
                node.span(),
                format!("some YAML parsers read an unquoted `{text}` as a boolean"),
            )
            .fix(node.span(), format!("\"{text}\""), "quote it"),
        );
        return true;
    }
    if scalar::has_leading_zero(text) {
        let digits = text.trim_start_matches('0');
        let digits = if digits.is_empty() { "0" } else { digits };
        faults.push(
            Diagnostic::error(
                FaultCode::LeadingZero,
                node.span(),
                format!("some YAML parsers read `{text}` as octal"),
            )
            .fix(node.span(), digits, "remove the zeros if it is a number")
            .fix(node.span(), format!("\"{text}\""), "quote it if it is text"),
        );
        return true;
    }
    false
}

/// Reports what is wrong with a value that should be one scalar.
pub(super) fn check_scalar(kind: &Kind, node: Node<'_>, at: Span, faults: &mut Faults) {
    let Some(scalar) = node.as_scalar() else {
        wrong_kind(&describe(kind), node, at, faults);
        return;
    };
    let text = scalar.text;
    let span = node.span();
    if matches!(kind, Kind::Bool) {
        if scalar::bool(node).is_none() {
            faults.push(bad_bool(text, span));
        }
        return;
    }
    if check_spelling(node, faults) {
        return;
    }
    let error = |code, message: String| Diagnostic::error(code, span, message);
    let fault = match kind {
        Kind::Text => check_text(node),
        Kind::Int { min, max } => check_int(node, *min, *max),
        Kind::Number => scalar::number(node)
            .is_none()
            .then(|| error(FaultCode::BadNumber, format!("`{text}` is not a number"))),
        Kind::Code => scalar::code(node)
            .is_none()
            .then(|| bad_code(text, scalar.style, span)),
        Kind::Date => scalar::date(text).is_none().then(|| {
            error(FaultCode::BadDate, format!("`{text}` is not a date"))
                .note("dates are written 2024-01 or 2024-01-31")
        }),
        Kind::Name => (!names::is_snake(text)).then(|| bad_name(text, span)),
        Kind::TypeName => (!names::is_pascal(text)).then(|| bad_type_name(text, span)),
        Kind::ConflictId => (!scalar::is_conflict_id(text)).then(|| {
            error(
                FaultCode::BadConflictId,
                format!("`{text}` is not the id of a conflict"),
            )
            .note("ids are written C and three digits, such as C040")
        }),
        Kind::Word(words) => {
            (!words.iter().any(|(word, _)| *word == text)).then(|| bad_word(text, words, span))
        }
        _ => None,
    };
    faults.extend(fault);
}

/// A text that other readers would take for a number or truth value.
fn check_text(node: Node<'_>) -> Option<Diagnostic> {
    let text = node.as_plain()?;
    let taken_for = match (scalar::bool(node), scalar::number(node)) {
        (Some(_), _) => "truth value",
        (_, Some(_)) => "number",
        _ => return None,
    };
    let message = format!("expected a text, found a {taken_for}");
    Some(
        Diagnostic::error(FaultCode::WrongKind, node.span(), message).fix(
            node.span(),
            format!("\"{text}\""),
            "quote it",
        ),
    )
}

fn check_int(node: Node<'_>, min: i128, max: i128) -> Option<Diagnostic> {
    let text = node.as_str().unwrap_or_default();
    match scalar::int(node) {
        None => {
            let fault = Diagnostic::error(
                FaultCode::BadInteger,
                node.span(),
                format!("`{text}` is not an integer"),
            );
            Some(match (node.as_plain(), scalar::int_text(text)) {
                (None, Some(_)) => fault.fix(node.span(), text, "remove the quotes"),
                _ => fault,
            })
        }
        Some(value) if value < min || value > max => Some(Diagnostic::error(
            FaultCode::IntegerRange,
            node.span(),
            format!("{value} is outside {min}..={max}"),
        )),
        Some(_) => None,
    }
}

fn bad_bool(text: &str, span: Span) -> Diagnostic {
    let fault = Diagnostic::error(
        FaultCode::BadBool,
        span,
        format!("expected `true` or `false`, found `{text}`"),
    );
    match text.to_ascii_lowercase().as_str() {
        "on" | "yes" | "y" | "1" | "true" => fault.fix(span, "true", "write `true`"),
        "off" | "no" | "n" | "0" | "false" => fault.fix(span, "false", "write `false`"),
        _ => fault,
    }
}

fn bad_code(text: &str, style: Style, span: Span) -> Diagnostic {
    let fault = Diagnostic::error(
        FaultCode::BadCode,
        span,
        format!("`{text}` is not a valid code"),
    );
    let digits = text
        .strip_prefix("0x")
        .or_else(|| text.strip_prefix("0X"))
        .and_then(|digits| u16::from_str_radix(digits, 16).ok())
        .or_else(|| text.parse().ok());
    match digits {
        Some(code) if style == Style::Plain => {
            let spelling = format!("0x{code:04X}");
            let message = format!("write `{spelling}`");
            fault.fix(span, spelling, message)
        }
        Some(code) => fault.fix(span, format!("0x{code:04X}"), "remove the quotes"),
        None => fault.note("a code is `0x` and four upper-case hex digits, such as 0x0A01"),
    }
}

fn bad_name(text: &str, span: Span) -> Diagnostic {
    let fault = Diagnostic::error(
        FaultCode::BadName,
        span,
        format!("`{text}` is not a snake_case name"),
    );
    let better = names::snake(text);
    if names::is_snake(&better) {
        let message = format!("write `{better}`");
        fault.fix(span, better, message)
    } else {
        fault.note("a name consists of lower-case letters and digits in parts joined by `_`, and starts with a letter")
    }
}

fn bad_type_name(text: &str, span: Span) -> Diagnostic {
    let fault = Diagnostic::error(
        FaultCode::BadTypeName,
        span,
        format!("`{text}` is not a PascalCase name"),
    );
    let better = names::pascal(&names::snake(text));
    if names::is_pascal(&better) {
        let message = format!("write `{better}`");
        fault.fix(span, better, message)
    } else {
        fault
            .note("a type name consists of letters and digits and starts with an upper-case letter")
    }
}

fn bad_word(text: &str, words: &[(&'static str, &'static str)], span: Span) -> Diagnostic {
    let fault = Diagnostic::error(
        FaultCode::BadWord,
        span,
        format!("`{text}` is not allowed here"),
    );
    match nearest(text, words.iter().map(|(word, _)| *word)) {
        Some(near) => fault.fix(span, near, format!("did you mean `{near}`?")),
        None => fault.note(format!("expected one of {}", list_words(words))),
    }
}

/// Words as a sentence lists them.
pub(super) fn list_words(words: &[(&'static str, &'static str)]) -> String {
    let quoted: Vec<_> = words.iter().map(|(word, _)| format!("`{word}`")).collect();
    quoted.join(", ")
}
