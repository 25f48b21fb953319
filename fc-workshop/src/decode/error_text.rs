//! The errors of frames and bodies in words.

use fc_spec::model::Lang;

/// The name, the Chinese and the English text of each error. `conformance/errors.json` has the same texts.
const TEXTS: &[(&str, &str, &str)] = &[
    (
        "bad_head",
        "帧头不对：这不是一帧的开头",
        "Wrong head: no frame starts here",
    ),
    (
        "short_frame",
        "总长度小于包头长度",
        "The total length is shorter than the header",
    ),
    (
        "frame_too_long",
        "总长度超过上限",
        "The total length exceeds the limit",
    ),
    (
        "truncated",
        "字节不够：帧不完整",
        "Bytes are missing: the frame is incomplete",
    ),
    ("unknown_kind", "未知的数据类型", "Unknown kind"),
    (
        "reserved_kind",
        "预留的数据类型，一律拒绝",
        "Reserved kind, always refused",
    ),
    ("unknown_encoding", "未知的压缩方式", "Unknown encoding"),
    (
        "bad_digest",
        "摘要与数据不符",
        "The digest does not match the data",
    ),
    (
        "bad_gzip",
        "数据不是完整的 gzip",
        "The data is not a complete gzip member",
    ),
    (
        "plain_length_mismatch",
        "压缩前长度与实际不符",
        "The length before compression does not match the data",
    ),
    (
        "inflated_too_long",
        "解压后超过上限",
        "Exceeds the limit after decompression",
    ),
    (
        "inflates_too_much",
        "解压后增大的倍数超过上限",
        "Grows by more than the limit allows when decompressed",
    ),
    ("not_utf8", "不是 UTF-8 文本", "Not UTF-8"),
    ("bad_json", "不是合法的 JSON", "Not valid JSON"),
    (
        "not_an_object",
        "最外层应为对象",
        "The outermost value must be an object",
    ),
    ("wrong_type", "类型不对", "Wrong type"),
    ("missing_field", "缺少必填字段", "A required key is missing"),
    ("duplicate_key", "同一个键出现了两次", "A key occurs twice"),
    (
        "lone_surrogate",
        "字符串里有落单的半个代理对，不是合法的 Unicode 文本",
        "A string holds half of a surrogate pair, which is not Unicode text",
    ),
    ("out_of_range", "取值超出范围", "Out of range"),
    ("bad_length", "长度不符", "Wrong length"),
    ("bad_pattern", "格式不符", "Does not match the pattern"),
    (
        "unknown_value",
        "取值不在封闭枚举之内",
        "Not a value of this closed enum",
    ),
    ("no_variant", "不符合任何一种形式", "None of the forms fits"),
    ("too_deep", "嵌套过深", "Nested too deeply"),
    (
        "too_many_values",
        "键和列表项的总数超过上限",
        "More keys and list items than the limit allows",
    ),
    (
        "lists_too_large",
        "列表占用的内存超过上限",
        "Lists take more memory than the limit allows",
    ),
    ("bad_base64", "不是 base64", "Not base64"),
];

/// Returns the text of an error of a frame or body by its name, or `None` for another name.
#[must_use]
pub fn text(name: &str, lang: Lang) -> Option<&'static str> {
    let (_, zh, en) = TEXTS.iter().find(|(known, _, _)| *known == name)?;
    Some(lang.pick(zh, en))
}
