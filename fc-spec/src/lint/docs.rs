//! DOCS: rules about texts.

use super::finding::Finding;
use super::rule::rules;
use super::search::{Search, Subject, TITLE};
use crate::load::texts::has_chinese;
use crate::model::Operation;
use crate::text;
use std::collections::BTreeSet;

rules! { Docs
    FC0831 "text-repeats-name" Off text_repeats_name "只重复名称的说明" "text that repeats the name";
    FC0832 "full-stop" Warning full_stop "标题末尾有句号" "title with a full stop";
    FC0833 "foreign-punctuation" Warning foreign_punctuation "用了另一种语言的标点" "punctuation of the other language";
    FC0834 "code-in-one-language" Warning code_in_one_language "只有一种语言提到的名称" "name in one language only";
    FC0835 "no-replacement" Warning no_replacement "弃用时没有写明改用什么" "deprecated without a replacement";
    FC0836 "new-without-since" Warning new_without_since "没有写明日期的新接口" "new operation without a date";
    FC0837 "paragraphs-differ" Warning paragraphs_differ "两种语言段落数不同" "translation with fewer paragraphs";
}

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
                Subject::Field(ty, field),
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
    for (item, part, text) in search.texts() {
        // A full stop inside the text means several sentences.
        let one = |text: &str, stop: char, inside: &str| {
            text.strip_suffix(stop)
                .is_some_and(|rest| !rest.contains(inside) && !rest.ends_with('.'))
        };
        if part != TITLE || text.en.contains('\n') {
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
    for (item, part, text) in search.texts() {
        let in_chinese = prose(&text.zh).find_map(|text| {
            let mut pairs = text.chars().zip(text.chars().skip(1));
            pairs.find(|(before, sign)| {
                is_han(*before) && matches!(sign, ',' | ';' | ':' | '?' | '!')
            })
        });
        if let Some((_, sign)) = in_chinese {
            let message = text!(
                "中文里汉字后面用了半角的 `{sign}`",
                "the Chinese text has `{sign}` after a Chinese character"
            );
            search.add(Finding::new(search.rule, item, message).about(format!("zh {part}")));
        }
        let in_english = prose(&text.en).find_map(|text| text.chars().find(|c| is_full_width(*c)));
        if let Some(sign) = in_english {
            let message = text!(
                "英文里用了全角的 `{sign}`",
                "the English text has the full-width `{sign}`"
            );
            search.add(Finding::new(search.rule, item, message).about(format!("en {part}")));
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
    for (item, part, text) in search.texts() {
        let (zh, en) = (quoted_names(&text.zh), quoted_names(&text.en));
        let (name, missing) = match (zh.difference(&en).next(), en.difference(&zh).next()) {
            (Some(name), _) => (*name, ["Chinese", "中文", "英文"]),
            (None, Some(name)) => (*name, ["English", "英文", "中文"]),
            (None, None) => continue,
        };
        let [english, chinese, other] = missing;
        let message = text!(
            "只有{chinese}提到了 `{name}`，{other}没有",
            "only the {english} text names `{name}`"
        );
        search.add(Finding::new(search.rule, item, message).about(part));
    }
}

fn no_replacement(search: &mut Search<'_>) {
    let lacks_replacement = |operation: &Operation| {
        let withdrawn = operation.deprecated.as_ref();
        withdrawn.is_some_and(|it| it.replaced_by.is_none())
    };
    search.report_operations(lacks_replacement, |name| {
        text!(
            "`{name}` 的 `deprecated` 没有 `replaced_by`",
            "`deprecated` of `{name}` has no `replaced_by`"
        )
    });
}

fn new_without_since(search: &mut Search<'_>) {
    // A protocol that begins with the spec has no first version to be newer than.
    if !search.operations().any(Operation::is_from_source) {
        return;
    }
    search.report_operations(
        |operation| !operation.is_from_source() && operation.since.is_none(),
        |name| {
            text!(
                "`{name}` 不在源文档中，也没有 `since`",
                "`{name}` is not in the source document and has no `since`"
            )
        },
    );
}

fn paragraphs_differ(search: &mut Search<'_>) {
    for (item, part, text) in search.texts() {
        let count = |text: &str| text.trim().split("\n\n").count();
        let (zh, en) = (count(&text.zh), count(&text.en));
        if zh != en {
            let message = text!(
                "中文有 {zh} 段，英文有 {en} 段",
                "the Chinese text has {zh} paragraphs, the English one {en}"
            );
            search.add(Finding::new(search.rule, item, message).about(part));
        }
    }
}
