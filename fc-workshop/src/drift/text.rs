//! Deviations as text for people.

use super::{Deviation, DeviationKind};
use crate::decode::{clipped, clock, error_text};
use fc_spec::model::{Direction, Lang};

/// Returns a deviation: a line with its kind, place and number, and a line with the first frame.
#[must_use]
pub fn deviation(deviation: &Deviation<'_>, lang: Lang) -> String {
    let place = &deviation.place;
    let name = place.kind.name();
    let mut title = format!("{name}: {}", meaning(place.kind, lang));
    if let Some((_, code)) = place.code {
        title += &format!("  0x{code:04X}");
    }
    if let Some(operation) = deviation.operation {
        title += &format!(" {}", operation.name);
    }
    title += match place.direction {
        Some(Direction::Request) => lang.pick(" 请求", " request"),
        Some(Direction::Response) => lang.pick(" 响应", " response"),
        None => "",
    };
    for part in [&place.path, &place.value] {
        if !part.is_empty() {
            title += &format!("  {part}");
        }
    }
    let mut first = Vec::new();
    first.push(match lang {
        Lang::Zh => format!("{} 次", deviation.count),
        Lang::En if deviation.count == 1 => "once".to_owned(),
        Lang::En => format!("{} times", deviation.count),
    });
    let time = deviation.time.map(clock).unwrap_or_default();
    let flow = deviation
        .flow
        .map(|flow| format!("{flow} "))
        .unwrap_or_default();
    let offset = deviation.offset;
    first.push(match lang {
        Lang::Zh => format!("首次：{flow}{time} 位置 {offset}"),
        Lang::En => format!("first: {flow}{time} at {offset}"),
    });
    let example = clipped(&deviation.example);
    if !example.is_empty() && example != place.value {
        first.push(match lang {
            Lang::Zh => format!("例如：{example}"),
            Lang::En => format!("found: {example}"),
        });
    }
    if !deviation.expected.is_empty() {
        first.push(match lang {
            Lang::Zh => format!("规范要求：{}", deviation.expected),
            Lang::En => format!("expected: {}", deviation.expected),
        });
    }
    let mut text = format!("{title}\n  {}", first.join(" · "));
    if let Some(operation) = deviation.operation {
        let at = &operation.location;
        text += &format!("\n  {}:{}", at.file, at.line);
    }
    text
}

/// Returns the meaning of a kind in a few words.
fn meaning(kind: DeviationKind, lang: Lang) -> &'static str {
    let (zh, en) = match kind {
        DeviationKind::Frame(_) | DeviationKind::Body(_) => {
            return error_text(kind.name(), lang).unwrap_or_default();
        }
        DeviationKind::UnknownCode => ("规范没有这个功能码", "the spec has no such code"),
        DeviationKind::UnknownKey => ("规范没有这个键", "the spec has no such key"),
        DeviationKind::UnknownEnumValue => ("规范没有这个枚举值", "the enum has no such value"),
        DeviationKind::UnknownResult => ("规范没有这个结果码", "the spec has no such result"),
        DeviationKind::Unanswered => ("指令没有响应", "the command has no response"),
        DeviationKind::Unacknowledged => ("上报没有应答", "the report has no acknowledgement"),
        DeviationKind::StateOrder => ("状态的顺序不对", "the state cannot follow the one before"),
        DeviationKind::Cadence => ("上报的时机不对", "the report comes at the wrong time"),
    };
    lang.pick(zh, en)
}
