//! Measures the cost of the generated code for its users: compile time and program size.

mod crates;

use crate::report::{Section, Table, Target, Text, digits, median, ratio, seconds, t};
use crates::{Action, Crate, Kind};

/// Number of commands in a crate. Each command has two messages.
const COMMANDS: usize = 30;
/// Kinds in the order of the report.
const KINDS: &[Kind] = &[Kind::Fc, Kind::FcTokio, Kind::Prost];

fn name(kind: Kind) -> Text {
    match kind {
        Kind::Fc => t("fc：类型与按码读写", "fc: types, all read and written by code"),
        Kind::FcTokio => t("fc：另有客户端与服务端", "fc: with client and server"),
        Kind::Prost => t("prost：类型与按码读写", "prost: types, all read and written by code"),
    }
}

/// The seconds of each action, over all rounds.
#[derive(Default)]
struct Times {
    cold: Vec<f64>,
    check: Vec<f64>,
    debug: Vec<f64>,
    release: Vec<f64>,
}

impl Times {
    fn medians(&self) -> [f64; 4] {
        [&self.check, &self.debug, &self.release, &self.cold].map(|seconds| median(seconds.iter().copied()))
    }
}

fn measure(crates: &[Crate], quick: bool) -> Vec<Times> {
    let mut times: Vec<Times> = crates.iter().map(|_| Times::default()).collect();
    let (cold, warm) = if quick { (1, 2) } else { (3, 5) };
    for turn in 0..cold {
        for (index, (made, times)) in crates.iter().zip(&mut times).enumerate() {
            eprintln!("compile: cold build {} of crate {}", turn + 1, index + 1);
            made.clean();
            times.cold.push(made.act(Action::Debug));
        }
    }
    for made in crates {
        eprintln!("compile: dependencies");
        made.act(Action::Check);
        if !quick {
            made.act(Action::Release);
        }
    }
    for turn in 0..warm {
        eprintln!("compile: round {}", turn + 1);
        for (made, times) in crates.iter().zip(&mut times) {
            times.check.push(made.act(Action::Check));
            times.debug.push(made.act(Action::Debug));
            if !quick {
                times.release.push(made.act(Action::Release));
            }
        }
    }
    times
}

/// Returns the table of sizes. The size per command comes from programs with [`COMMANDS`] and twice as many commands.
fn sizes(root: &std::path::Path, crates: &[Crate]) -> Table {
    let columns = vec![
        "".into(),
        t("30 个指令，KB", "30 commands, KB"),
        t("60 个指令，KB", "60 commands, KB"),
        t("每个指令，KB", "per command, KB"),
    ];
    let mut table = Table::new(t("程序大小（release，去符号）", "Size of the program (release, stripped)"), columns);
    for (kind, made) in KINDS.iter().zip(crates) {
        eprintln!("compile: size");
        let twice = Crate::new(root.join(format!("twice-{kind:?}")), *kind, COMMANDS * 2);
        let (small, large) = (made.program_size(), twice.program_size());
        let cells = [small / 1e3, large / 1e3, (large - small) / COMMANDS as f64 / 1e3];
        let figures = cells.into_iter().map(|value| Text::from(digits(value)));
        table.row([name(*kind)].into_iter().chain(figures).collect());
    }
    table
}

/// Measures this group and returns its section.
pub fn section(quick: bool) -> Section {
    let root = tempfile::tempdir().expect("a directory");
    let crates: Vec<Crate> =
        KINDS.iter().map(|kind| Crate::new(root.path().join(format!("{kind:?}")), *kind, COMMANDS)).collect();
    let medians: Vec<[f64; 4]> = measure(&crates, quick).iter().map(Times::medians).collect();
    let (ours, peer) = (medians[0], medians[2]);
    let columns = vec![
        "".into(),
        t("依赖的 crate 数", "crates below"),
        "check".into(),
        t("debug 构建", "debug build"),
        t("release 构建", "release build"),
        t("从零构建", "cold build"),
        t("check × prost", "check × prost"),
        t("debug × prost", "debug × prost"),
        t("release × prost", "release × prost"),
        t("从零 × prost", "cold × prost"),
    ];
    let title = t("编译 60 个消息（每个 8 个字段）的 crate", "Compiling a crate of 60 messages with eight fields each");
    let mut table = Table::new(title, columns);
    for ((kind, made), medians) in KINDS.iter().zip(&crates).zip(&medians) {
        let mut cells = vec![name(*kind), made.dependencies().to_string().into()];
        cells.extend(medians.iter().map(|value| Text::from(seconds(*value))));
        cells.extend(medians.iter().zip(&peer).map(|(value, peer)| Text::from(ratio(*value, *peer))));
        table.row(cells);
    }
    let mut tables = vec![table];
    if !quick {
        tables.push(sizes(root.path(), &crates));
    }
    Section {
        title: t("生成代码的编译", "Compiling the generated code"),
        about: t(
            "双方是同样的 30 个请求和 30 个响应，都含有按功能码读写每个消息的代码。`check` 和构建只算这个 crate，依赖已\
             经就绪；“从零”含全部依赖（debug）。增量编译关闭。`--quick` 不测 release 构建和程序大小。",
            "Both sides have the same 30 requests and 30 responses, and code that reads and writes each message by its \
             code. Checks and builds cover only the crate; its dependencies are ready. A cold build (debug) includes \
             all dependencies. Incremental compilation is off. `--quick` leaves out release builds and sizes.",
        ),
        tables,
        targets: vec![
            Target::at_most("T14", t("check × prost", "check × prost"), 1.1, 0.8, ours[0] / peer[0]),
            Target::at_most("T14", t("debug 构建 × prost", "debug build × prost"), 1.1, 0.8, ours[1] / peer[1]),
            Target::at_most("T15", t("release 构建 × prost", "release build × prost"), 1.4, 1.2, ours[2] / peer[2]),
            Target::at_most("T15", t("从零构建 × prost", "cold build × prost"), 1.0, 0.5, ours[3] / peer[3]),
        ],
    }
}
