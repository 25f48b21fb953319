//! An app that tries out a robot. It calls every command of the spec with its example, receives the
//! robot's reports and the picture of a map, and prints each outcome.
//!
//! ```text
//! cargo run --example robot &
//! cargo run --example app
//! ```

mod support;

use fc_generated::descriptors::OPERATIONS;
use fc_generated::{
    AnyReport, Client, Fc, GetMapImageRequest, Reports, for_each_command, for_each_report,
};
use fc_runtime::{CallError, Command, DataConnection, Message, Report};
use std::collections::BTreeSet;
use std::process::ExitCode;
use std::time::Duration;
use support::{Args, Fault, Lang, Table};

const USAGE: &str = "\
Calls every command of a robot and prints what came of it.

Usage: app [--host 127.0.0.1] [--command-port PORT] [--data-port PORT] [--gzip-from BYTES]
           [--lang zh|en]

Without ports, those of the spec. With --gzip-from, whatever has so many bytes is compressed.
Without --lang, the language of the environment.";

/// Longest wait for a report or a picture.
const PATIENCE: Duration = Duration::from_secs(20);

#[tokio::main(flavor = "current_thread")]
async fn main() -> ExitCode {
    support::main(USAGE, run).await
}

async fn run(args: Args) -> Result<(), Fault> {
    let client = Client::connect(args.client()).await?;
    let mut reports = client.reports();
    // #region data
    let data = client.data();
    data.connected().await?;
    // #endregion data

    let mut tour = Tour::new(args.lang);
    call_all(&client, &mut tour).await;
    receive_all(&mut reports, &mut tour).await?;
    receive_picture(&data, &mut tour).await?;
    print!("{}", tour.table);
    match tour.failed {
        0 => Ok(()),
        failed => Err(format!("{failed} operations failed").into()),
    }
}

/// The outcomes of the operations so far.
struct Tour {
    lang: Lang,
    table: Table,
    failed: usize,
}

impl Tour {
    fn new(lang: Lang) -> Self {
        let mut table = Table::default();
        table.row(lang.pick(
            ["功能码", "类型", "名称", "说明", "结果"],
            ["Code", "Kind", "Name", "Title", "Outcome"],
        ));
        Self {
            lang,
            table,
            failed: 0,
        }
    }

    fn add(&mut self, code: u16, kind: &str, outcome: Result<String, String>) {
        let operation = OPERATIONS
            .iter()
            .find(|operation| operation.code == Some(code));
        let (name, title) = operation.map_or(("", ""), |operation| {
            (operation.name, self.lang.pick(operation.zh, operation.en))
        });
        let outcome = outcome.unwrap_or_else(|error| {
            self.failed += 1;
            error
        });
        self.table
            .row([&format!("0x{code:04X}"), kind, name, title, &outcome]);
    }

    fn answered<C: Command>(&mut self, answer: Result<C::Response, CallError>) {
        let outcome = answer
            .map(|_| self.lang.pick("成功", "answered").to_owned())
            .map_err(|error| error.to_string());
        self.add(C::CODE, self.lang.pick("指令", "command"), outcome);
    }
}

macro_rules! call_all {
    ($($method:ident $request:ident $response:ident;)*) => {
        /// Calls every command with the spec's example.
        #[allow(deprecated, reason = "a robot still answers what is withdrawn")]
        async fn call_all(client: &Client, tour: &mut Tour) {
            $(
                let answer = client.$method(&fc_generated::$request::example()).await;
                tour.answered::<fc_generated::$request>(answer);
            )*
        }
    };
}
for_each_command!(call_all);

macro_rules! count_reports {
    ($($method:ident $report:ident $acknowledgement:ident;)*) => {
        /// Returns the codes of all reports of the spec.
        fn report_codes() -> BTreeSet<u16> {
            [$(<fc_generated::$report as Report>::CODE),*].into()
        }

        /// Returns the code of a report, if the spec has it.
        fn code_of(report: &AnyReport) -> Option<u16> {
            match report {
                $(AnyReport::$report(_) => Some(<fc_generated::$report as Report>::CODE),)*
                _ => None,
            }
        }
    };
}
for_each_report!(count_reports);

/// Waits until every report has arrived once.
async fn receive_all(reports: &mut Reports, tour: &mut Tour) -> Result<(), Fault> {
    let mut missing = report_codes();
    while !missing.is_empty() {
        let report = tokio::time::timeout(PATIENCE, reports.recv()).await;
        let report =
            report.map_err(|_| format!("no report for a while; missing: {missing:04X?}"))?;
        match report.ok_or("the robot has left")? {
            Ok(report) => {
                if let Some(code) = code_of(&report).filter(|code| missing.remove(code)) {
                    let outcome = tour.lang.pick("收到", "received");
                    tour.add(
                        code,
                        tour.lang.pick("主动上报", "report"),
                        Ok(outcome.to_owned()),
                    );
                }
            }
            Err(error) => return Err(error.into()),
        }
    }
    Ok(())
}

/// Waits for the picture that the map image call ordered, and skips frames of other streams. The
/// client has already verified its digest.
async fn receive_picture(data: &DataConnection<Fc>, tour: &mut Tour) -> Result<(), Fault> {
    let picture = async {
        loop {
            let frame = data.recv().await?;
            if frame.code == GetMapImageRequest::CODE {
                return Ok::<_, Fault>(frame);
            }
        }
    };
    let frame = tokio::time::timeout(PATIENCE, picture)
        .await
        .map_err(|_| "no picture came")??;
    let (size, id) = (frame.data.len(), frame.id);
    let outcome = Ok(tour.lang.pick(
        format!("收到 {size} 字节，msgId {id}，MD5 一致"),
        format!("received {size} bytes, msgId {id}, MD5 verified"),
    ));
    tour.add(frame.code, tour.lang.pick("数据流", "stream"), outcome);
    Ok(())
}
