//! Chinese messages for errors of the YAML library, which has only English ones.

use fc_spec::model::Text;

/// Describes in Chinese why the file does not have the expected shape.
pub(crate) fn chinese(error: &serde_yaml::Error) -> String {
    let message = error.to_string();
    let (message, place) = match (message.split_once(" at line "), error.location()) {
        (Some((message, _)), Some(at)) => (
            message,
            format!("第 {} 行第 {} 列：", at.line(), at.column()),
        ),
        _ => (message.as_str(), String::new()),
    };
    let (path, message) = match message.split_once(": ") {
        // The path of keys, such as `targets.rust`.
        Some((path, rest)) if !path.contains(' ') => (format!("`{path}` 中"), rest),
        _ => (String::new(), message),
    };
    let facts = [
        ("unknown field ", "有未知的键"),
        ("missing field ", "缺少键"),
        ("duplicate field ", "有重复的键"),
        ("unknown variant ", "有未知的值"),
        ("invalid type: ", "类型不对，实际为"),
        ("invalid value: ", "值不对，实际为"),
    ];
    let fact = facts.iter().find_map(|(en, zh)| {
        let rest = message.strip_prefix(en)?;
        let (found, expected) = match rest.split_once(", expected ") {
            Some((found, expected)) => (found, format!("，应为{}", words(expected))),
            None => (rest, String::new()),
        };
        Some(format!("{zh}{}{expected}", words(found)))
    });
    let fact = fact.unwrap_or_else(|| "YAML 的写法有错误".to_owned());
    format!("{place}{path}{fact}")
}

/// Translates the library's words for kinds of values into Chinese.
fn words(text: &str) -> String {
    let known = [
        ("one of ", ""),
        ("a mapping", "映射"),
        ("a map", "映射"),
        ("map", "映射"),
        ("a sequence", "列表"),
        ("sequence", "列表"),
        ("a boolean", "布尔值"),
        ("boolean", "布尔值"),
        ("a string", "字符串"),
        ("string", "字符串"),
        ("floating point", "小数"),
        ("integer", "整数"),
        ("unit value", "空值"),
        ("u64", "正整数"),
        ("option", "值"),
        (" or ", " 或 "),
        (", ", "、"),
    ];
    let is_type = ["struct ", "variant of ", "enum ", "any "];
    if let Some(start) = is_type.iter().find(|start| text.starts_with(*start)) {
        return if *start == "struct " {
            "映射"
        } else {
            "列出的值"
        }
        .to_owned();
    }
    let is_quote = |c: char| matches!(c, '`' | '"');
    let parts = text.split_inclusive(is_quote).enumerate();
    let parts = parts.map(|(at, part)| {
        // Words between quotes come from the file.
        let known = known.iter().filter(|_| at % 2 == 0);
        known.fold(part.to_owned(), |part, (en, zh)| part.replace(en, zh))
    });
    let text: String = parts.collect();
    Text {
        zh: text,
        en: String::new(),
    }
    .spaced()
    .zh
}
