//! Measures the generator with the project's spec, and compares it with prost on synthetic specs.

mod once;

pub use once::{ours, prost, read};

use crate::process::{Figures, Process};
use crate::report::{Section, Table, Target, Text, digits, median, ratio, seconds, t};
use fc_bench_cases::synthetic;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// Numbers of commands in the synthetic specs.
const SIZES: &[usize] = &[60, 600, 6000];
/// Argument that selects all products.
const ALL: &str = "all";

fn run(program: &Path, arguments: &[&str]) -> Figures {
    Process::start(program, arguments, None).figures()
}

fn path(directory: &TempDir) -> &str {
    directory.path().to_str().expect("a plain path")
}

/// The seconds of each step of a run, and its peak memory in MiB.
struct Run {
    steps: Vec<f64>,
    memory: f64,
}

impl Run {
    fn of(mut figures: Figures, steps: usize) -> Self {
        let memory = figures[steps];
        figures.truncate(steps);
        Self { steps: figures, memory }
    }

    fn total(&self) -> f64 {
        self.steps.iter().sum()
    }
}

/// Removes the files that the last run has written below `root`.
fn clean(root: &Path) {
    for entry in std::fs::read_dir(root).expect("a directory") {
        let path = entry.expect("an entry").path();
        let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        if name == "fc-manifest.json" || path.extension().is_some_and(|extension| extension == "rs") {
            std::fs::remove_file(path).expect("a file of ours");
        } else if path.is_dir() && name != "spec" {
            std::fs::remove_dir_all(path).expect("a directory of ours");
        }
    }
    let _ = std::fs::remove_file(root.join("spec/fc-spec.schema.json"));
}

fn generated(program: &Path, root: &TempDir, products: &str) -> Run {
    clean(root.path());
    Run::of(run(program, &["generate-once", path(root), products]), once::STEPS)
}

/// Copies the project's spec to a temporary directory.
fn project() -> TempDir {
    let spec = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../spec"));
    let root = tempfile::tempdir().expect("a directory");
    std::fs::create_dir_all(root.path().join("spec/commands")).expect("a directory");
    for directory in ["", "commands"] {
        for entry in std::fs::read_dir(spec.join(directory)).expect("the spec") {
            let path = entry.expect("an entry").path();
            if path.extension().is_some_and(|extension| extension == "yaml") {
                let name = path.file_name().expect("a name");
                std::fs::copy(&path, root.path().join("spec").join(directory).join(name)).expect("a copy");
            }
        }
    }
    root
}

fn whole_spec(program: &Path, rounds: usize) -> Table {
    eprintln!("generator: the whole spec");
    let root = project();
    let mut reads = Vec::new();
    let mut runs = Vec::new();
    for _ in 0..rounds {
        reads.push(run(program, &["read-once", path(&root)]));
        runs.push(generated(program, &root, ALL));
    }
    let read = median(reads.iter().map(|figures| figures[0]));
    let columns = vec![t("步骤", "step"), t("时间", "time"), t("× 只读文件", "× reading the files")];
    let title = t("本项目的全部规范，全部产物", "The whole spec of this project, all products");
    let mut table = Table::new(title, columns);
    let step = |index: usize| median(runs.iter().map(|run| run.steps[index]));
    let rows: Vec<(Text, f64)> = vec![
        (t("只读文件", "reading the files, nothing else"), read),
        (t("读入", "read"), step(0)),
        (t("解析并检查", "parse and check"), step(1)),
        (t("生成", "generate"), step(2)),
        (t("比较并写出", "compare and write"), step(3)),
        (t("合计", "all of it"), median(runs.iter().map(Run::total))),
    ];
    for (name, value) in rows {
        table.row(vec![name, seconds(value).into(), ratio(value, read).into()]);
    }
    let memory = format!("{} MiB", digits(median(runs.iter().map(|run| run.memory))));
    table.row(vec![t("内存峰值", "peak memory"), memory.into(), "".into()]);
    table
}

/// Medians for one number of commands. Pairs are seconds and peak memory in MiB.
struct Sized {
    commands: usize,
    read: f64,
    rust: (f64, f64),
    all: (f64, f64),
    prost: (f64, f64),
}

