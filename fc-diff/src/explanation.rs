//! Explanations of all codes: errors of a spec, lint rules and rules for changes.

use crate::rule::Rule;
use fc_spec::diagnostic::{FaultCode, nearest};
use fc_spec::lint;
use fc_spec::model::{Lang, Text};
use fc_spec::{text, text_error};

/// The explanation of a code.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Explanation {
    /// The code, such as `FC0701`.
    pub code: String,
    /// The short title.
    pub title: &'static str,
    /// The explanation as Markdown.
    pub about: String,
}

/// The error for a code that does not exist.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownCode {
    /// The code that was looked up.
    pub code: String,
    /// The most similar code or name of a lint rule.
    pub nearest: Option<&'static str>,
}

impl UnknownCode {
    /// Returns the message for the user.
    #[must_use]
    pub fn text(&self) -> Text {
        let code = &self.code;
        match self.nearest {
            Some(near) => text!(
                "没有错误码 `{code}`；是否想写 `{near}`？",
                "there is no error code `{code}`; did you mean `{near}`?"
            ),
            None => text!(
                "没有错误码 `{code}`；`fcproto explain` 列出全部错误码",
                "there is no error code `{code}`; `fcproto explain` lists them all"
            ),
        }
    }
}

text_error!(UnknownCode);

/// Returns each code with its title: errors of a spec, rules for changes and lint rules.
pub fn titles(lang: Lang) -> impl Iterator<Item = (String, &'static str)> {
    let codes = FaultCode::ALL.iter();
    let codes = codes.map(move |code| (code.to_string(), code.title(lang)));
    let rules = Rule::all().map(move |rule| (rule.code(), rule.title_in(lang)));
    let lints = lint::Rule::all();
    let lints = lints.map(move |rule| (rule.code.number.to_owned(), rule.code.title_in(lang)));
    codes.chain(rules).chain(lints)
}

/// Returns the explanation of a code. The code can be in any case, with or without `FC` and leading zeros. A lint rule
/// can also be named.
///
/// # Errors
///
/// [`UnknownCode`].
pub fn explain(code: &str, lang: Lang) -> Result<Explanation, UnknownCode> {
    if let Some(rule) = Rule::parse(code) {
        return Ok(Explanation {
            code: rule.code(),
            title: rule.title_in(lang),
            about: rule.explain(lang),
        });
    }
    if let Some(rule) = lint::Rule::parse(code) {
        return Ok(Explanation {
            code: rule.code.number.to_owned(),
            title: rule.code.title_in(lang),
            about: rule.explain(lang),
        });
    }
    let known = FaultCode::parse(code).ok_or_else(|| unknown(code))?;
    Ok(Explanation {
        code: known.to_string(),
        title: known.title(lang),
        about: known.explain(lang).to_owned(),
    })
}

fn unknown(code: &str) -> UnknownCode {
    let codes = FaultCode::ALL.iter().map(|code| code.as_str());
    let codes = codes.chain(lint::Rule::all().flat_map(|rule| [rule.code.number, rule.name]));
    UnknownCode {
        code: code.to_owned(),
        nearest: nearest(code, codes),
    }
}
