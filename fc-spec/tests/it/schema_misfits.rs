//! Editors show the first misfit of the spec language's schema. It must be the slip itself, at its place, and not "none
//! of these alternatives".

use crate::json_schema::Validator;
use crate::yaml_as_json;
use fc_spec::language::schema;
use fc_spec::model::Languages;
use serde_json::Value;

/// A valid file. The text that a row of `SLIPS` replaces occurs once in it.
const FILE: &str = r"group: { id: demo, zh: 演示, en: Demo }
commands:
  get_thing:
    code: 0x0101
    zh: 获取物品
    en: Get a thing
    effect: read
    since: 2023-05
    source: { sections: [1], lost: [response] }
    request_state: { state: open, zh: 未知, en: Unknown }
    request:
      thingId: { type: i64, min: 1, unit: m, example: 7, zh: 物品, en: The thing }
      tags: { type: [string], length: [1, 2], zh: 标签, en: Tags }
      inner: { zh: 内部, en: Inner, fields: { a: Color } }
      choice: { zh: 选择, en: Choice, one_of: { single: { zh: 单个, en: Single, fields: {} } } }
    answers:
      - { ids: [C001], as: decision, zh: 已定, en: Settled }
types:
  Color:
    enum: u8
    zh: 颜色
    en: Color
    values: { 0: { name: red, zh: 红, en: Red } }
  Size: { zh: 尺寸, en: Size, fields: {} }
";

/// The replaced text, its replacement, the place of the first misfit, and its keyword.
const SLIPS: &[(&str, &str, &str, &str)] = &[
    (
        "id: demo, zh: 演示, en: Demo",
        "id: demo, zh: 演示",
        "group",
        "required en",
    ),
    ("id: demo,", "id: demoGroup,", "group.id", "pattern"),
    (
        "    zh: 获取物品\n",
        "",
        "commands.get_thing",
        "required zh",
    ),
    (
        "    en: Get a thing\n",
        "",
        "commands.get_thing",
        "required en",
    ),
    (
        "    code: 0x0101\n",
        "",
        "commands.get_thing",
        "required code",
    ),
    (
        "    effect: read\n",
        "",
        "commands.get_thing",
        "required effect",
    ),
    (
        "  get_thing:",
        "  getThing:",
        "commands",
        "propertyNames getThing",
    ),
    (
        "code: 0x0101",
        "code: 70000",
        "commands.get_thing.code",
        "maximum",
    ),
    (
        "code: 0x0101",
        "code: unasigned",
        "commands.get_thing.code",
        "enum",
    ),
    (
        "effect: read",
        "effect: raed",
        "commands.get_thing.effect",
        "enum",
    ),
    (
        "effect: read",
        "effect: { value: read }",
        "commands.get_thing.effect",
        "required state",
    ),
    (
        "effect: read",
        "efect: read",
        "commands.get_thing",
        "additionalProperties efect",
    ),
    (
        "since: 2023-05",
        "since: 2023/05",
        "commands.get_thing.since",
        "pattern",
    ),
    (
        "sections: [1]",
        "sections: 1",
        "commands.get_thing.source.sections",
        "type",
    ),
    (
        "lost: [response]",
        "lost: [responce]",
        "commands.get_thing.source.lost.0",
        "enum",
    ),
    (
        "state: open, zh: 未知, en: Unknown",
        "state: open, zh: 未知",
        "commands.get_thing.request_state",
        "required en",
    ),
    (
        "state: open",
        "state: oepn",
        "commands.get_thing.request_state.state",
        "enum",
    ),
    (
        "type: i64, min",
        "type: 64, min",
        "commands.get_thing.request.thingId.type",
        "type",
    ),
    (
        "type: i64, min",
        "min",
        "commands.get_thing.request.thingId",
        "required type",
    ),
    (
        "type: i64, min",
        "type: \"?i64\", min",
        "commands.get_thing.request.thingId.type",
        "pattern",
    ),
    (
        "min: 1",
        "min: one",
        "commands.get_thing.request.thingId.min",
        "type",
    ),
    (
        "unit: m",
        "unit: metre",
        "commands.get_thing.request.thingId.unit",
        "enum",
    ),
    (
        "zh: 物品, en: The thing",
        "zh: 物品",
        "commands.get_thing.request.thingId",
        "required en",
    ),
    (
        "zh: 物品, en: The thing",
        "zh: 物品, eng: The thing",
        "commands.get_thing.request.thingId",
        "additionalProperties eng",
    ),
    (
        "type: [string]",
        "type: [string, i64]",
        "commands.get_thing.request.tags.type",
        "maxItems",
    ),
    (
        "length: [1, 2]",
        "length: [1, 2, 3]",
        "commands.get_thing.request.tags.length",
        "maxItems",
    ),
    (
        "length: [1, 2]",
        "length: many",
        "commands.get_thing.request.tags.length",
        "type",
    ),
    (
        "fields: { a: Color }",
        "fields: { a: { type: Color, zh: 甲 } }",
        "commands.get_thing.request.inner.fields.a",
        "required en",
    ),
    (
        "fields: { a: Color }",
        "fields: [a]",
        "commands.get_thing.request.inner.fields",
        "type",
    ),
    (
        "zh: 单个, en: Single",
        "zh: 单个",
        "commands.get_thing.request.choice.one_of.single",
        "required en",
    ),
    (
        "ids: [C001]",
        "ids: [C1]",
        "commands.get_thing.answers.0.ids.0",
        "pattern",
    ),
    (
        "as: decision, ",
        "",
        "commands.get_thing.answers.0",
        "required as",
    ),
    (
        "zh: 已定, en: Settled",
        "zh: 已定",
        "commands.get_thing.answers.0",
        "required en",
    ),
    ("enum: u8", "enum: uint8", "types.Color.enum", "enum"),
    ("name: red, ", "", "types.Color.values.0", "required name"),
    (
        "zh: 红, en: Red",
        "zh: 红",
        "types.Color.values.0",
        "required en",
    ),
    (
        "zh: 尺寸, en: Size",
        "en: Size",
        "types.Size",
        "required zh",
    ),
    ("  Size:", "  size:", "types", "propertyNames size"),
];

#[test]
fn the_first_misfit_is_the_slip() {
    let root: Value = serde_json::from_str(&schema(Languages::All)).expect("the schema is JSON");
    let validator = Validator { root: &root };
    let misfit = |text: &str| validator.misfit(&root, &yaml_as_json::parse(text), "");
    assert_eq!(misfit(FILE), None, "the file is sound");
    let mut wrong = Vec::new();
    for (old, new, at, keyword) in SLIPS {
        assert_eq!(FILE.matches(old).count(), 1, "{old}");
        let found = misfit(&FILE.replacen(old, new, 1));
        let is_right = found
            .as_ref()
            .is_some_and(|found| found.at == *at && found.keyword == *keyword);
        if !is_right {
            wrong.push(format!("{old:?} -> {new:?}: {found:?}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
