//! Streams: what a frame carries, and the commands that start and stop them.

use super::each::called;
use crate::diagnostic::{Diagnostic, FaultCode, Faults, nearest};
use crate::load::draft::{Draft, Placed};
use crate::load::grammar::STREAM;
use crate::model::{Kind, Operation};
use crate::syntax::Node;
use crate::text;

/// A frame carries bytes of a media type or a JSON object.
pub(super) fn check_content(draft: &Draft<'_>, faults: &mut Faults) {
    for stream in streams(draft) {
        let node = stream.place.node;
        let Some((text, span)) = STREAM.content.of(node).and_then(|content| {
            let text = content.as_str()?;
            Some((text, content.span()))
        }) else {
            continue;
        };
        if let Some(body) = STREAM.body.entry(node) {
            let message = text!(
                "有 `body` 就是 JSON，不能有别的媒体类型",
                "what has a `body` is JSON and has no other media type"
            );
            faults.push(
                Diagnostic::error(FaultCode::StreamContent, span, message)
                    .also(body.key.span(), text!("它的键在这里", "its keys are here")),
            );
        } else if text.ends_with("/json") {
            let message = text!(
                "内容是 JSON 时改用 `body` 列出它的键",
                "what is JSON has a `body` with its keys instead"
            );
            faults.push(Diagnostic::error(FaultCode::StreamContent, span, message));
        }
    }
}

/// What starts or stops a stream is a command.
pub(super) fn check_commands(draft: &Draft<'_>, faults: &mut Faults) {
    for stream in streams(draft) {
        let node = stream.place.node;
        for by in [STREAM.started_by.of(node), STREAM.stopped_by.of(node)] {
            if let Some(fault) = by.and_then(|by| no_command(draft, by)) {
                faults.push(fault);
            }
        }
    }
}

fn no_command(draft: &Draft<'_>, by: Node<'_>) -> Option<Diagnostic> {
    let name = by.as_str()?;
    let span = by.span();
    let mut operations = draft.operations.iter();
    let named = operations.find(|operation| operation.item.name == name);
    let fault = match named {
        Some(named) if named.item.kind() == Kind::Command => return None,
        Some(named) => {
            let kind = called(named.item.kind());
            let message = text!(
                "`{name}` 是{kind}；数据流只能由指令开始或停止",
                "`{name}` is a {kind}; what starts or stops a stream is a command",
                kind = kind
            );
            Diagnostic::error(FaultCode::NotACommand, span, message)
                .also(named.place.name(), text!("在这里声明", "declared here"))
        }
        None => {
            let message = text!("没有指令 `{name}`", "there is no command `{name}`");
            Diagnostic::error(FaultCode::UnknownOperation, span, message)
        }
    };
    let commands = draft.operations.iter().map(|operation| &operation.item);
    let commands = commands.filter(|operation| operation.kind() == Kind::Command);
    Some(match nearest(name, commands.map(|it| it.name.as_str())) {
        Some(near) => fault.fix(
            span,
            near,
            text!("是否想写 `{near}`？", "did you mean `{near}`?"),
        ),
        None => fault,
    })
}

fn streams<'d, 'a>(draft: &'d Draft<'a>) -> impl Iterator<Item = &'d Placed<'a, Operation>> {
    let operations = draft.operations.iter();
    operations.filter(|operation| operation.item.kind() == Kind::Stream)
}
