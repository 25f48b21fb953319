//! `blocking.rs`: the app's stub without `async`, for tools and tests.

use super::client::missed;
use super::context::Context;
use super::source::Source;
use crate::package::docs::Docs;

/// Generates `blocking.rs`.
pub fn blocking_file(context: &Context<'_>) -> String {
    let protocol = &context.package.name;

    let mut out = context.source();
    let mut docs = Docs::said([
        "不用 `async` 的 app 端，供工具和测试使用：每条指令一个方法，在调用它的线程上等待响应。",
        "The app's side without `async`, for tools and tests: one method per command, which blocks the \
         calling thread until the response.",
    ]);
    docs.both([
        "连接有自己的线程：没有调用时，上报同样得到应答，断线同样重连。",
        "A connection has its own thread. It acknowledges reports and reconnects after a loss, also \
         between calls.",
    ]);
    out.inner_docs(&docs);
    out.blank();
    out.import("super", &["AnyReport"]);
    out.import("super::protocol", &[protocol]);
    out.import(
        "fc_runtime",
        &["BodyError", "ClientConfig", "ConnectError", "blocking"],
    );
    out.import("std::time", &["Duration"]);
    out.blank();
    out.line("pub use fc_runtime::blocking::ReportError;");
    out.blank();
    client(&mut out, protocol);
    out.blank();
    reports(&mut out, protocol);
    out.finish()
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
    pub(crate) connection: blocking::Connection<{protocol}>,
}}"
    ));
    out.blank();
    out.block("impl Client", |out| {
        out.docs(&Docs::written([
            "连接机器人；`config` 中没有设置的项使用规范的默认值。",
            "Connects to a robot. Settings missing from `config` have the defaults of the spec.",
        ]));
        out.line(
            "\
pub fn connect(config: ClientConfig) -> Result<Self, ConnectError> {
    let connection = blocking::Connection::connect(config)?;
    Ok(Self { connection })
}",
        );
        out.documented(&Docs::written([
            "底层连接：用它的 `wait` 等待异步方法，例如数据端口和原始指令的方法。",
            "The underlying connection. Its `wait` waits for `async` methods, such as those of the data\n\
             port and of raw commands.",
        ]));
        out.line(format!(
            "\
#[must_use]
pub fn connection(&self) -> &blocking::Connection<{protocol}> {{
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
    });
}

fn reports(out: &mut Source, protocol: &str) {
    out.docs(&Docs::written([
        "收到的上报，按到达的先后。作为迭代器，它一直等到下一个上报，连接永久关闭后结束。",
        "Reports in the order of arrival. As an iterator it waits for the next report without a limit, and\n\
         ends when the connection is closed for good. See [`Reports`](crate::Reports).",
    ]));
    out.line(format!(
        "\
#[derive(Debug)]
pub struct Reports(blocking::Reports<{protocol}>);"
    ));
    out.blank();
    out.block("impl Reports", |out| {
        out.docs(&Docs::written([
            "在 `timeout` 之内等待下一个上报；之后到达的不会丢失。",
            "Waits for the next report for `timeout`. A report that comes later is not lost.",
        ]));
        out.line(
            "\
pub fn recv_timeout(&mut self, timeout: Duration) -> Result<AnyReport, ReportError> {
    let report = self.0.recv_timeout(timeout)?;
    Ok(AnyReport::from_raw(report)?)
}",
        );
        missed(out);
    });
    out.blank();
    out.line(
        "\
impl Iterator for Reports {
    type Item = Result<AnyReport, BodyError>;

    fn next(&mut self) -> Option<Self::Item> {
        self.0.next().map(AnyReport::from_raw)
    }
}",
    );
}
