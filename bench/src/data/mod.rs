//! Measures the data port: its throughput, its effect on commands, and its memory.

mod app;
mod plain;
mod robot;

pub use app::drive;
pub use robot::serve;

use crate::process::{Process, cores};
use crate::report::{Section, Table, Target, Text, digits, median, ratio, t};
use std::path::Path;

type Seconds = f64;

/// Code in the frames of chunks.
const CODE: u16 = 1;
/// Payload of a gigabit link, in bytes per second.
const GIGABIT: f64 = 118e6;

/// Transport of the chunks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A plain socket.
    Tcp,
    /// A plain socket, with a digest that the sender computes and the receiver checks.
    TcpMd5,
    /// The data port of fc.
    Fc,
}

const KINDS: &[(Kind, &str)] = &[(Kind::Tcp, "tcp"), (Kind::TcpMd5, "tcp + MD5"), (Kind::Fc, "fc")];

impl Kind {
    /// Returns the kind with this name on the command line.
    pub fn named(name: &str) -> Self {
        KINDS.iter().find(|(_, known)| *known == name).expect("a kind").0
    }

    fn name(self) -> &'static str {
        KINDS.iter().find(|(kind, _)| *kind == self).expect("a kind").1
    }
}

/// Direction of the chunks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// Robot to app.
    Down,
    /// App to robot.
    Up,
    /// No chunks.
    Idle,
}

/// The chunks that a process sends or receives.
#[derive(Clone, Copy, Debug)]
pub struct Load {
    direction: Direction,
    chunk: usize,
    count: usize,
    bytes_per_second: Option<f64>,
}

impl Load {
    /// Parses a load from the command line.
    pub fn parse(words: &[&str]) -> Self {
        let number = |at: usize| words.get(at).and_then(|word| word.parse::<usize>().ok()).unwrap_or(0);
        let direction = match words.first() {
            Some(&"down") => Direction::Down,
            Some(&"up") => Direction::Up,
            _ => Direction::Idle,
        };
        let rate = number(3);
        Self { direction, chunk: number(1), count: number(2), bytes_per_second: (rate > 0).then_some(rate as f64) }
    }

    fn words(self) -> [String; 4] {
        let direction = match self.direction {
            Direction::Down => "down",
            Direction::Up => "up",
            Direction::Idle => "idle",
        };
        let rate = self.bytes_per_second.unwrap_or(0.0) as usize;
        [direction.to_owned(), self.chunk.to_string(), self.count.to_string(), rate.to_string()]
    }

    fn is_endless(self) -> bool {
        self.count == usize::MAX
    }
}

fn digested(data: &[u8]) -> [u8; 16] {
    fast_md5::digest(data)
}

/// The figures of one transfer.
#[derive(Clone, Copy)]
struct Transfer {
    /// Throughput, in MB/s.
    rate: f64,
    /// CPU seconds of both sides per GB.
    cpu: f64,
    robot_memory: f64,
    app_memory: f64,
}

/// Starts a robot. Returns its process and the addresses of its command port and data port.
fn start_robot(
    program: &Path,
    kind: Kind,
    multi_thread: bool,
    load: Load,
    core: Option<usize>,
) -> (Process, String, String) {
    let words = load.words();
    let threads = if multi_thread { "threads" } else { "single" };
    let mut arguments = vec!["data-serve", kind.name(), threads];
    arguments.extend(words.iter().map(String::as_str));
    let mut robot = Process::start(program, &arguments, core);
    let line = robot.line();
    let (commands, data) = line.split_once(' ').expect("two addresses");
    (robot, commands.to_owned(), data.to_owned())
}

fn start_app(program: &Path, kind: Kind, address: &str, load: Load, core: Option<usize>) -> Process {
    let words = load.words();
    let mut arguments = vec!["data-drive", kind.name(), address];
    arguments.extend(words.iter().map(String::as_str));
    Process::start(program, &arguments, core)
}

fn transfer(program: &Path, kind: Kind, load: Load) -> Transfer {
    let (first, second) = cores();
    let (mut robot, _, address) = start_robot(program, kind, false, load, first);
    let mut app = start_app(program, kind, &address, load, second);
    if load.direction == Direction::Down {
        app.line();
    }
    let (app, robot) = (app.figures(), robot.figures());
    let seconds = app[0].max(robot[0]);
    let bytes = (load.chunk * (load.count - 1)) as f64;
    Transfer {
        rate: bytes / seconds / 1e6,
        cpu: (app[1] + robot[1]) / bytes * 1e9,
        robot_memory: robot[2],
        app_memory: app[2],
    }
}

