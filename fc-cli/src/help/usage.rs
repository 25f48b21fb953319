//! Usage errors in the language of the run.

use std::error::Error as _;
use std::process::ExitCode;

use clap::error::{ContextKind, ContextValue, Error, ErrorKind};

use super::dressed;
use crate::lang::{both, said};
use crate::print;

/// Shows the requested help, or the error in the command line.
pub fn told(error: Error) -> ExitCode {
    // Building the command line with texts takes longer, and only help and errors need it.
    let error = dressed().try_get_matches().err().unwrap_or(error);
    let error = help_of_command(&error).unwrap_or(error);
    // If the stream is closed, the exit status is the only signal.
    let _ = match described(&error) {
        Some(text) => print::message(&text),
        None => error.print(),
    };
    ExitCode::from(u8::try_from(error.exit_code()).unwrap_or(2))
}

/// Returns the help for `help COMMAND --lang zh`. Clap accepts no options after `help`.
fn help_of_command(error: &Error) -> Option<Error> {
    let is_option = word(error, ContextKind::InvalidSubcommand)?.starts_with('-');
    let mut words: Vec<_> = std::env::args_os().collect();
    let at = words.iter().position(|word| is_option && word == "help")?;
    words.remove(at);
    words.push("--help".into());
    let error = dressed().try_get_matches_from(words).err()?;
    (error.kind() == ErrorKind::DisplayHelp).then_some(error)
}

/// Returns the text of a usage error. Returns `None` for help, the version and unknown errors.
pub fn described(error: &Error) -> Option<String> {
    let message = message(error)?;
    let line = said!("错误：{message}\n", "error: {message}\n");
    let mut text = print::leveled(&line);
    let tips = tips(error);
    if !tips.is_empty() {
        text.push('\n');
    }
    for tip in tips {
        text += &said!("  提示：{tip}\n", "  tip: {tip}\n");
    }
    if let Some(usage) = word(error, ContextKind::Usage) {
        let usage = usage.trim_start_matches("Usage: ");
        text += &said!("\n用法：{usage}\n", "\nUsage: {usage}\n");
    }
    text += both(
        "\n运行时加 `--help` 查看全部选项。\n",
        "\nFor more information, try `--help`.\n",
    );
    Some(text)
}

fn message(error: &Error) -> Option<String> {
    // Clap gives each error the words of its message.
    let [argument, value, command] = [
        ContextKind::InvalidArg,
        ContextKind::InvalidValue,
        ContextKind::InvalidSubcommand,
    ]
    .map(|kind| word(error, kind).unwrap_or_default());
    let list = |kind| listed(&words(error, kind));
    Some(match error.kind() {
        ErrorKind::UnknownArgument => {
            said!("没有参数 `{argument}`", "unexpected argument `{argument}`")
        }
        ErrorKind::InvalidSubcommand => {
            said!("没有命令 `{command}`", "there is no command `{command}`")
        }
        ErrorKind::MissingRequiredArgument => {
            let missing = list(ContextKind::InvalidArg);
            said!("缺少参数 {missing}", "missing argument {missing}")
        }
        ErrorKind::MissingSubcommand => {
            let known = list(ContextKind::ValidSubcommand);
            said!(
                "`{command}` 之后缺少命令；可用的命令：{known}",
                "`{command}` needs a command: {known}"
            )
        }
        ErrorKind::InvalidValue => {
            let known = list(ContextKind::ValidValue);
            match (value.as_str(), known.as_str()) {
                ("", "") => said!("`{argument}` 缺少值", "`{argument}` needs a value"),
                ("", known) => said!(
                    "`{argument}` 缺少值；可用的值：{known}",
                    "`{argument}` needs a value: {known}"
                ),
                (value, known) => said!(
                    "`{argument}` 的值 `{value}` 无效；可用的值：{known}",
                    "invalid value `{value}` for `{argument}`; the values are {known}"
                ),
            }
        }
        ErrorKind::ValueValidation => {
            let cause = error.source().map(ToString::to_string);
            let cause = cause.map(|cause| said!("：{cause}", ": {cause}"));
            let cause = cause.unwrap_or_default();
            said!(
                "`{argument}` 的值 `{value}` 无效{cause}",
                "invalid value `{value}` for `{argument}`{cause}"
            )
        }
        ErrorKind::ArgumentConflict => {
            let others = list(ContextKind::PriorArg);
            if !command.is_empty() {
                said!(
                    "命令 `{command}` 不能与 {others} 同时使用",
                    "the command `{command}` cannot be used with {others}"
                )
            } else if others.is_empty() || others == listed(std::slice::from_ref(&argument)) {
                said!(
                    "`{argument}` 只能出现一次",
                    "`{argument}` can be used only once"
                )
            } else {
                said!(
                    "`{argument}` 不能与 {others} 同时使用",
                    "`{argument}` cannot be used with {others}"
                )
            }
        }
        ErrorKind::TooManyValues => said!(
            "`{argument}` 的值过多：`{value}`",
            "too many values for `{argument}`: `{value}`"
        ),
        ErrorKind::WrongNumberOfValues => {
            let expected = number(error, ContextKind::ExpectedNumValues)?;
            let actual = number(error, ContextKind::ActualNumValues)?;
            said!(
                "`{argument}` 应有 {expected} 个值，实际为 {actual} 个",
                "`{argument}` needs {expected} values, not {actual}"
            )
        }
        ErrorKind::InvalidUtf8 => said!(
            "命令行中有一个参数不是 UTF-8 编码",
            "an argument of the command line is not UTF-8"
        ),
        _ => return None,
    })
}