fn sized(program: &Path, commands: usize, rounds: usize) -> Sized {
    eprintln!("generator: {commands} commands");
    let root = tempfile::tempdir().expect("a directory");
    synthetic::write_spec(root.path(), commands).expect("the spec is written");
    let proto = root.path().join("synthetic.proto");
    std::fs::write(proto, synthetic::proto(commands)).expect("the file is written");
    let (mut reads, mut rust, mut all, mut peers) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for _ in 0..rounds {
        reads.push(run(program, &["read-once", path(&root)])[0]);
        rust.push(generated(program, &root, "rust"));
        peers.push(Run::of(run(program, &["generate-prost", path(&root)]), 1));
    }
    // The files of all products can take half a gigabyte. The system writes them to disk for seconds, so these runs
    // come last and do not slow the others down.
    for _ in 0..rounds {
        all.push(generated(program, &root, ALL));
    }
    let of = |runs: &[Run]| (median(runs.iter().map(Run::total)), median(runs.iter().map(|run| run.memory)));
    Sized { commands, read: median(reads), rust: of(&rust), all: of(&all), prost: of(&peers) }
}

fn sizes_table(sizes: &[Sized]) -> Table {
    let columns = vec![
        t("指令数", "commands"),
        t("只读文件", "reading the files"),
        t("fc，Rust", "fc, Rust"),
        t("fc，全部产物", "fc, all products"),
        "prost + protox".into(),
        t("fc Rust / prost", "fc Rust / prost"),
        t("峰值 MiB：fc Rust", "peak MiB: fc Rust"),
        t("fc 全部产物", "fc, all products"),
        "prost + protox".into(),
    ];
    let title =
        t("合成规范：每个指令的请求和响应各 8 个字段", "Synthetic specs: eight fields in each request and response");
    let mut table = Table::new(title, columns);
    for one in sizes {
        table.row(vec![
            one.commands.to_string().into(),
            seconds(one.read).into(),
            seconds(one.rust.0).into(),
            seconds(one.all.0).into(),
            seconds(one.prost.0).into(),
            ratio(one.rust.0, one.prost.0).into(),
            digits(one.rust.1).into(),
            digits(one.all.1).into(),
            digits(one.prost.1).into(),
        ]);
    }
    table
}

/// Measures this group and returns its section.
pub fn section(quick: bool) -> Section {
    let program = std::env::current_exe().expect("own path");
    let whole = whole_spec(&program, if quick { 3 } else { 11 });
    let sizes: Vec<Sized> = SIZES
        .iter()
        .map(|&commands| {
            // Short runs vary more and need more rounds.
            let (short, long) = match commands {
                ..600 => (5, 25),
                600..6000 => (3, 9),
                _ => (1, 3),
            };
            sized(&program, commands, if quick { short } else { long })
        })
        .collect();
    let find = |commands: usize| sizes.iter().find(|one| one.commands == commands).expect("a size");
    let (small, large) = (find(60), find(6000));
    Section {
        title: t("生成器", "Generator"),
        about: t(
            "每次运行是一个单独的进程，从读文件到写出全部文件。\n\n\
             - “Rust”只生成 Rust，与 prost-build + protox（不用 protoc，含排版）对同样的消息相比。\n\
             - “全部产物”另有中英文文档、标准帧、另外四种语言的软件包，以及 JSON Schema。",
            "Each run is a separate process, from reading the files to writing all files.\n\n\
             - *Rust* generates only Rust. It is compared with prost-build and protox (no protoc, formatting included) \
             on the same messages.\n\
             - *All products* adds the documentation in Chinese and English, golden frames, the packages of the four \
             other languages, and the JSON Schema.",
        ),
        tables: vec![whole, sizes_table(&sizes)],
        targets: vec![
            Target::at_most(
                "T13",
                t("60 个指令，Rust / prost", "60 commands, Rust / prost"),
                0.6,
                0.4,
                small.rust.0 / small.prost.0,
            ),
            Target::at_most(
                "T13",
                t("6000 个指令，Rust / prost", "6000 commands, Rust / prost"),
                0.3,
                0.2,
                large.rust.0 / large.prost.0,
            ),
            Target::at_most(
                "T13",
                t("6000 个指令，Rust，内存峰值", "6000 commands, Rust, peak memory"),
                120.0,
                81.0,
                large.rust.1,
            )
            .unit(" MiB"),
        ],
    }
}
