//! `blocking.rs`: the app's stub without `async`, for tools and tests.

use super::context::Context;
use super::source::Source;
use crate::emit::stub::docs::Docs;

/// The file.
pub fn file(context: &Context<'_>) -> String {
    let protocol = &context.package.name;

    let mut out = Source::rust();
    let mut docs = Docs::default();
    docs.paragraph(
        "不用 `async` 的 app 端，供工具和测试使用：每条指令一个方法，在调用它的线程上等待响应。",
    );
    docs.paragraph(
        "The app's side without `async`, for tools and tests: one method per command, which waits on \
         the thread that calls it.",
    );
    docs.paragraph("连接有自己的线程：没有调用的时候，上报照样得到应答，断线照样重连。");
    docs.paragraph(
        "A connection has a thread of its own: reports are acknowledged, and a lost connection is made \
         again, also while nobody calls anything.",
    );
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
    out.line(format!(
        "\
/// 一个机器人，从 app 一侧看：每条指令一个方法。
///
/// A robot as seen from the app: one method per command. Cheap to clone; all clones share one
/// connection.
#[derive(Clone, Debug)]
pub struct Client {{
    pub(crate) connection: blocking::Connection<{protocol}>,
}}"
    ));
    out.blank();
    out.block("impl Client", |out| {
        out.line(format!(
            "\
/// 连接机器人；`config` 中没有设置的项使用规范的默认值。
///
/// Connects to a robot; what `config` does not set has the default of the spec.
pub fn connect(config: ClientConfig) -> Result<Self, ConnectError> {{
    let connection = blocking::Connection::connect(config)?;
    Ok(Self {{ connection }})
}}

/// 底层连接：用它的 `wait` 可以等待连接状态、数据端口、原始指令等异步方法。
///
/// The underlying connection: its `wait` waits for what has `async` methods alone, such as the
/// data port and raw commands.
#[must_use]
pub fn connection(&self) -> &blocking::Connection<{protocol}> {{
    &self.connection
}}

/// 此后收到的全部主动上报。每个接收端都收到全部上报，各有自己的队列；没有接收端时，上报不会得到应答。
///
/// All reports received from now on. Each receiver gets all of them and has a queue of its own;
/// while there is none, no report is acknowledged.
#[must_use]
pub fn reports(&self) -> Reports {{
    Reports(self.connection.reports())
}}"
        ));
    });
}

fn reports(out: &mut Source, protocol: &str) {
    out.line(format!(
        "\
/// 收到的主动上报，按到达的先后。作为迭代器，它一直等到下一个上报，连接永久关闭后结束。
///
/// Reports in the order in which they came. As an iterator it waits for each as long as it takes, and
/// ends when the connection is closed for good. See [`Reports`](crate::Reports).
#[derive(Debug)]
pub struct Reports(blocking::Reports<{protocol}>);

impl Reports {{
    /// 在 `timeout` 之内等待下一个上报；之后才到的不会丢失。
    ///
    /// The next report, if there is one within `timeout`. What comes later is not lost.
    pub fn recv_timeout(&mut self, timeout: Duration) -> Result<AnyReport, ReportError> {{
        let report = self.0.recv_timeout(timeout)?;
        Ok(AnyReport::from_raw(report)?)
    }}

    /// 自上次询问以来，因自己的队列已满而错过的上报数（其他接收端收到了它们）。
    ///
    /// How many reports this receiver has missed since this was last asked, because its queue was full
    /// while another receiver took them.
    pub fn missed(&mut self) -> u64 {{
        self.0.missed()
    }}
}}

impl Iterator for Reports {{
    type Item = Result<AnyReport, BodyError>;

    fn next(&mut self) -> Option<Self::Item> {{
        self.0.next().map(AnyReport::from_raw)
    }}
}}"
    ));
}
