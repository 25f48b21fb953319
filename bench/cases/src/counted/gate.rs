//! Counts the instructions of all cases and compares them with the budget.

use crate::work::{CASES, Case};
use serde_json::{Map, Value, json};
use std::path::{Path, PathBuf};
use std::process::Command;

/// Default of `margin_percent`, the allowed excess over the budget in percent.
const MARGIN: u64 = 10;
/// Directories whose changes affect the counts.
const MEASURED: &[&str] = &["fc-runtime", "fc-derive", "fc-generated", "fc-codegen", "fc-spec", "spec"];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn git(arguments: &[&str]) -> String {
    let output = Command::new("git").arg("-C").arg(root()).args(arguments).output();
    output.map(|output| String::from_utf8_lossy(&output.stdout).trim().to_owned()).unwrap_or_default()
}

/// Returns the measured commit, followed by `+changes` if the directories have uncommitted changes.
fn commit() -> String {
    let hash = git(&["rev-parse", "--short", "HEAD"]);
    let mut status = vec!["status", "--porcelain", "--"];
    status.extend(MEASURED);
    if git(&status).is_empty() { hash } else { format!("{hash}+changes") }
}

/// Returns the instructions of `counted CASE TIMES`, including start and end of the program.
fn collected(case: &str, times: usize) -> Result<u64, String> {
    let program = std::env::current_exe().map_err(|error| error.to_string())?;
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
        .arg(program)
        .args([case, &times.to_string()])
        .output()
        .map_err(|error| format!("cannot run valgrind: {error}; install it"))?;
    let text = String::from_utf8_lossy(&output.stderr);
    let count = text.lines().find_map(|line| line.split_once("Collected :")?.1.trim().parse().ok());
    match count {
        Some(count) if output.status.success() => Ok(count),
        _ => Err(format!("`{case}` failed under valgrind:\n{text}")),
    }
}

/// Returns the instructions of one unit of a case.
fn count(case: &Case) -> Result<u64, String> {
    let (few, many) = if case.times == 1 { (0, 1) } else { (case.times, case.times * 2) };
    let more = collected(case.name, many)?.saturating_sub(collected(case.name, few)?);
    Ok(more / ((many - few) * case.units) as u64)
}

/// Counts all cases, prints the counts, and compares them with the budget. Returns `false` if a case exceeds its budget
/// by more than the margin.
///
/// # Errors
/// If a case cannot be counted, or the budget cannot be read or written.
pub fn run(accept: bool) -> Result<bool, String> {
    let path = root().join("bench/budget.json");
    let budget: Value = match std::fs::read_to_string(&path) {
        Ok(text) => serde_json::from_str(&text).map_err(|error| format!("bench/budget.json: {error}"))?,
        Err(_) if accept => json!({}),
        Err(error) => return Err(format!("bench/budget.json: {error}; write it with --accept")),
    };
    let margin = budget["margin_percent"].as_u64().unwrap_or(MARGIN);
    let accepted = budget["commit"].as_str().unwrap_or("nowhere").to_owned();
    let now = commit();
    let mut counts = Map::new();
    let mut over = Vec::new();
    println!("{:<14} {:>13} {:>13} {:>8}", "case", "instructions", "budget", "change");
    for case in CASES {
        let count = count(case)?;
        let allowed = budget["instructions"][case.name].as_u64();
        let change = allowed.map_or("new".to_owned(), |allowed| {
            format!("{:+.1} %", (count as f64 / allowed.max(1) as f64 - 1.0) * 100.0)
        });
        let shown = allowed.map_or("-".to_owned(), |allowed| allowed.to_string());
        println!("{:<14} {count:>13} {shown:>13} {change:>8}  per {}", case.name, case.unit);
        if allowed.is_none_or(|allowed| count > allowed + allowed * margin / 100) {
            over.push(case.name);
        }
        counts.insert(case.name.to_owned(), count.into());
    }
    if accept {
        let text = json!({ "commit": now, "margin_percent": margin, "instructions": counts });
        let text = serde_json::to_string_pretty(&text).map_err(|error| error.to_string())?;
        std::fs::write(&path, text + "\n").map_err(|error| format!("bench/budget.json: {error}"))?;
        println!("accepted at {now}");
        return Ok(true);
    }
    if over.is_empty() {
        println!("{now} is within {margin} % of the budget of {accepted}");
        return Ok(true);
    }
    println!("\n{now} takes more than {margin} % over the budget of {accepted}: {}", over.join(", "));
    let range = format!("{}..HEAD", accepted.trim_end_matches("+changes"));
    let mut log = vec!["log", "--oneline", "--no-decorate", &range, "--"];
    log.extend(MEASURED);
    let commits = git(&log);
    if !commits.is_empty() {
        println!("commits since:\n{commits}");
    }
    println!("mend it, or accept it with `bench/budget --accept` and say why in the commit");
    Ok(false)
}
