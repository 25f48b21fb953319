//! Streams: what a frame carries, and the commands that start and stop them.

use super::each::called;
use crate::diagnostic::{Diagnostic, FaultCode, Faults, nearest};
use crate::language::grammar::STREAM;
use crate::load::draft::{Draft, Placed};
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
                "`content` 和 `body` 不能同时使用",
                "`content` and `body` cannot be combined"
            );
            faults.push(
                Diagnostic::error(FaultCode::StreamContent, span, message)
                    .also(body.key.span(), text!("`body` 在这里", "`body` is here")),
            );
        } else if text.ends_with("/json") {
            let message = text!(
                "JSON 应写在 `body` 中，不写媒体类型",
                "JSON needs `body` with its keys, not a media type"
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
                "开始和停止数据流的应为指令，而 `{name}` 是{kind}",
                "a stream needs a command to start or stop it, but `{name}` is a {kind}",
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
