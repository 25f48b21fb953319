//! Deviations as text for people.

use super::{Deviation, DeviationKind};
use crate::decode::{clipped, clock, error_text, side};
use fc_spec::model::Lang;

/// Returns a deviation in three lines: its place in the protocol, its kind and content, and its number and first frame.
#[must_use]
pub fn deviation(deviation: &Deviation<'_>, lang: Lang) -> String {
    let place = &deviation.place;
    let mut title = Vec::new();
    if let Some((_, code)) = place.code {
        title.push(format!("0x{code:04X}"));
    }
    if let Some(operation) = deviation.operation {
        title.push(operation.name.clone());
    }
    title.extend(place.direction.map(|it| side(it, lang).to_owned()));
    if title.is_empty() {
        title.push(
            lang.pick("无法识别的字节", "bytes that are no frame")
                .to_owned(),
        );
    }
    for part in [&place.path, &place.value] {
        if !part.is_empty() {
            title.push(format!("· {part}"));
        }
    }
    let name = place.kind.name();
    let colon = lang.pick("：", ": ");
    let mut content = vec![format!("{name}{colon}{}", meaning(place.kind, lang))];
    let example = clipped(&deviation.example);
    if !example.is_empty() && example != place.value {
        content.push(format!("{} {example}", lang.pick("收到", "found")));
    }
    if !deviation.expected.is_empty() {
        let spec = lang.pick("规范", "spec");
        content.push(format!("{spec}{colon}{}", deviation.expected));
    }
    let first = match (lang, deviation.count) {
        (Lang::Zh, count) => format!("{count} 次，首次在位置 {}", deviation.offset),
        (Lang::En, 1) => format!("once, at {}", deviation.offset),
        (Lang::En, count) => format!("{count} times, first at {}", deviation.offset),
    };
    let mut first = vec![first];
    first.extend(deviation.flow.map(|flow| flow.to_string()));
    first.extend(deviation.time.map(clock));
    let operation = deviation.operation.map(|it| &it.location);
    first.extend(operation.map(|at| format!("{}:{}", at.file, at.line)));
    let (title, content, first) = (title.join(" "), content.join(" · "), first.join(" · "));
    format!("{title}\n  {content}\n  {first}")
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
