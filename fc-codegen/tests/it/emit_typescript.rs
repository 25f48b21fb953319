//! The type and the schema of each field in the TypeScript package.

use crate::good_spec;
use fc_codegen::emit::typescript;
use fc_codegen::target::Targets;
use fc_spec::diagnostic::{Faults, Format, render};
use fc_spec::load::load;
use fc_spec::model::{Lang, Model};
use fc_spec::source::Sources;
use std::collections::BTreeMap;

/// Returns the good spec with another file of commands.
fn model(text: &str) -> Model {
    let good = good_spec::FILES.map(|path| (format!("spec/{path}"), good_spec::file(path)));
    let more = ("spec/commands/more.yaml".to_owned(), text.to_owned());
    let sources = Sources::from_texts(good.into_iter().chain([more]));
    let mut faults = Faults::new();
    let model = load(&sources, &mut faults).model();
    model.unwrap_or_else(|| panic!("{}", render(&faults, &sources, Format::Text, Lang::En)))
}

/// Returns the files of the package by their paths in `generated`.
fn emitted(model: &Model) -> BTreeMap<String, String> {
    let artifacts = typescript::emit(model, &Targets::default()).into_iter();
    let artifacts = artifacts.map(|it| {
        let path = it.path.strip_prefix("stubs/typescript/generated/");
        (path.expect("its place").to_owned(), it.contents)
    });
    artifacts.collect()
}

/// Returns a group with these types and with a command whose request has these fields.
fn group(fields: &str, types: &str) -> String {
    format!(
        "\
group: {{ id: more, zh: 更多, en: More }}
commands:
  do_more:
    code: 0x0102
    zh: 更多
    en: Do more
    effect: read
    source: {{ sections: [] }}
    response: {{ mode: {{ zh: 模式, en: Mode, type: Mode, example: 1 }} }}
    request:
{fields}
types:
  Mode: {{ enum: u8, zh: 模式, en: Mode, values: {{ 1: {{ name: idle, zh: 闲, en: Idle }}, 2: {{ name: busy, zh: 忙, en: Busy }} }} }}
{types}"
    )
}

/// Returns the line of a file that starts with `start`.
fn line<'t>(text: &'t str, start: &str) -> &'t str {
    let line = text.lines().find(|line| line.trim().starts_with(start));
    line.unwrap_or_else(|| panic!("no line starts with `{start}`:\n{text}"))
        .trim()
}

#[test]
fn a_field_has_a_type_and_a_schema() {
    for (yaml, ty, schema) in [
        (
            "{ type: u32, example: 1 }",
            "field: number",
            "field: { key: 'field', type: 'u32' },",
        ),
        (
            "{ type: i64, example: 1 }",
            "field: bigint",
            "field: { key: 'field', type: 'i64' },",
        ),
        (
            "{ type: i64, min: -9007199254740991, max: 9007199254740991, example: 1 }",
            "field: number",
            "field: { key: 'field', type: 'i64', safe: true, min: -9007199254740991, max: 9007199254740991 },",
        ),
        (
            "{ type: i64, min: 0, max: 9007199254740992, example: 1 }",
            "field: bigint",
            "field: { key: 'field', type: 'i64', min: 0n, max: 9007199254740992n },",
        ),
        (
            "{ type: \"[u64]\", example: [1] }",
            "field: bigint[]",
            "field: { key: 'field', type: { list: 'u64' } },",
        ),
        (
            "{ type: u64, max: 7, example: 1 }",
            "field: number",
            "field: { key: 'field', type: 'u64', safe: true, max: 7 },",
        ),
        (
            "{ type: \"timestamp_ms?\", example: 1 }",
            "field?: bigint | undefined",
            "field: { key: 'field', type: 'i64', optional: true },",
        ),
        (
            "{ type: \"f64?\", min: 0.5, max: 2, unit: m, example: 1.0 }",
            "field?: number | undefined",
            "field: { key: 'field', type: 'f64', optional: true, min: 0.5, max: 2 },",
        ),
        (
            "{ type: string, pattern: \"it's \\\\d\", example: it's 1 }",
            "field: string",
            "field: { key: 'field', type: 'string', pattern: \"it's [0-9]\" },",
        ),
        (
            "{ type: base64, length: [1, 4], example: AA== }",
            "field: Uint8Array",
            "field: { key: 'field', type: 'base64', length: [1, 4] },",
        ),
        (
            "{ type: json, example: 1 }",
            "field: JsonText",
            "field: { key: 'field', type: 'json' },",
        ),
        (
            "{ type: \"bool?\", wire: number, quirk: [lenient_bool], default: true, example: 0 }",
            "field?: boolean | undefined",
            "field: { key: 'field', type: 'bool', optional: true, lenientBool: true, form: 'number', default: true },",
        ),
        (
            "{ type: Mode, only: [2], example: 2 }",
            "field: Mode",
            "field: { key: 'field', type: () => Mode, only: [messages.Mode.Busy] },",
        ),
        (
            "{ type: u8, sensitive: true, also: [old], example: 1 }",
            "field: number",
            "field: { key: 'field', type: 'u8', sensitive: true, also: ['old'] },",
        ),
        (
            "{ type: u8, name: constructor, example: 1 }",
            "constructor_: number",
            "constructor_: { key: 'field', type: 'u8' },",
        ),
        (
            "{ type: u8, name: delete, example: 1 }",
            "delete: number",
            "delete: { key: 'field', type: 'u8' },",
        ),
    ] {
        let yaml = yaml.replacen("{ ", "{ zh: 字段, en: Field, ", 1);
        let files = emitted(&model(&group(&format!("      field: {yaml}"), "")));
        let name = ty.split([':', '?']).next().unwrap_or_default();
        assert_eq!(line(&files["groups/more/messages.ts"], name), ty, "{yaml}");
        let found = line(&files["groups/more/schemas.ts"], &format!("{name}: {{"));
        assert_eq!(found, schema, "{yaml}");
    }
}

