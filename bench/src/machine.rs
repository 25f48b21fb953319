//! Description of the machine in a report, without its host name.

use crate::report::{Table, t};
use std::process::Command;

/// A machine and the date of a report.
#[derive(Clone, Debug)]
pub struct Machine {
    date: String,
}

impl Machine {
    /// Returns this machine, with the given date or today.
    #[must_use]
    pub fn new(date: Option<String>) -> Self {
        Self { date: date.unwrap_or_else(today) }
    }

    /// Returns the description as a table.
    #[must_use]
    pub fn table(&self) -> Table {
        let mut table = Table::new(t("机器", "Machine"), vec![t("机器", "machine"), "".into()]);
        let cores = std::thread::available_parallelism().map_or(0, usize::from);
        table.row(vec![t("日期", "date"), self.date.clone().into()]);
        table.row(vec![t("处理器", "processor"), processor().into()]);
        table.row(vec![t("可用核数", "cores"), cores.to_string().into()]);
        table.row(vec![t("系统", "system"), format!("{}, {}", std::env::consts::OS, std::env::consts::ARCH).into()]);
        table.row(vec![t("编译器", "compiler"), env!("FC_BENCH_RUSTC").into()]);
        table.row(vec![t("编译方式", "build"), t("`--release`，未指定 CPU", "`--release`, no target CPU")]);
        table
    }
}

fn processor() -> String {
    let info = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = info.lines().find_map(|line| line.strip_prefix("model name")?.split_once(':'));
    model.map_or_else(|| std::env::consts::ARCH.to_owned(), |(_, name)| name.trim().to_owned())
}

fn today() -> String {
    let output = Command::new("date").arg("+%Y-%m-%d").output();
    output.map(|output| String::from_utf8_lossy(&output.stdout).trim().to_owned()).unwrap_or_default()
}
