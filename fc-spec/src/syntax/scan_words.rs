//! Texts for the parser's errors that need only their place.

use crate::diagnostic::FaultCode;
use crate::model::Text;
use crate::text;
use granit_parser::ErrorKind;

/// Returns the code, message, label and note of such an error.
#[allow(clippy::too_many_lines, reason = "a table")]
pub(super) fn words(kind: &ErrorKind) -> Option<(FaultCode, Text, Text, Text)> {
    use ErrorKind as K;
    Some(match kind {
        K::MisplacedFlowCollectionEnd => (
            FaultCode::BadYaml,
            text!(
                "没有左括号的右括号",
                "a closing bracket without an opening one"
            ),
            text!("没有对应的左括号", "does not match an opening bracket"),
            text!(
                "删除它，或给文本加上引号",
                "delete it, or put the text in quotes"
            ),
        ),
        K::UnknownQuotedScalarEscape
        | K::InvalidQuotedScalarHexEscape
        | K::InvalidLowSurrogateHexEscape
        | K::InvalidLowSurrogate
        | K::MissingLowSurrogate
        | K::UnpairedLowSurrogate
        | K::InvalidUnicodeEscape => (
            FaultCode::BadEscape,
            text!("未知的转义", "an unknown escape"),
            text!("在从这里开始的文本中", "in the text that starts here"),
            text!(
                "在 \"…\" 中反斜杠写成 `\\\\`，或改用 '…'，其中反斜杠就是反斜杠",
                "write `\\\\` for a backslash in \"…\", or use '…', in which a backslash is a backslash"
            ),
        ),
        K::ExpectedBlockMappingKey
        | K::ExpectedBlockSequenceEntry
        | K::InvalidIndentation
        | K::InvalidBlockScalarIndent
        | K::InvalidFlowScalarIndent
        | K::UnexpectedEofBlockMapping
        | K::UnexpectedEofBlockSequence => (
            FaultCode::BadIndentation,
            text!(
                "这一行的缩进与它可能属于的映射或列表都对不上",
                "the indentation of this line does not match any mapping or list it could belong to"
            ),
            text!("从这里开始", "starts here"),
            text!(
                "与同级的行对齐：每级两个空格",
                "indent it like the lines it belongs to: two spaces per level"
            ),
        ),
        K::BlockSequenceEntryNotAllowed | K::BlockEntryInFlowCollection => (
            FaultCode::BadYaml,
            text!("这里不能写列表项", "a list item is not allowed here"),
            text!("这个 `-`", "this `-`"),
            text!(
                "每项在键的下面另起一行；在方括号中不写 `-`",
                "start each item on its own line below the key; in brackets, write items without `-`"
            ),
        ),
        K::SimpleKeyExpected | K::InvalidSimpleKey => (
            FaultCode::BadYaml,
            text!("应为键和冒号", "expected a key followed by a colon"),
            text!("实际是这个", "found this"),
            text!(
                "写 `key: value`，或 `- value`，短横后面有空格",
                "write `key: value`, or `- value` with a space after the dash"
            ),
        ),
        K::ExpectedTagBang
        | K::InvalidGlobalTagCharacter
        | K::InvalidTagTerminator
        | K::MissingTagUri
        | K::UnclosedVerbatimTag
        | K::InvalidTagEscape
        | K::InvalidTagUtf8LeadingByte
        | K::InvalidTagUtf8TrailingByte
        | K::InvalidTagUtf8
        | K::UndeclaredTagHandle => (
            FaultCode::Tag,
            text!("无效的标签", "an invalid tag"),
            text!("规范中不用标签", "tags are not used in the spec"),
            text!(
                "如果文本以 `!` 开头，给它加上引号",
                "put the text in quotes if it starts with a `!`"
            ),
        ),
        K::MissingAnchorOrAliasName => (
            FaultCode::BadYaml,
            text!(
                "文本不能以 `&` 或 `*` 开头",
                "a text cannot start with `&` or `*`"
            ),
            text!("在这里", "here"),
            text!("给文本加上引号", "put the text in quotes"),
        ),
        K::CommentNotSeparated | K::CommentInterceptedScalar => (
            FaultCode::BadYaml,
            text!("这里不能写注释", "a comment is not allowed here"),
            text!("在这里", "here"),
            text!(
                "在 `#` 前面加空格；如果 `#` 是文本的一部分，给文本加上引号",
                "write a space before the `#`, or put the text in quotes if the `#` belongs to it"
            ),
        ),
        _ => return None,
    })
}