#[test]
fn conditions_name_sibling_fields() {
    let fields = "      the_mode: { zh: 模式, en: Mode, type: Mode, example: 2 }\n      \
                  speed: { zh: 速度, en: Speed, type: \"u8?\", when: { the_mode: [2] }, example: 1 }";
    let files = emitted(&model(&group(fields, "")));
    assert_eq!(
        line(&files["groups/more/schemas.ts"], "speed"),
        "speed: { key: 'speed', type: 'u8', optional: true, when: { theMode: [messages.Mode.Busy] } },"
    );
    assert!(
        files["groups/more/messages.ts"].contains("Present only when `theMode` is `Mode.Busy`.")
    );
}

#[test]
fn enums_are_open_unless_they_are_closed() {
    for (closed, ty) in [("", "1 | 2 | (number & {})"), ("closed: true, ", "1 | 2")] {
        let types = format!(
            "  Way: {{ enum: u8, {closed}zh: 路, en: Way, values: {{ 1: {{ name: left, zh: 左, en: Left }}, 2: {{ name: right, zh: 右, en: Right }} }} }}"
        );
        let fields = "      way: { zh: 路, en: Way, type: Way, example: 1 }";
        let files = emitted(&model(&group(fields, &types)));
        let found = line(&files["groups/more/messages.ts"], "export type Way =");
        assert_eq!(found, format!("export type Way = {ty}"));
        let is_closed = files["groups/more/schemas.ts"].contains("repr: 'u8', closed: true");
        assert_eq!(is_closed, !closed.is_empty());
    }
}

/// A new command appears in every file that lists commands.
#[test]
fn a_command_is_in_every_file_that_commands_are_in() {
    let files = emitted(&model(&group(
        "      way: { zh: 路, en: Way, type: u8, example: 1 }",
        "",
    )));
    for (file, start) in [
        (
            "client.ts",
            "export interface Client extends messages.DemoGroupCalls, messages.MoreCalls {}",
        ),
        ("commands.ts", "export * from './groups/more/commands.ts'"),
        ("groups/more/commands.ts", "export const doMore: Command<"),
        ("groups/more/commands.ts", "doMore,"),
        (
            "groups/more/messages.ts",
            "doMore(request: DoMoreRequest, options?: CallOptions): Promise<DoMoreResponse>",
        ),
        (
            "groups/more/messages.ts",
            "doMore?(request: DoMoreRequest, context: Context): Answer<DoMoreResponse>",
        ),
        ("groups/more/messages.ts", "doMore(): DoMoreResponse"),
        (
            "groups/more/messages.ts",
            "export interface DoMoreRequest {",
        ),
        ("messages.ts", "export * from './groups/more/messages.ts'"),
        ("operations.ts", "...moreCommands,"),
        (
            "robot.ts",
            "export interface PartialRobot extends messages.DemoGroupPartialRobot, messages.MorePartialRobot {",
        ),
        (
            "groups/more/schemas.ts",
            "export const DoMoreRequest: Struct<messages.DoMoreRequest> = {",
        ),
    ] {
        line(&files[file], start);
    }
}

#[test]
fn the_same_model_gives_the_same_bytes() {
    let model = good_spec::model();
    assert_eq!(emitted(&model), emitted(&model));
}
