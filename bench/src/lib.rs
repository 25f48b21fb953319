//! Benchmarks of codec, calls, reports, data port, generator and generated code.
//!
//! Each group compares with a floor or with peers. Use only ratios within one run, because absolute times depend on the
//! machine and its load.

mod calls;
mod codec;
mod compile;
mod cost;
mod data;
mod generator;
mod machine;
mod measure;
mod process;
mod report;
mod reports;
pub mod twin;

use machine::Machine;
use report::{Language, Section, page, terminal};
use std::process::ExitCode;

const USAGE: &str = "\
Measures beside floors and peers.

usage: fc-bench GROUP... [--quick] [--report] [--date YYYY-MM-DD]
       fc-bench synthetic DIRECTORY COMMANDS     writes a spec of any size

groups: all codec calls reports data generator compile
--quick   fewer rounds: a look, no figures to go by
--report  with `all`: also write the results page of the documentation";

/// Function that measures a group. Its argument is `true` for `--quick`.
type Group = fn(bool) -> Section;

/// All groups, in the order of the report.
const GROUPS: &[(&str, Group)] = &[
    ("codec", codec::section),
    ("calls", calls::section),
    ("reports", reports::section),
    ("data", data::section),
    ("generator", generator::section),
    ("compile", compile::section),
];

/// Runs the program with the arguments of this process.
#[must_use]
pub fn run() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match words.as_slice() {
        ["codec-allocations"] => codec::print_allocations(),
        ["serve", peer, threads] => calls::serve(peer, *threads == "threads"),
        ["drive", peer, address, scenario, calls] => {
            let (address, calls) = (address.parse().expect("an address"), calls.parse().expect("a number"));
            calls::run_driver(peer, address, scenario, calls);
        }
        ["synthetic", root, commands] => {
            let (root, commands) = (std::path::Path::new(root), commands.parse().expect("a number"));
            fc_bench_cases::synthetic::write_spec(root, commands).expect("the spec is written");
        }
        ["generate-once", root, products] => generator::ours(root, products),
        ["generate-prost", root] => generator::prost(root),
        ["read-once", root] => generator::read(root),
        ["reports-serve", robot] => reports::serve(robot),
        ["reports-drive", robot, address, apps, slow] => {
            let number = |word: &str| word.parse().expect("a number");
            reports::drive(robot, address.parse().expect("an address"), number(apps), number(slow));
        }
        ["reports-fetch", address] => reports::fetch(address.parse().expect("an address")),
        ["data-serve", kind, threads, load @ ..] => {
            data::serve(data::Kind::named(kind), *threads == "threads", data::Load::parse(load));
        }
        ["data-drive", kind, address, load @ ..] => {
            data::drive(data::Kind::named(kind), address.parse().expect("an address"), data::Load::parse(load));
        }
        _ => return options(&words).map_or_else(usage, |options| groups(&options)),
    }
    ExitCode::SUCCESS
}

fn usage() -> ExitCode {
    eprintln!("{USAGE}");
    ExitCode::from(2)
}

#[derive(Default)]
struct Options {
    groups: Vec<Group>,
    quick: bool,
    report: bool,
    date: Option<String>,
}

fn options(words: &[&str]) -> Option<Options> {
    let mut options = Options::default();
    let mut words = words.iter();
    while let Some(&word) = words.next() {
        match word {
            "--quick" => options.quick = true,
            "--report" => options.report = true,
            "--date" => options.date = Some((*words.next()?).to_owned()),
            "all" => options.groups.extend(GROUPS.iter().map(|(_, group)| group)),
            name => options.groups.push(GROUPS.iter().find(|(known, _)| *known == name)?.1),
        }
    }
    let whole = options.groups.len() == GROUPS.len();
    (!options.groups.is_empty() && (whole || !options.report)).then_some(options)
}

fn groups(options: &Options) -> ExitCode {
    let machine = Machine::new(options.date.clone());
    println!("{}", machine.table().markdown(Language::English));
    let sections: Vec<Section> = options
        .groups
        .iter()
        .map(|group| {
            let section = group(options.quick);
            println!("{}", terminal(&section));
            section
        })
        .collect();
    if options.report {
        let guides = [("guides", Language::Chinese), ("en/guides", Language::English)];
        for (place, language) in guides {
            let directory = format!("{}/../docs-site/{place}", env!("CARGO_MANIFEST_DIR"));
            let text = page(&sections, &machine, options.quick, language);
            std::fs::create_dir_all(&directory).expect("the documentation's directory");
            std::fs::write(format!("{directory}/performance-results.md"), text).expect("the page is written");
        }
    }
    ExitCode::SUCCESS
}
