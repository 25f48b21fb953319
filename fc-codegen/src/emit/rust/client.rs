//! `client.rs`: the app's stub, which the files of the groups extend, and one enum over all reports.

use super::context::{Context, message};
use super::enums::other_name;
use super::source::Source;
use super::streams;
use crate::package::docs::Docs;
use crate::package::items::Call;
use fc_spec::model::Side;

/// Generates `client.rs`.
pub fn client_file(context: &Context<'_>) -> String {
    let protocol = &context.package.name;
    let reports = context.reports();

    let mut out = context.source();
    out.head("client_head", &[]);
    imports(&mut out, context, protocol, &reports);
    out.blank();
    out.template("client", &[("protocol", protocol)]);
    any_report(&mut out, &reports);
    if streams::are_any(context) {
        out.blank();
        streams::app(&mut out, context, protocol);
    }
    out.finish()
}

fn imports(out: &mut Source, context: &Context<'_>, protocol: &str, reports: &[Call<'_>]) {
    if !reports.is_empty() || streams::has_type(context, Side::ALL) {
        out.import("super", &["messages"]);
    }
    out.import("super::protocol", &[protocol]);
    out.import("fc_derive", &["Dispatch"]);
    let mut runtime = vec![
        "BodyError",
        "ClientConfig",
        "ConnectError",
        "Connection",
        "ConnectionState",
        "ConnectionStates",
        "DataConnection",
        "Loss",
        "RawReport",
        "RawReports",
    ];
    runtime.extend(streams::imports_of_app(context));
    out.import("fc_runtime", &runtime);
    out.import("futures_core", &["Stream"]);
    out.import("std::pin", &["Pin"]);
    out.import("std::task", &["Context", "Poll"]);
}

fn any_report(out: &mut Source, reports: &[Call<'_>]) {
    out.block("pub enum AnyReport", |out| {
        for report in reports {
            out.blank();
            let ty = report.request;
            out.docs(&Docs::titled(&report.operation.title));
            out.line(format!("{}({}),", ty.ty.name, message(ty)));
        }
        let unknown =
            other_name(|name| reports.iter().any(|report| report.request.ty.name == name));
        out.template("unknown_report", &[("name", &unknown)]);
    });
}
