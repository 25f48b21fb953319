//! `client.rs`: the app's stub, which the files of the groups extend, and one enum over all reports.

use super::context::{Context, message};
use super::source::Source;
use super::streams;
use crate::package::docs::Docs;
use crate::package::items::Call;
use crate::package::name::free;
use fc_spec::model::Side;

/// Generates `client.rs`.
pub fn client_file(context: &Context<'_>) -> String {
    let protocol = &context.package.name;
    let reports = context.reports();

    let mut out = context.source();
    out.inner_docs(&Docs::said([
        "app 端：连接，以及汇成一个枚举的全部上报。每条指令的方法与它的消息类型在同一个文件里。",
        "The app's side: the connection, and one enum over all reports. The method of each command is in \
         the file of its messages.",
]));
    out.blank();
    imports(&mut out, context, protocol, &reports);
    out.blank();
    client(&mut out, protocol);
    out.blank();
    stream(&mut out, protocol);
    out.blank();
    any_report(&mut out, protocol, &reports);
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

fn client(out: &mut Source, protocol: &str) {
    out.docs(&Docs::written([
        "一个机器人，从 app 一侧看：每条指令一个方法。",
        "A robot as seen from the app: one method per command. Cheap to clone; all clones share one\n\
         connection.",
    ]));
    out.line(format!(
        "\
#[derive(Clone, Debug)]
pub struct Client {{
    pub(crate) connection: Connection<{protocol}>,
}}"
    ));
    out.blank();
    out.block("impl Client", |out| {
        constructors(out);
        connection(out, protocol);
    });
    out.blank();
    out.line(format!(
        "\
impl From<Connection<{protocol}>> for Client {{
    fn from(connection: Connection<{protocol}>) -> Self {{
        Self {{ connection }}
    }}
}}"
    ));
}

/// Writes the methods that connect to a robot.
fn constructors(out: &mut Source) {
    out.docs(&Docs::written([
        "连接机器人；`config` 中没有设置的项使用规范的默认值。",
        "Connects to a robot. Settings missing from `config` have the defaults of the spec.",
    ]));
    out.line(
        "\
pub async fn connect(config: ClientConfig) -> Result<Self, ConnectError> {
    let connection = Connection::connect(config).await?;
    Ok(Self { connection })
}",
    );
    out.documented(&Docs::written([
        "立即返回，在后台连接机器人；其间发起的调用在各自的时限内等待连接。",
        "Returns at once and connects in the background. Calls made before that wait for the connection\n\
         within their timeout.",
    ]));
    out.line(
        "\
#[must_use]
pub fn connect_lazy(config: ClientConfig) -> Self {
    Connection::connect_lazy(config).into()
}",
    );
}

/// Writes the methods that give access to the connection.
fn connection(out: &mut Source, protocol: &str) {
    out.documented(&Docs::written([
        "此刻的连接状态；没有连接时说明原因。",
        "Returns the present state of the connection, with the reason if there is none.",
    ]));
    out.line(
        "\
#[must_use]
pub fn state(&self) -> ConnectionState {
    self.connection.state()
}",
    );
    out.documented(&Docs::written([
        "连接状态的变化：先是此刻的状态，之后是每一次变化。每次收到 `Connected` 都重新查询机器人的状态：机器人可能重启过。",
        "The states of the connection: the present one first, then each change. Query the state of the robot\n\
         at each `Connected`: the robot may have restarted.",
    ]));
    out.line(
        "\
#[must_use]
pub fn states(&self) -> ConnectionStates {
    self.connection.states()
}",
    );
    out.documented(&Docs::written([
        "等到连接永久关闭，返回原因。",
        "Waits until the connection is closed for good, and returns the reason.",
    ]));
    out.line(
        "\
pub async fn closed(&self) -> Loss {
    self.connection.closed().await
}",
    );
    out.documented(&Docs::written([
        "连接数据端口：在后台建立，断线后重连，随指令连接一起结束。",
        "Connects to the data port in the background and reconnects after a loss. It ends with this\n\
         connection.",
    ]));
    out.line(format!(
        "\
#[must_use]
pub fn data(&self) -> DataConnection<{protocol}> {{
    self.connection.data()
}}"
    ));
    out.documented(&Docs::written([
        "底层连接：原始指令和单次调用的选项。",
        "The underlying connection: raw commands and options of a single call.",
    ]));
    out.line(format!(
        "\
#[must_use]
pub fn connection(&self) -> &Connection<{protocol}> {{
    &self.connection
}}"
    ));
    out.documented(&Docs::written([
        "返回此后全部上报的接收端。每个接收端都收到全部上报，各有自己的队列；没有接收端时，上报不会得到应答。",
        "Returns a receiver of all reports from now on. Each receiver gets all of them and has its own\n\
         queue. Without a receiver, reports are not acknowledged.",
    ]));
    out.line(
        "\
#[must_use]
pub fn reports(&self) -> Reports {
    Reports(self.connection.reports())
}",
    );
}

