//! Texts for the parser's errors that need only their place.

use crate::diagnostic::FaultCode;
use crate::model::Text;
use crate::text;
use granit_parser::ErrorKind;

/// Declares the texts: errors of the parser, the code, and the message, the label and the note in both languages.
macro_rules! scan_errors {
    ($($($kind:ident)|+ => $code:ident $($zh:literal $en:literal)+;)+) => {
        /// Returns the code, message, label and note of such an error.
        pub(super) fn words(kind: &ErrorKind) -> Option<(FaultCode, [Text; 3])> {
            Some(match kind {
                $($(ErrorKind::$kind)|+ => (FaultCode::$code, [$(text!($zh, $en)),+]),)+
                _ => return None,
            })
        }
    };
}

scan_errors! {
    MisplacedFlowCollectionEnd => BadYaml
        "没有左括号的右括号" "a closing bracket without an opening one"
        "没有对应的左括号" "does not match an opening bracket"
        "删除它，或给文本加上引号" "delete it, or put the text in quotes";
    UnknownQuotedScalarEscape | InvalidQuotedScalarHexEscape | InvalidLowSurrogateHexEscape |
    InvalidLowSurrogate | MissingLowSurrogate | UnpairedLowSurrogate | InvalidUnicodeEscape => BadEscape
        "未知的转义" "an unknown escape"
        "在从这里开始的文本中" "in the text that starts here"
        "在 \"…\" 中反斜杠写成 `\\\\`，或改用 '…'，其中反斜杠就是反斜杠" "write `\\\\` for a backslash in \"…\", or use '…', in which a backslash is a backslash";
    ExpectedBlockMappingKey | ExpectedBlockSequenceEntry | InvalidIndentation |
    InvalidBlockScalarIndent | InvalidFlowScalarIndent | UnexpectedEofBlockMapping |
    UnexpectedEofBlockSequence => BadIndentation
        "这一行的缩进与它可能属于的映射或列表都对不上" "the indentation of this line does not match any mapping or list it could belong to"
        "从这里开始" "starts here"
        "与同级的行对齐：每级两个空格" "indent it like the lines it belongs to: two spaces per level";
    BlockSequenceEntryNotAllowed | BlockEntryInFlowCollection => BadYaml
        "这里不能写列表项" "a list item is not allowed here"
        "这个 `-`" "this `-`"
        "每项在键的下面另起一行；在方括号中不写 `-`" "start each item on its own line below the key; in brackets, write items without `-`";
    SimpleKeyExpected | InvalidSimpleKey => BadYaml
        "应为键和冒号" "expected a key followed by a colon"
        "实际是这个" "found this"
        "写 `key: value`，或 `- value`，短横后面有空格" "write `key: value`, or `- value` with a space after the dash";
    ExpectedTagBang | InvalidGlobalTagCharacter | InvalidTagTerminator | MissingTagUri |
    UnclosedVerbatimTag | InvalidTagEscape | InvalidTagUtf8LeadingByte |
    InvalidTagUtf8TrailingByte | InvalidTagUtf8 | UndeclaredTagHandle => Tag
        "无效的标签" "an invalid tag"
        "规范中不用标签" "tags are not used in the spec"
        "如果文本以 `!` 开头，给它加上引号" "put the text in quotes if it starts with a `!`";
    MissingAnchorOrAliasName => BadYaml
        "文本不能以 `&` 或 `*` 开头" "a text cannot start with `&` or `*`"
        "在这里" "here"
        "给文本加上引号" "put the text in quotes";
    CommentNotSeparated | CommentInterceptedScalar => BadYaml
        "这里不能写注释" "a comment is not allowed here"
        "在这里" "here"
        "在 `#` 前面加空格；如果 `#` 是文本的一部分，给文本加上引号" "write a space before the `#`, or put the text in quotes if the `#` belongs to it";
}
