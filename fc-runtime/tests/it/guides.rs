//! The guides contain the defaults of the runtime, and the name of every end of a call.

use fc_runtime::{Backoff, ClientConfig, ServerConfig};
use std::fs;
use std::path::Path;

/// Guides with tables of defaults, and in how many rows they state one.
const GUIDES: [(&str, usize); 6] = [
    ("guides/connection.md", 6),
    ("en/guides/connection.md", 6),
    ("guides/connection-robot.md", 5),
    ("en/guides/connection-robot.md", 5),
    ("guides/limits.md", 10),
    ("en/guides/limits.md", 10),
];

/// The value of a field as `Debug` prints it.
fn field(shown: &str, name: &str) -> String {
    let (_, rest) = shown.split_once(&format!(" {name}: ")).expect(name);
    let end = rest.find([',', '}']).unwrap();
    let value = rest[..end].trim();
    let value = value.strip_prefix("Some(").unwrap_or(value);
    value.trim_end_matches(')').to_owned()
}

/// A default of a table, written as `Debug` prints it; `None` for what the table only describes.
fn stated(cell: &str) -> Option<String> {
    let cell = cell.trim().trim_matches('`');
    if ["None", "none", "无", "spec", "规范"].contains(&cell) {
        return Some("None".to_owned());
    }
    let digits = cell
        .find(|c: char| !c.is_ascii_digit())
        .unwrap_or(cell.len());
    let (number, rest) = cell.split_at(digits);
    let number = number.parse::<usize>().ok()?;
    // Numbers above a thousand contain a comma, so only a reader compares them.
    let unit = rest.strip_prefix(' ').map_or("", |rest| {
        let end = rest.find(|c: char| !c.is_ascii_alphabetic() && c != '/');
        &rest[..end.unwrap_or(rest.len())]
    });
    match unit {
        "s" | "ms" => Some(format!("{number}{unit}")),
        "MiB" => Some((number << 20).to_string()),
        "" | "B/s" => Some(number.to_string()),
        _ => None,
    }
}

#[fc_test::test]
fn guides_state_the_current_defaults() {
    let (client, server) = (ClientConfig::new(), ServerConfig::new());
    let (client, server) = (format!("{client:?}"), format!("{server:?}"));
    let backoff = format!("{:?}", Backoff::default());
    let site = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs-site");
    for (guide, rows) in GUIDES {
        let text = fs::read_to_string(site.join(guide)).unwrap();
        let mut compared = 0;
        for line in text.lines().filter(|line| line.starts_with("| `")) {
            let cells: Vec<&str> = line.split('|').map(str::trim).collect();
            let (Some(what), Some(stated)) = (cells.get(1), cells.get(2).and_then(|c| stated(c)))
            else {
                continue;
            };
            let names = what.split('`').skip(1).step_by(2);
            let mut held = 0;
            for name in names {
                let (shown, name) = match name.split_once("::") {
                    Some(("ClientConfig", name)) => (&client, name),
                    Some(("ServerConfig", name)) => (&server, name),
                    // `Limits` are the protocol's altogether.
                    Some(_) => continue,
                    None => (&backoff, name),
                };
                assert_eq!(field(shown, name), stated, "{guide}: {line}");
                held = 1;
            }
            compared += held;
        }
        assert_eq!(compared, rows, "{guide}: rows with a default");
    }
}

#[fc_test::test]
fn the_guides_name_every_end_of_a_call() {
    let source = include_str!("../../src/client/error.rs");
    let (_, names) = source.split_once("impl CallError {").unwrap();
    let (names, _) = names.split_once("\n}\n").unwrap();
    let names: Vec<&str> = names
        .lines()
        .filter_map(|line| line.trim().split_once("=> \"")?.1.strip_suffix("\","))
        .collect();
    assert!(names.contains(&"refused"), "{names:?}");
    let site = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs-site");
    for guide in [
        "guides/first-call-steps.md",
        "en/guides/first-call-steps.md",
    ] {
        let text = fs::read_to_string(site.join(guide)).unwrap();
        let rows: Vec<&str> = text
            .lines()
            .filter(|line| line.starts_with("| `"))
            .collect();
        for name in &names {
            let name = format!("`{name}`");
            let first = |row: &&&str| row.split('|').nth(1).unwrap().contains(&name);
            assert_eq!(rows.iter().filter(first).count(), 1, "{guide}: {name}");
        }
    }
}
