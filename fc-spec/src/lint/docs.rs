//! DOCS: rules about texts.

use super::finding::Finding;
use super::rule::{Category, Level, Rule};
use super::search::{Search, of_field, of_operation};
use crate::diagnostic::LintCode;
use crate::load::texts::has_chinese;
use crate::model::Operation;
use crate::text;
use std::collections::BTreeSet;

pub(super) const RULES: &[Rule] = &[
    Rule {
        code: LintCode {
            number: "FC0831",
            title: ["text that repeats the name", "只重复名称的说明"],
            text: [
                "The English text only repeats the key: `Lamp name` for `lampName`. Describe its purpose, its origin or its special values. Off by \
             default: some keys need no more words.",
                "英文说明只重复了键名：`lampName` 写成 `Lamp name`。写明用途、来源或特殊取值的含义。默认关闭：有的键确实没有更多可写。",
            ],
        },
        category: Category::Docs,
        name: "text-repeats-name",
        level: Level::Off,
        find: Some(text_repeats_name),
    },
    Rule {
        code: LintCode {
            number: "FC0832",
            title: ["title with a full stop", "标题末尾有句号"],
            text: [
                "Titles and descriptions appear in tables and lists, without a full stop. Only a text of several sentences ends with one.",
                "标题和说明显示在表格和列表中，末尾不加句号。只有由多句组成的文本才以句号结尾。",
            ],
        },
        category: Category::Docs,
        name: "full-stop",
        level: Level::Warning,
        find: Some(full_stop),
    },
    Rule {
        code: LintCode {
            number: "FC0833",
            title: ["punctuation of the other language", "用了另一种语言的标点"],
            text: [
                "A Chinese text has an ASCII comma, semicolon or colon after a Chinese character, or an English text has full-width punctuation. \
             Usually it was copied from the other text. Use the punctuation of the language.",
                "中文里汉字后面用了半角的逗号、分号或冒号，或者英文里用了全角标点，多半是从另一种语言复制过来的。改用本语言的标点。",
            ],
        },
        category: Category::Docs,
        name: "foreign-punctuation",
        level: Level::Warning,
        find: Some(foreign_punctuation),
    },
    Rule {
        code: LintCode {
            number: "FC0834",
            title: ["name in one language only", "只有一种语言提到的名称"],
            text: [
                "One of the two texts has a name in back quotes that the other lacks. Usually only one of them was changed later. Add the name to the \
             other text.",
                "中英文两份文本中，只有一份提到了反引号里的某个名称，多半是后来只改了其中一份。把名称补到另一份中。",
            ],
        },
        category: Category::Docs,
        name: "code-in-one-language",
        level: Level::Warning,
        find: Some(code_in_one_language),
    },
    Rule {
        code: LintCode {
            number: "FC0835",
            title: ["deprecated without a replacement", "弃用时没有写明改用什么"],
            text: [
                "An operation is `deprecated` without `replaced_by`. Generated packages warn its users, who need to know what to use instead. Write \
             `replaced_by`, or waive this if there is no replacement.",
                "接口标记为 `deprecated`，但没有 `replaced_by`。生成的代码会提醒使用者，使用者需要知道改用什么。写上 `replaced_by`；确实没有替代的，可加豁免。",
            ],
        },
        category: Category::Docs,
        name: "no-replacement",
        level: Level::Warning,
        find: Some(no_replacement),
    },
    Rule {
        code: LintCode {
            number: "FC0836",
            title: ["new operation without a date", "没有写明日期的新接口"],
            text: [
                "An operation that is not in the source document has no `since`. Robots in the field are older than the spec, and a caller needs to \
             know which of them have the operation. Write `since`.",
                "接口不在源文档中，也没有写 `since`。现场的机器人比规范旧，调用方需要知道哪些机器人支持。写上 `since`。",
            ],
        },
        category: Category::Docs,
        name: "new-without-since",
        level: Level::Warning,
        find: Some(new_without_since),
    },
    Rule {
        code: LintCode {
            number: "FC0837",
            title: ["translation with fewer paragraphs", "两种语言段落数不同"],
            text: [
                "The two texts have different numbers of paragraphs, so one of them probably lacks something. Compare them.",
                "中英文的段落数不同，很可能有一份缺了内容。对照两份文本。",
            ],
        },
        category: Category::Docs,
        name: "paragraphs-differ",
        level: Level::Warning,
        find: Some(paragraphs_differ),
    },
];

fn words(text: &str) -> Vec<String> {
    let words = text.split(|c: char| !c.is_ascii_alphanumeric());
    let words = words.map(str::to_ascii_lowercase);
    // These words add nothing to the name.
    let little = ["", "a", "an", "the", "of", "is", "id"];
    let mut words: Vec<_> = words.filter(|it| !little.contains(&it.as_str())).collect();
    words.sort_unstable();
    words
}

fn text_repeats_name(search: &mut Search<'_>) {
    for (ty, field) in search.fields() {
        let name = crate::names::snake(&field.wire);
        if words(&name) == words(&field.text.en) && field.details().note.is_none() {
            search.report(
                of_field(ty, field),
                text!(
                    "“{said}”只重复了 `{key}`",
                    "\"{said}\" only repeats `{key}`",
                    said = field.text.en,
                    key = field.wire
                ),
            );
        }
    }
}