fn throughput(program: &Path, quick: bool) -> (Table, Vec<Target>) {
    let total = if quick { 128 << 20 } else { 512 << 20 };
    let columns = vec![
        t("方向", "direction"),
        t("每帧", "frame"),
        "".into(),
        "MB/s".into(),
        "× tcp".into(),
        "× tcp + MD5".into(),
        t("CPU 秒/GB", "CPU s/GB"),
        "CPU × tcp + MD5".into(),
    ];
    let mut table = Table::new(t("持续吞吐", "Sustained throughput"), columns);
    let mut targets = Vec::new();
    for (direction, name) in
        [(Direction::Down, t("机器人 → app", "robot → app")), (Direction::Up, t("app → 机器人", "app → robot"))]
    {
        for (chunk, size) in [(64 << 10, "64 KiB"), (1 << 20, "1 MiB")] {
            let load = Load { direction, chunk, count: total / chunk, bytes_per_second: None };
            eprintln!("data: {} in frames of {size}", name.get(crate::report::Language::English));
            let mut rounds = vec![Vec::new(); KINDS.len()];
            for _ in 0..if quick { 2 } else { 5 } {
                for (index, (kind, _)) in KINDS.iter().enumerate() {
                    rounds[index].push(transfer(program, *kind, load));
                }
            }
            let of = |index: usize, figure: fn(&Transfer) -> f64| median(rounds[index].iter().map(figure));
            for (index, (_, kind)) in KINDS.iter().enumerate() {
                let (rate, cpu) = (of(index, |one| one.rate), of(index, |one| one.cpu));
                table.row(vec![
                    name.clone(),
                    size.into(),
                    (*kind).into(),
                    digits(rate).into(),
                    ratio(rate, of(0, |one| one.rate)).into(),
                    ratio(rate, of(1, |one| one.rate)).into(),
                    digits(cpu).into(),
                    ratio(cpu, of(1, |one| one.cpu)).into(),
                ]);
            }
            if chunk == 1 << 20 {
                let value = of(2, |one| one.rate) / of(1, |one| one.rate);
                let (zh, en) = match direction {
                    Direction::Down => {
                        ("机器人 → app，1 MiB，吞吐 × tcp + MD5", "robot → app, 1 MiB, throughput × tcp + MD5")
                    }
                    _ => ("app → 机器人，1 MiB，吞吐 × tcp + MD5", "app → robot, 1 MiB, throughput × tcp + MD5"),
                };
                targets.push(Target::at_least("D1", t(zh, en), 0.8, 0.95, value));
            }
        }
    }
    (table, targets)
}

/// The load during the calls, and the threads of the robot.
#[derive(Clone, Copy)]
struct Busy {
    load: Option<(Kind, Option<f64>)>,
    /// `true` for a robot with two workers, `false` for one with a single thread.
    workers: bool,
}

/// Returns the latency of calls during a load, p50 and p99 in microseconds.
fn latency(program: &Path, busy: Busy, calls: usize) -> [f64; 2] {
    let load = busy.load;
    let idle = Load { direction: Direction::Idle, chunk: 0, count: 0, bytes_per_second: None };
    let of = |rate| Load { direction: Direction::Down, chunk: 1 << 20, count: usize::MAX, bytes_per_second: rate };
    // The data port of fc belongs to the robot that receives the calls. A plain load has separate processes.
    let own = load.filter(|(kind, _)| *kind == Kind::Fc).map_or(idle, |(_, rate)| of(rate));
    let (_robot, commands, data) = start_robot(program, Kind::Fc, busy.workers, own, None);
    let mut others = Vec::new();
    match load {
        Some((Kind::Fc, _)) => others.push(start_app(program, Kind::Fc, &data, own, None)),
        Some((kind, rate)) => {
            let (robot, _, address) = start_robot(program, kind, true, of(rate), None);
            others.push(robot);
            others.push(start_app(program, kind, &address, of(rate), None));
        }
        None => {}
    }
    if let Some(app) = others.last_mut() {
        app.line();
    }
    let driver = Process::start(program, &["drive", "fc", &commands, "one", &calls.to_string()], None);
    let figures = driver.end();
    [figures[1], figures[2]]
}

