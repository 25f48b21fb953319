//! Checks the content of stream frames, and the commands that start and stop streams.

use crate::diagnostic::{Diagnostic, FaultCode, Faults};
use crate::language::grammar::STREAM;
use crate::load::draft::Draft;
use crate::model::Kind;
use crate::text;

/// Checks that a frame carries bytes of a media type or a JSON object, not both.
pub(super) fn check_content(draft: &Draft<'_>, faults: &mut Faults) {
    let operations = draft.operations.iter();
    for stream in operations.filter(|it| it.item.kind() == Kind::Stream) {
        let node = stream.origin.node;
        let content = STREAM.content.of(node);
        let Some((text, span)) = content.and_then(|it| Some((it.as_str()?, it.span()))) else {
            continue;
        };
        if let Some(body) = STREAM.body.entry(node) {
            let message = text!(
                "`content` 和 `body` 不能同时使用",
                "`content` and `body` cannot be combined"
            );
            let fault = Diagnostic::error(FaultCode::StreamContent, span, message);
            faults.push(fault.also(body.key.span(), text!("`body` 在这里", "`body` is here")));
        } else if text.ends_with("/json") {
            let message = text!(
                "JSON 应写在 `body` 中，不写媒体类型",
                "JSON needs `body` with its keys, not a media type"
            );
            faults.push(Diagnostic::error(FaultCode::StreamContent, span, message));
        }
    }
}