fn stream(out: &mut Source, protocol: &str) {
    out.docs(&Docs::written([
        "收到的上报，按到达的先后。",
        "Reports in the order of arrival. A report is acknowledged when at least one receiver has it in its\n\
         queue. Every receiver of a connection gets all reports. A report with an invalid body is refused,\n\
         counted as `reports_invalid`, and not delivered.",
    ]));
    out.line(format!(
        "\
#[derive(Debug)]
pub struct Reports(RawReports<{protocol}>);"
    ));
    out.blank();
    out.block("impl Reports", |out| {
        out.docs(&Docs::written([
            "下一个上报；连接结束后为 `None`。",
            "Returns the next report, or `None` after the connection has ended. Reports are read before they\n\
             are acknowledged, so an error means that the connection has a protocol with other types.",
        ]));
        out.line(
            "\
pub async fn recv(&mut self) -> Option<Result<AnyReport, BodyError>> {
    self.0.recv().await.map(AnyReport::from_raw)
}",
        );
        missed(out);
    });
    out.blank();
    out.line(
        "\
impl Stream for Reports {
    type Item = Result<AnyReport, BodyError>;

    fn poll_next(mut self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<Option<Self::Item>> {
        self.0
            .poll_recv(cx)
            .map(|report| report.map(AnyReport::from_raw))
    }
}",
    );
}

fn any_report(out: &mut Source, protocol: &str, reports: &[Call<'_>]) {
    out.docs(&Docs::written(["任意一个上报。", "Any report."]));
    out.line(format!(
        "\
#[derive(Clone, Debug, PartialEq, Dispatch)]
#[fc(protocol = {protocol})]"
    ));
    out.block("pub enum AnyReport", |out| {
        for report in reports {
            out.blank();
            let ty = report.request;
            out.docs(&Docs::titled(&report.operation.title));
            out.line(format!("{}({}),", ty.ty.name, message(ty)));
        }
        let taken = |name: &str| reports.iter().any(|report| report.request.ty.name == name);
        let unknown = free(&["Unknown", "Other", "Unlisted"], taken);
        out.blank();
        out.docs(&Docs::written([
            "功能码不在规范中的上报，原样保留。",
            "A report with a code that is not in the spec, kept unchanged.",
        ]));
        out.line(format!(
            "\
#[fc(unknown)]
{unknown}(RawReport),"
        ));
    });
}

/// Writes the method that counts missed reports, of a receiver with and without `async`.
pub fn missed(out: &mut Source) {
    out.documented(&Docs::written([
        "返回上次调用以来错过的上报数：自己的队列已满，其他接收端收到了它们。",
        "Returns the number of reports that this receiver missed since the last call: its queue was full,\n\
         and another receiver took them.",
    ]));
    out.line(
        "\
pub fn missed(&mut self) -> u64 {
    self.0.missed()
}",
    );
}