fn latencies(program: &Path, quick: bool) -> (Table, Vec<Target>) {
    let busy = |workers, load| Busy { load, workers };
    let flat_out = Some((Kind::Fc, None));
    let arms: [(Text, Busy); 6] = [
        (t("数据端口空闲", "data port idle"), busy(true, None)),
        (
            t("千兆链路跑满（118 MB/s）", "a gigabit link's worth (118 MB/s)"),
            busy(true, Some((Kind::Fc, Some(GIGABIT)))),
        ),
        (t("数据端口尽力跑满", "data port as fast as it goes"), busy(true, flat_out)),
        (
            t("对照：另两个进程之间 tcp + MD5 尽力跑满", "tcp + MD5 between two other processes"),
            busy(true, Some((Kind::TcpMd5, None))),
        ),
        (t("机器人单线程，数据端口空闲", "robot on one thread, data port idle"), busy(false, None)),
        (t("机器人单线程，尽力跑满", "robot on one thread, as fast as it goes"), busy(false, flat_out)),
    ];
    let mut rounds = vec![Vec::new(); arms.len()];
    for turn in 0..if quick { 2 } else { 7 } {
        eprintln!("data: latency, round {}", turn + 1);
        for (index, (_, busy)) in arms.iter().enumerate() {
            rounds[index].push(latency(program, *busy, if quick { 1_500 } else { 4_000 }));
        }
    }
    let of = |index: usize, at: usize| median(rounds[index].iter().map(|latency| latency[at]));
    let columns = vec![t("情形", "case"), "p50, µs".into(), t("× 空闲", "× idle"), "p99, µs".into()];
    let mut table = Table::new(t("小指令的延迟", "Latency of a small command"), columns);
    for (index, (name, busy)) in arms.iter().enumerate() {
        let (p50, base) = (of(index, 0), of(if busy.workers { 0 } else { 4 }, 0));
        table.row(vec![name.clone(), digits(p50).into(), ratio(p50, base).into(), digits(of(index, 1)).into()]);
    }
    let medians = [of(0, 0), of(1, 0), of(2, 0)];
    let targets = vec![
        Target::at_most(
            "D2",
            t("p50，千兆链路跑满 / 空闲", "p50, a gigabit link's worth / idle"),
            2.0,
            1.3,
            medians[1] / medians[0],
        ),
        Target::at_most(
            "D2",
            t("p50，尽力跑满 / 空闲", "p50, as fast as it goes / idle"),
            2.0,
            1.3,
            medians[2] / medians[0],
        ),
    ];
    (table, targets)
}

fn memory(program: &Path, quick: bool) -> (Table, Target) {
    eprintln!("data: memory");
    let columns = vec![
        t("发送总量", "sent in all"),
        t("机器人峰值，MiB", "robot, peak MiB"),
        t("app 峰值，MiB", "app, peak MiB"),
    ];
    let title = t("内存：机器人 → app，每帧 1 MiB", "Memory: robot → app in frames of 1 MiB");
    let mut table = Table::new(title, columns);
    let mut peaks = Vec::new();
    // The fill of the queues varies by chance. The highest peak of several short runs shows their capacity.
    for (runs, count) in [(5, 1024), (1, if quick { 2048 } else { 8192 })] {
        let load = Load { direction: Direction::Down, chunk: 1 << 20, count, bytes_per_second: None };
        let runs: Vec<Transfer> = (0..runs).map(|_| transfer(program, Kind::Fc, load)).collect();
        let most = |figure: fn(&Transfer) -> f64| runs.iter().map(figure).fold(0.0, f64::max);
        let (robot, app) = (most(|one| one.robot_memory), most(|one| one.app_memory));
        let cells = [format!("{} × {count} MiB", runs.len()), digits(robot), digits(app)];
        table.row(cells.into_iter().map(Text::from).collect());
        peaks.push(robot.max(app));
    }
    let what = t("峰值内存，发送多 / 发送少", "peak memory, sending much / little");
    (table, Target::at_most("D3", what, 1.1, 1.02, peaks[1] / peaks[0]))
}

/// Measures this group and returns its section.
pub fn section(quick: bool) -> Section {
    let program = std::env::current_exe().expect("own path");
    let (throughput, mut targets) = throughput(&program, quick);
    let (latencies, more) = latencies(&program, quick);
    let (memory, flat) = memory(&program, quick);
    targets.extend(more);
    targets.push(flat);
    Section {
        title: t("数据端口", "Data port"),
        about: t(
            "`tcp` 只在两个套接字之间搬运。`tcp + MD5` 还在发送端计算、在接收端核对每帧的 MD5，这是协议的最低要求。\n\n\
             测量吞吐时，两个进程各占一个核。测量延迟时不绑核，机器人有两个工作线程，调用逐个进行。“对照”一行让同样的负\
             载跑在别的进程里，显示争用 CPU 本身的影响。",
            "`tcp` only copies between two sockets. `tcp + MD5` also makes the digest of every frame on one side and \
             checks it on the other, the minimum that the protocol requires.\n\n\
             For throughput, each process has one core. For latency, no process is pinned, the robot has two workers, \
             and calls go one at a time. The row *tcp + MD5 between two other processes* shows the effect of sharing \
             the processor.",
        ),
        tables: vec![throughput, latencies, memory],
        targets,
    }
}
