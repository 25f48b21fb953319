//! Measures reports from one robot to many apps. Every app acknowledges every report.

mod apps;
mod robot;

pub use apps::{drive, fetch};
pub use robot::serve;

use crate::process::{Process, cores};
use crate::report::{Section, Table, Target, Text, digits, median, ratio, t, thousands};
use std::path::{Path, PathBuf};

/// The robots: the floor, fc, and fc with a separate encoding for each app.
const ROBOTS: &[&str] = &["raw", "fc", "fc-each"];
/// Numbers of apps at one robot.
const APPS: &[usize] = &[1, 10, 100, 1000];
/// Deliveries of a first round, whose speed determines the number of deliveries in the measured rounds.
const FIRST: usize = 4_000;
/// Number of fast apps in the measurement with a slow app.
const FAST: usize = 10;

/// The figures of one round.
#[derive(Clone, Copy)]
struct Round {
    /// Acknowledged deliveries per second.
    per_second: f64,
    /// CPU time of the robot per delivery, in microseconds.
    robot: f64,
    /// CPU time of the apps per delivery, in microseconds.
    apps: f64,
}

/// Runs one round in which `robot` pushes `reports` reports to each of `apps` apps.
fn round(program: &Path, robot: &str, apps: usize, reports: usize) -> Round {
    let (first, second) = cores();
    let mut server = Process::start(program, &["reports-serve", robot], first);
    let address = server.line();
    let mut driver = Process::start(program, &["reports-drive", robot, &address, &apps.to_string(), "0"], second);
    driver.line();
    server.tell(&format!("push {apps} {reports}"));
    let pushed = server.figures();
    let driven = driver.end();
    let deliveries = (apps * reports) as f64;
    Round {
        per_second: deliveries / pushed[0],
        robot: pushed[1] * 1e6 / deliveries,
        apps: driven[0] * 1e6 / deliveries,
    }
}

/// Returns the acknowledged deliveries per second to the fast apps while `slow` slow apps are connected.
fn beside(program: &Path, slow: usize, seconds: f64) -> f64 {
    let (first, second) = cores();
    let mut server = Process::start(program, &["reports-serve", "fc"], first);
    let address = server.line();
    let arguments = ["reports-drive", "fc", &address, &FAST.to_string(), &slow.to_string()];
    let mut driver = Process::start(program, &arguments, second);
    driver.line();
    server.tell(&format!("paced {FAST} {} {seconds}", FAST + slow));
    let figures = server.figures();
    driver.end();
    figures[0] / figures[1]
}

/// Returns the time from a push to its acknowledgement, p50 and p99 in microseconds.
///
/// If `large` is set, another app fetches large responses at the same time.
fn timed(program: &Path, robot: &str, large: bool, reports: usize) -> [f64; 2] {
    let (first, second) = cores();
    let mut server = Process::start(program, &["reports-serve", robot], first);
    let address = server.line();
    let mut listening = Process::start(program, &["reports-drive", robot, &address, "1", "0"], second);
    listening.line();
    let _fetching = large.then(|| Process::start(program, &["reports-fetch", &address], second));
    server.tell(&reports.to_string());
    let figures = server.figures();
    listening.end();
    [figures[0], figures[1]]
}

struct Measured {
    apps: usize,
    robots: Vec<Vec<Round>>,
}

impl Measured {
    fn median(&self, robot: &str, figure: fn(&Round) -> f64) -> f64 {
        let index = ROBOTS.iter().position(|known| *known == robot).expect("a robot");
        median(self.robots[index].iter().map(figure))
    }
}

fn measure(program: &Path, apps: usize, quick: bool) -> Measured {
    let seconds = if quick { 0.2 } else { 0.5 };
    let whole = |deliveries: f64| (deliveries as usize / apps).max(1);
    eprintln!("reports: {apps} apps");
    let counts: Vec<usize> = ROBOTS
        .iter()
        .map(|robot| whole(round(program, robot, apps, whole(FIRST as f64)).per_second * seconds))
        .collect();
    let mut robots = vec![Vec::new(); ROBOTS.len()];
    for _ in 0..if quick { 2 } else { 5 } {
        for (index, robot) in ROBOTS.iter().enumerate() {
            robots[index].push(round(program, robot, apps, counts[index]));
        }
    }
    Measured { apps, robots }
}

fn table(measured: &[Measured]) -> Table {
    let columns = vec![
        t("app 数", "apps"),
        t("机器人", "robot"),
        t("送达并应答，次/秒", "delivered and acknowledged/s"),
        "× raw".into(),
        t("机器人 CPU µs/次", "robot, CPU µs/delivery"),
        t("app CPU µs/次", "apps, CPU µs/delivery"),
        t("机器人 CPU × raw", "robot, CPU × raw"),
    ];
    let mut table = Table::new(t("一个机器人，许多 app", "One robot, many apps"), columns);
    for one in measured {
        for robot in ROBOTS {
            let rate = one.median(robot, |round| round.per_second);
            let cpu = one.median(robot, |round| round.robot);
            table.row(vec![
                one.apps.to_string().into(),
                (*robot).into(),
                thousands(rate).into(),
                ratio(rate, one.median("raw", |round| round.per_second)).into(),
                digits(cpu).into(),
                digits(one.median(robot, |round| round.apps)).into(),
                ratio(cpu, one.median("raw", |round| round.robot)).into(),
            ]);
        }
    }
    table
}

