//! The examples of `fcproto explain`: the bad one raises its code, and the good one in the same place does not.
//!
//! An example shows a few lines without their surroundings: fields, keys of a command, or a section. The test inserts
//! them at every place of a small valid spec (`good/`) that can hold such lines. In at least one place, the bad example
//! must have the code and the good one must not. `syntax_explain` parses the examples of syntax codes.

use fc_spec::diagnostic::{FaultCode, Faults};
use fc_spec::load::load;
use fc_spec::model::Lang;
use fc_spec::source::Sources;
use std::collections::BTreeSet;
use std::path::Path;

/// Codes whose examples need more context than one place gives: the whole frame, a table of result codes, or several
/// places at once. The fixtures in `bad/` cover these codes.
const SPREAD: [&str; 10] = [
    "FC0217", "FC0218", "FC0302", "FC0501", "FC0502", "FC0510", "FC0514", "FC0516", "FC0610",
    "FC0611",
];

/// Returns each key at the left margin of a text, with all of its lines.
fn entries(text: &str) -> Vec<(String, String)> {
    let mut entries: Vec<(String, String)> = Vec::new();
    for line in text
        .lines()
        .filter(|line| !line.trim_start().starts_with('#'))
    {
        match entries.last_mut() {
            Some((_, lines)) if line.starts_with(' ') || line.is_empty() => {
                lines.push_str(line);
                lines.push('\n');
            }
            _ => {
                let key = line.split(':').next().unwrap_or_default();
                entries.push((key.to_owned(), format!("{line}\n")));
            }
        }
    }
    entries
}

fn indented(text: &str, depth: usize) -> String {
    let pad = " ".repeat(depth);
    text.lines().map(|line| format!("{pad}{line}\n")).collect()
}

/// Returns `text` with an example at the end of the mapping or list at `path`. Entries with the same key are replaced.
/// Returns `None` if there is no such place.
fn put(text: &str, path: &[&str], example: &str) -> Option<String> {
    let all = entries(text);
    let Some((first, rest)) = path.split_first() else {
        if example.starts_with('-') {
            return text
                .trim_start()
                .starts_with('-')
                .then(|| format!("{text}{example}"));
        }
        let new = entries(example);
        let stays = |(key, _): &&(String, String)| !new.iter().any(|(other, _)| other == key);
        let kept: String = all
            .iter()
            .filter(stays)
            .map(|(_, lines)| lines.as_str())
            .collect();
        return Some(kept + example);
    };
    if !all.iter().any(|(key, _)| key == first) {
        return None;
    }
    let mut out = String::new();
    for (key, lines) in all {
        let Some((head, body)) = lines.split_once('\n').filter(|_| key == *first) else {
            out.push_str(&lines);
            continue;
        };
        // A mapping on one line, `key: { a: 1 }`, cannot take the lines of an example.
        if head.contains(": {") {
            return None;
        }
        let depth = body.len() - body.trim_start_matches(' ').len();
        let inner: String = body
            .lines()
            .map(|line| format!("{}\n", line.get(depth..).unwrap_or_default()))
            .collect();
        out.push_str(head);
        out.push('\n');
        out.push_str(&indented(&put(&inner, rest, example)?, depth));
    }
    Some(out)
}

/// Returns a line for each of `keys` that the example does not have.
fn lacking(example: &str, keys: &[(&str, &str)]) -> String {
    let said = entries(example);
    let lacks = |key: &str| !said.iter().any(|(other, _)| other == key);
    keys.iter()
        .filter(|(key, _)| lacks(key))
        .map(|(key, value)| format!("{key}: {value}\n"))
        .collect()
}

const COMMAND: &[(&str, &str)] = &[
    ("code", "0x0102"),
    ("zh", "动作"),
    ("en", "Do it"),
    ("effect", "read"),
    ("source", "{ sections: [] }"),
];
const STREAM: &[(&str, &str)] = &[
    ("code", "0x0502"),
    ("zh", "数据流"),
    ("en", "A stream"),
    ("from", "robot"),
    ("source", "{ sections: [] }"),
];
const FIELD: &[(&str, &str)] = &[
    ("type", "string"),
    ("example", "a"),
    ("zh", "字段"),
    ("en", "A field"),
];
const TEXTS: &[(&str, &str)] = &[("zh", "类型"), ("en", "A type")];
const GROUP: &str = "group: { id: examples, zh: 例子, en: Examples }\n";

