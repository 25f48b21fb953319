//! Synthetic specs of any size. Each command has a request and a response with eight fields.

use std::fmt::Write as _;
use std::io;
use std::path::Path;

/// Number of commands in a group. Each group is one file.
const GROUP: usize = 60;
/// Code of the first command.
const FIRST_CODE: usize = 0x1000;
/// The file with frame format, envelope, results and code ranges.
const PROTOCOL: &str = include_str!("protocol.yaml");

/// Fields of every message: key on the wire, type in the spec, type in protobuf, example, English title.
const FIELDS: &[[&str; 5]] = &[
    ["recordId", "i64", "int64", "1671124918008", "Id of the record"],
    ["recordName", "string", "string", "gate1", "Name of the record"],
    ["itemCount", "i32", "int32", "7", "Number of items"],
    ["posX", "f64", "double", "0.5", "Metres to the right"],
    ["posY", "f64", "double", "-1.25", "Metres ahead"],
    ["isActive", "bool", "bool", "true", "Whether it is in use"],
    ["remark", "string?", "optional string", "near the lift", "Remark of whoever made it"],
    ["levels", "[i32]", "repeated int32", "[1, 2, 3]", "Floors it belongs to"],
];

/// Writes a spec with this number of commands to `root/spec`.
///
/// # Errors
/// If a file cannot be written.
pub fn write_spec(root: &Path, commands: usize) -> io::Result<()> {
    let directory = root.join("spec/commands");
    std::fs::create_dir_all(&directory)?;
    std::fs::write(root.join("spec/protocol.yaml"), PROTOCOL)?;
    for group in 0..commands.div_ceil(GROUP) {
        let from = group * GROUP;
        let text = group_of(group, from..commands.min(from + GROUP));
        std::fs::write(directory.join(format!("group{group:03}.yaml")), text)?;
    }
    Ok(())
}

fn group_of(group: usize, commands: std::ops::Range<usize>) -> String {
    let mut out = format!("group: {{ id: group{group:03}, zh: 第 {group} 组, en: Group {group} }}\n\ncommands:\n");
    for command in commands {
        let code = FIRST_CODE + command;
        let _ = write!(
            out,
            "  get_record_{command:04}:\n    code: 0x{code:04X}\n    zh: 获取记录 {command}\n    en: Get record {command}\n    effect: read\n    since: 2024-01\n    source: {{ sections: [] }}\n"
        );
        for body in ["request", "response"] {
            let _ = writeln!(out, "    {body}:");
            for [key, ty, _, example, en] in FIELDS {
                let _ =
                    writeln!(out, "      {key}: {{ type: \"{ty}\", example: {example}, zh: 字段 {key}, en: {en} }}");
            }
        }
    }
    out
}

/// Returns the same messages in protobuf.
#[must_use]
pub fn proto(commands: usize) -> String {
    let mut out = "syntax = \"proto3\";\npackage synthetic;\n".to_owned();
    for command in 0..commands {
        for body in ["Request", "Response"] {
            let _ = writeln!(out, "\n// {body} of record {command}.\nmessage GetRecord{command:04}{body} {{");
            for (index, [key, _, ty, _, en]) in FIELDS.iter().enumerate() {
                let _ = writeln!(out, "  // {en}\n  {ty} {} = {};", snake(key), index + 1);
            }
            out.push_str("}\n");
        }
    }
    out
}

fn snake(key: &str) -> String {
    key.chars().fold(String::new(), |mut out, letter| {
        if letter.is_ascii_uppercase() {
            out.push('_');
        }
        out.push(letter.to_ascii_lowercase());
        out
    })
}