fn slow(program: &Path, quick: bool) -> (Table, f64) {
    eprintln!("reports: a slow app");
    let (rounds, seconds) = if quick { (2, 1.0) } else { (5, 2.5) };
    let mut rates = [Vec::new(), Vec::new()];
    for _ in 0..rounds {
        for (slow, rates) in rates.iter_mut().enumerate() {
            rates.push(beside(program, slow, seconds));
        }
    }
    let [without, with] = rates.map(median);
    let columns =
        vec![t("情形", "case"), t("快的 app 送达，次/秒", "delivered to the fast apps/s"), t("比值", "ratio")];
    let title = t("一个从不应答的 app", "An app that never acknowledges");
    let mut table = Table::new(title, columns);
    let rows: [(Text, f64); 2] = [
        (t("10 个快的 app", "10 fast apps"), without),
        (t("10 个快的 app 和 1 个慢的", "10 fast apps and a slow one"), with),
    ];
    for (name, rate) in rows {
        table.row(vec![name, thousands(rate).into(), ratio(rate, without).into()]);
    }
    (table, with / without)
}

fn beside_large(program: &Path, quick: bool) -> (Table, f64) {
    eprintln!("reports: beside large answers");
    let (rounds, reports) = if quick { (2, 300) } else { (7, 1_500) };
    let arms: [(Text, &str, bool); 3] = [
        (t("安静", "quiet"), "timed", false),
        (t("另一个 app 不停地获取 1 MiB 的响应", "another app fetches responses of 1 MiB"), "timed", true),
        (t("同上，响应预先准备", "the same, prepared responses"), "timed-prepared", true),
    ];
    let mut measured = vec![Vec::new(); arms.len()];
    for _ in 0..rounds {
        for (measured, (_, robot, large)) in measured.iter_mut().zip(&arms) {
            measured.push(timed(program, robot, *large, reports));
        }
    }
    let of = |arm: usize, at: usize| median(measured[arm].iter().map(|round| round[at]));
    let columns =
        vec![t("情形", "case"), "p50, µs".into(), t("× 安静", "× quiet"), "p99, µs".into(), t("× 安静", "× quiet")];
    let title = t("小上报与 1 MiB 的响应并行", "Small reports with 1 MiB responses in parallel");
    let mut table = Table::new(title, columns);
    for (arm, (name, ..)) in arms.iter().enumerate() {
        let (p50, p99) = (of(arm, 0), of(arm, 1));
        table.row(vec![
            name.clone(),
            digits(p50).into(),
            ratio(p50, of(0, 0)).into(),
            digits(p99).into(),
            ratio(p99, of(0, 1)).into(),
        ]);
    }
    (table, of(1, 1) / of(0, 1))
}

/// Measures this group and returns its section.
pub fn section(quick: bool) -> Section {
    let program: PathBuf = std::env::current_exe().expect("own path");
    let measured: Vec<Measured> = APPS.iter().map(|apps| measure(&program, *apps, quick)).collect();
    let (slow_table, kept) = slow(&program, quick);
    let (large_table, late) = beside_large(&program, quick);
    let hundred = measured.iter().find(|one| one.apps == 100).expect("a hundred apps");
    let both = |robot: &str| hundred.median(robot, |round| round.robot + round.apps);
    let cpu = both("fc") / both("raw");
    Section {
        title: t("主动上报", "Reports"),
        about: t(
            "机器人和全部 app 各为一个进程、各占一个核。每批 16 个上报，全部应答后再发下一批。慢的 app 连上后不读取任何\
             数据。\n\n\
             - `raw` 写出同样的字节，并数应答。\n\
             - `fc` 编码一次，发给所有 app。\n\
             - `fc-each` 为每个 app 编码一次，用来显示前者节省了多少。\n\n\
             最后一张表中，机器人只有一个线程，每毫秒发一个上报。时间从发出算到收到应答。获取大响应的 app 收到后直接丢\
             弃。",
            "The robot is one process and all apps are another, with one core each. Reports go out in batches of 16, \
             each after all reports of the previous batch are acknowledged. The slow app connects and reads nothing.\n\n\
             - `raw` writes the same bytes and counts the acknowledgements.\n\
             - `fc` encodes once for all apps.\n\
             - `fc-each` encodes for every app, to show the savings of `fc`.\n\n\
             For the last table, the robot has one thread and sends a report every millisecond. Times are from the \
             push to the acknowledgement. The app that fetches large responses discards them.",
        ),
        tables: vec![table(&measured), slow_table, large_table],
        targets: vec![
            // A report is the same exchange as a call, in the other direction. These are the bounds of T7, converted
            // from raw-mux to raw: raw-mux takes 1.33 times as much CPU time as raw.
            Target::at_most(
                "R1",
                t("100 个 app，两端 CPU × raw（按 T7 折算）", "100 apps, CPU of both sides × raw (T7, converted)"),
                3.7,
                3.1,
                cpu,
            ),
            Target::at_least(
                "R2",
                t("快的 app 的速率，有慢的 / 没有", "rate of the fast apps, with a slow one / without"),
                0.85,
                0.95,
                kept,
            ),
            Target::at_most(
                "R3",
                t("小上报，p99，有 1 MiB 的响应并行 / 安静", "small reports, p99, with 1 MiB responses / quiet"),
                2.0,
                1.3,
                late,
            ),
        ],
    }
}