/// Returns the commands of an example, with the required keys that it leaves out.
fn as_commands(example: &str) -> String {
    let mut commands = String::new();
    for (key, lines) in entries(example) {
        let inline = lines
            .trim_end()
            .split_once(": {")
            .map(|(_, rest)| rest.trim_end_matches('}').to_owned());
        let keys: String = match inline {
            Some(pairs) => pairs
                .split(", ")
                .map(|pair| format!("{}\n", pair.trim()))
                .collect(),
            None => lines
                .lines()
                .skip(1)
                .map(|line| format!("{}\n", line.strip_prefix("  ").unwrap_or(line)))
                .collect(),
        };
        let keys = lacking(&keys, COMMAND) + &keys;
        commands.push_str(&format!("{key}:\n{}", indented(&keys, 2)));
    }
    commands
}

/// Returns additional files for the good spec, each with the example in another kind of place.
fn files(example: &str) -> Vec<(String, String)> {
    let whole = |inner: &str, section: &str| format!("{section}:\n{}", indented(inner, 2));
    let command = |keys: &str| {
        let keys = lacking(keys, COMMAND) + keys;
        GROUP.to_owned() + &whole(&whole(&keys, "do_it"), "commands")
    };
    let stream = lacking(example, STREAM) + example;
    let fields = |inner: &str, side: &str| command(&whole(inner, side));
    let field = lacking(example, FIELD) + example;
    let commands = as_commands(example);
    let inner: String = entries(example)
        .iter()
        .filter(|(key, _)| key == "commands")
        .flat_map(|(_, lines)| lines.lines().skip(1))
        .map(|line| format!("{}\n", line.strip_prefix("  ").unwrap_or(line)))
        .collect();
    let group = |text: String| ("spec/commands/z.yaml".to_owned(), text);
    let shared = |text: String| ("spec/z.yaml".to_owned(), text);
    let enumeration = format!("{}enum: u8\n{example}", lacking(example, TEXTS));
    let choice = lacking(example, TEXTS) + example;
    let kinds = lacking(example, TEXTS);
    let table = format!("zh: 表\nen: A table\nrow: CellLayout\n{example}");
    vec![
        shared(example.to_owned()),
        group(example.to_owned()),
        group(GROUP.to_owned() + example),
        group(command(example)),
        group(GROUP.to_owned() + &whole(&whole(&stream, "a_stream"), "streams")),
        group(GROUP.to_owned() + &whole(&commands, "commands")),
        group(GROUP.to_owned() + &whole(&as_commands(&inner), "commands")),
        group(GROUP.to_owned() + &whole(example, "commands")),
        group(fields(example, "request")),
        group(fields(example, "response")),
        group(fields(&whole(&field, "thing"), "request")),
        shared(whole(example, "types")),
        shared(whole(&whole(&enumeration, "Thing"), "types")),
        shared(whole(&whole(&choice, "Thing"), "types")),
        shared(whole(
            &whole(
                &format!("{kinds}fields:\n{}", indented(example, 2)),
                "Thing",
            ),
            "types",
        )),
        shared(whole(&whole(&table, "things"), "tables")),
    ]
}

/// Places in the good spec's `protocol.yaml` that may hold an example.
const PLACES: &[&[&str]] = &[
    &[],
    &["transport"],
    &["transport", "ports"],
    &["frame"],
    &["frame", "header"],
    &["frame", "kinds"],
    &["envelope"],
    &["envelope", "request"],
    &["envelope", "response"],
    &["codes"],
    &["codes", "ranges"],
];

fn read(path: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/good")
        .join(path);
    std::fs::read_to_string(path).expect("the good spec")
}

/// Declares the names that examples use without declaring them.
const BACKGROUND: &str = "group: { id: known, zh: 已知, en: Known }
commands:
  get_station:
    code: unassigned
    zh: 站点
    en: Get a station
    effect: read
    source: { sections: [] }
    response:
      station: Station
      stationType: StationType
      state: SwitchState
      recharge: RechargeStatus
      layout: CellLayout
      cell: CellType