/// Returns suggestions for the user.
fn tips(error: &Error) -> Vec<String> {
    let kinds = [
        ContextKind::SuggestedSubcommand,
        ContextKind::SuggestedArg,
        ContextKind::SuggestedValue,
    ];
    let near = kinds.into_iter().map(|kind| words(error, kind));
    let near = near.filter(|names| !names.is_empty()).map(|mut names| {
        // Clap lists the best suggestion last.
        names.reverse();
        let names = listed(&names);
        said!("是否想写 {names}？", "did you mean {names}?")
    });
    let others = words(error, ContextKind::Suggested);
    near.chain(others.iter().map(|tip| in_backticks(tip)))
        .collect()
}

/// Converts a tip for which clap has only a sentence with its words between quotes.
fn in_backticks(tip: &str) -> String {
    let quoted: Vec<&str> = tip.split('\'').skip(1).step_by(2).collect();
    match quoted.as_slice() {
        [word, call] if tip.starts_with("to pass") => said!(
            "要把 `{word}` 作为值传入，写 `{call}`",
            "to pass `{word}` as a value, write `{call}`"
        ),
        [command, _] if tip.starts_with("subcommand") => said!(
            "有命令 `{command}`；使用它要去掉前面的 `--`",
            "to use the command `{command}`, remove the `--` before it"
        ),
        [call] if tip.ends_with("exists") => {
            said!("有 `{call}`", "`{call}` exists")
        }
        _ => tip.to_owned(),
    }
}

/// `a`, `b`
fn listed(names: &[String]) -> String {
    let names: Vec<_> = names.iter().map(|name| format!("`{name}`")).collect();
    names.join(both("、", ", "))
}

fn word(error: &Error, kind: ContextKind) -> Option<String> {
    words(error, kind).into_iter().next()
}

fn words(error: &Error, kind: ContextKind) -> Vec<String> {
    match error.get(kind) {
        Some(ContextValue::String(word)) => vec![word.clone()],
        Some(ContextValue::Strings(words)) => words.clone(),
        Some(ContextValue::StyledStr(text)) => vec![text.to_string()],
        Some(ContextValue::StyledStrs(texts)) => texts.iter().map(ToString::to_string).collect(),
        _ => Vec::new(),
    }
}

fn number(error: &Error, kind: ContextKind) -> Option<isize> {
    match error.get(kind) {
        Some(ContextValue::Number(number)) => Some(*number),
        _ => None,
    }
}