fn full_stop(search: &mut Search<'_>) {
    for (item, is_short, text) in search.texts() {
        // A full stop inside the text means several sentences.
        let one = |text: &str, stop: char, inside: &str| {
            text.strip_suffix(stop)
                .is_some_and(|rest| !rest.contains(inside) && !rest.ends_with('.'))
        };
        if !is_short || text.en.contains('\n') {
            continue;
        }
        let (zh, en) = (one(&text.zh, '。', "。"), one(&text.en, '.', ". "));
        let message = match (zh, en) {
            (true, true) => text!("中英文都以句号结尾", "both texts end with a full stop"),
            (true, false) => text!("中文以句号结尾", "the Chinese text ends with a full stop"),
            (false, true) => text!("英文以句号结尾", "the English text ends with a full stop"),
            (false, false) => continue,
        };
        search.report(item, message);
    }
}

/// Returns the text outside back quotes and code blocks.
fn prose(text: &str) -> impl Iterator<Item = &str> {
    text.split('`').step_by(2)
}

fn foreign_punctuation(search: &mut Search<'_>) {
    for (item, is_short, text) in search.texts() {
        let about = if is_short { "text" } else { "about" };
        let in_chinese = prose(&text.zh).find_map(|part| {
            let mut pairs = part.chars().zip(part.chars().skip(1));
            pairs.find(|(before, sign)| {
                is_han(*before) && matches!(sign, ',' | ';' | ':' | '?' | '!')
            })
        });
        if let Some((_, sign)) = in_chinese {
            let finding = Finding::new(
                search.rule,
                item,
                text!(
                    "中文里汉字后面用了半角的 `{sign}`",
                    "the Chinese text has `{sign}` after a Chinese character"
                ),
            );
            search.add(finding.about(format!("zh {about}")));
        }
        let in_english = prose(&text.en).find_map(|part| part.chars().find(|c| is_full_width(*c)));
        if let Some(sign) = in_english {
            let finding = Finding::new(
                search.rule,
                item,
                text!(
                    "英文里用了全角的 `{sign}`",
                    "the English text has the full-width `{sign}`"
                ),
            );
            search.add(finding.about(format!("en {about}")));
        }
    }
}

fn is_han(character: char) -> bool {
    has_chinese(character.encode_utf8(&mut [0; 4]))
}

fn is_full_width(character: char) -> bool {
    matches!(
        character,
        '，' | '。' | '；' | '：' | '？' | '！' | '（' | '）' | '、' | '“' | '”'
    )
}

/// Returns the names in single back quotes. The set is empty if the text has a code block, because the quotes are ambiguous there.
fn quoted_names(text: &str) -> BTreeSet<&str> {
    if text.contains("```") {
        return BTreeSet::new();
    }
    text.split('`').skip(1).step_by(2).collect()
}

fn code_in_one_language(search: &mut Search<'_>) {
    for (item, is_short, text) in search.texts() {
        let (zh, en) = (quoted_names(&text.zh), quoted_names(&text.en));
        let (name, missing) = match (zh.difference(&en).next(), en.difference(&zh).next()) {
            (Some(name), _) => (*name, ["Chinese", "中文", "英文"]),
            (None, Some(name)) => (*name, ["English", "英文", "中文"]),
            (None, None) => continue,
        };
        let [english, chinese, other] = missing;
        let finding = Finding::new(
            search.rule,
            item,
            text!(
                "只有{chinese}提到了 `{name}`，{other}没有",
                "only the {english} text names `{name}`"
            ),
        );
        search.add(finding.about(if is_short { "text" } else { "about" }));
    }
}

fn no_replacement(search: &mut Search<'_>) {
    for operation in search.operations() {
        let withdrawn = operation.deprecated.as_ref();
        if withdrawn.is_some_and(|it| it.replaced_by.is_none()) {
            search.report(
                of_operation(operation),
                text!(
                    "`{name}` 的 `deprecated` 没有 `replaced_by`",
                    "`deprecated` of `{name}` has no `replaced_by`",
                    name = operation.name
                ),
            );
        }
    }
}

fn new_without_since(search: &mut Search<'_>) {
    // A protocol that begins with the spec has no first version to be newer than.
    if !search.operations().any(Operation::is_from_source) {
        return;
    }
    for operation in search.operations() {
        if !operation.is_from_source() && operation.since.is_none() {
            search.report(
                of_operation(operation),
                text!(
                    "`{name}` 不在源文档中，也没有 `since`",
                    "`{name}` is not in the source document and has no `since`",
                    name = operation.name
                ),
            );
        }
    }
}

fn paragraphs_differ(search: &mut Search<'_>) {
    for (item, is_short, text) in search.texts() {
        let count = |text: &str| text.trim().split("\n\n").count();
        let (zh, en) = (count(&text.zh), count(&text.en));
        if zh != en {
            let finding = Finding::new(
                search.rule,
                item,
                text!(
                    "中文有 {zh} 段，英文有 {en} 段",
                    "the Chinese text has {zh} paragraphs, the English one {en}"
                ),
            );
            search.add(finding.about(if is_short { "text" } else { "about" }));
        }
    }
}