types:
  Station: { zh: 站点, en: Station, fields: { x: { type: f64, example: 0.5, zh: 横坐标, en: Coordinate } } }
  StationType: { enum: u8, zh: 种类, en: Kind, values: { 0: { name: plain, zh: 普通, en: Plain } } }
  SwitchState: { enum: string, zh: 开关, en: Switch, values: { \"on\": { name: turned_on, zh: 开, en: On } } }
  RechargeStatus: { enum: u8, zh: 状态, en: State, values: { 3: { name: done, zh: 完成, en: Done } } }
  CellLayout: { zh: 分格, en: Layout, fields: { index: { type: u8, example: 1, zh: 序号, en: Index } } }
  CellType: { enum: u8, zh: 大小, en: Size, values: { 1: { name: small, zh: 小, en: Small } } }
";

/// Returns the files of the good spec. If `known`, they also declare the names that examples use.
fn base(known: bool) -> Vec<(String, String)> {
    let [mut protocol, mut demo] = ["protocol.yaml", "commands/demo.yaml"].map(read);
    let mut files = Vec::new();
    if known {
        for (from, to) in [
            (
                "  ranges:\n",
                "  ranges:\n    - { from: 0x0A01, to: 0x0AFF, use: commands, zh: 新增, en: New }\n",
            ),
            ("    result: {", "    resultCode: {"),
            ("  2: { name: timeout", "  2002: { name: timeout"),
        ] {
            assert!(protocol.contains(from), "{from}");
            protocol = protocol.replacen(from, to, 1);
        }
        demo = demo
            .replace("errors: [2, 3]", "errors: [3]")
            .replace("C001", "C040");
        files.push(("spec/commands/known.yaml".to_owned(), BACKGROUND.to_owned()));
    }
    files.push(("spec/protocol.yaml".to_owned(), protocol));
    files.push(("spec/commands/demo.yaml".to_owned(), demo));
    files
}

fn codes(files: Vec<(String, String)>) -> BTreeSet<String> {
    let mut faults = Faults::new();
    let _ = load(&Sources::from_texts(files), &mut faults);
    let codes = faults.iter().map(|fault| fault.code.as_str().to_owned());
    codes.collect()
}

/// Returns the good spec with the example in each of the places, in a fixed order. A place that cannot hold the example
/// gives an empty spec.
fn specs(blocks: &[String]) -> Vec<Vec<(String, String)>> {
    let mut all = Vec::new();
    let example = blocks.concat();
    for known in [false, true] {
        // Each block becomes a file. Its sections replace those that a spec can have only once.
        let mut together = base(known);
        let said: Vec<String> = entries(&example).into_iter().map(|(key, _)| key).collect();
        for (_, text) in &mut together {
            *text = entries(text)
                .into_iter()
                .filter(|(key, _)| {
                    !said.contains(key) || ["commands", "types", "group"].contains(&key.as_str())
                })
                .map(|(_, lines)| lines)
                .collect();
        }
        for (number, block) in blocks.iter().enumerate() {
            let folder = if block.contains("group:") {
                "commands/"
            } else {
                ""
            };
            together.push((format!("spec/{folder}z{number}.yaml"), block.clone()));
        }
        all.push(together);
        for file in files(&example) {
            let mut files = base(known);
            files.push(file);
            all.push(files);
        }
        for place in PLACES {
            let mut files = base(known);
            let protocol = files
                .iter_mut()
                .find(|(path, _)| path == "spec/protocol.yaml");
            let (_, text) = protocol.expect("the protocol");
            let there = put(text, place, &example);
            all.push(match there {
                Some(changed) => {
                    *text = changed;
                    files
                }
                None => Vec::new(),
            });
        }
    }
    all
}

/// Returns the fenced blocks of one kind from an explanation.
fn blocks(text: &str, kind: &str) -> Vec<String> {
    let open = format!("```yaml {kind}\n");
    let parts = text.split(&open).skip(1);
    parts
        .map(|rest| rest.split("```").next().unwrap_or_default().to_owned())
        .collect()
}

#[test]
fn bad_example_has_its_code_and_good_one_none() {
    let mut silent = Vec::new();
    for code in FaultCode::ALL {
        let code_name = code.as_str();
        if code_name.starts_with("FC00") || SPREAD.contains(&code_name) {
            continue;
        }
        let text = code.explain(Lang::En);
        let [bad, good] = ["bad", "good"].map(|kind| blocks(text, kind));
        assert!(!bad.is_empty() && !good.is_empty(), "{code_name}");
        let [bad, good] = [bad, good].map(|blocks| specs(&blocks));
        let shown = bad.into_iter().zip(good).any(|(bad, good)| {
            !bad.is_empty()
                && !good.is_empty()
                && codes(bad).contains(code_name)
                && !codes(good).contains(code_name)
        });
        if !shown {
            silent.push(code_name.to_owned());
        }
    }
    assert!(silent.is_empty(), "examples that show nothing: {silent:?}");
}

#[test]
fn every_example_is_yaml() {
    for code in FaultCode::ALL
        .iter()
        .filter(|code| !code.as_str().starts_with("FC00"))
    {
        for kind in ["bad", "good"] {
            for text in blocks(code.explain(Lang::En), kind) {
                // A file is a mapping, so a list becomes the value of a key.
                let text = if text.starts_with('-') {
                    format!("items:\n{text}")
                } else {
                    text
                };
                let mut faults = Faults::new();
                let _ = load(
                    &Sources::from_texts([("spec/a.yaml".to_owned(), text)]),
                    &mut faults,
                );
                let syntax = faults
                    .iter()
                    .find(|fault| fault.code.as_str() < "FC0100" && fault.code != *code);
                assert!(syntax.is_none(), "{code} {kind}: {syntax:?}");
            }
        }
    }
}
