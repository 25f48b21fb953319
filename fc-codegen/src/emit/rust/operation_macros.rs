//! Macros that pass every operation to a macro of the user.
//!
//! They form the end of `descriptors.rs`, so that one file lists the operations.

use super::context::Context;
use super::source::Source;
use crate::package::docs::Docs;
use crate::package::items::{Call, Shape};

/// One of the macros.
struct Each {
    name: &'static str,
    about: [&'static str; 2],
    /// The matcher for the arguments of the user's macro.
    pattern: &'static str,
    rows: Vec<String>,
}

/// Writes all macros.
pub fn macros(out: &mut Source, context: &Context<'_>) {
    for each in all(context) {
        out.blank();
        write(out, &each);
    }
}

fn all(context: &Context<'_>) -> [Each; 3] {
    let row = |call: Call<'_>| {
        let [request, response] = [call.request, call.response].map(|item| &item.ty.name);
        format!("{} {request} {response};", call.method)
    };
    let messages = context.package.items();
    let messages = messages.filter(|item| matches!(item.shape, Shape::Record(..)));
    [
        Each {
            name: "for_each_command",
            about: [
                "对每条有功能码的指令展开一次：方法名、请求类型、响应类型。",
                "Expands once per command with a code: its method, request and response.",
            ],
            pattern: "$($method:ident $request:ident $response:ident;)*",
            rows: context.commands().into_iter().map(row).collect(),
        },
        Each {
            name: "for_each_report",
            about: [
                "对每个有功能码的上报展开一次：方法名、消息类型、应答类型。",
                "Expands once per report with a code: its method, message and acknowledgement.",
            ],
            pattern: "$($method:ident $report:ident $acknowledgement:ident;)*",
            rows: context.reports().into_iter().map(row).collect(),
        },
        Each {
            name: "for_each_message",
            about: [
                "对每个消息结构体展开一次，包括没有功能码的接口的结构体和内嵌的结构体。",
                "Expands once per message struct, including those of operations without a code and \
                 inner ones.",
            ],
            pattern: "$($message:ident;)*",
            rows: messages.map(|item| format!("{};", item.ty.name)).collect(),
        },
    ]
}

fn write(out: &mut Source, each: &Each) {
    let mut docs = Docs::said(each.about);
    docs.paragraph(format!(
        "The callback macro must accept `{}`.",
        each.pattern
    ));
    out.docs(&docs);
    out.line("#[macro_export]");
    out.block(format!("macro_rules! {}", each.name), |out| {
        out.enclose("($callback:ident) => {", "};", |out| {
            out.block("$callback!", |out| {
                for row in &each.rows {
                    out.line(row);
                }
            });
        });
    });
}
