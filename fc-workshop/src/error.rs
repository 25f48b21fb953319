//! The error in an input from a person.

use fc_spec::model::Text;
use fc_spec::{text, text_error};

/// The reason why an argument, a fault or recorded bytes cannot be read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct InputError(pub(crate) Text);

impl InputError {
    /// Returns the message in both languages.
    #[must_use]
    pub fn text(&self) -> &Text {
        &self.0
    }

    /// Returns the error for a name that no operation has.
    pub(crate) fn unknown_operation(name: &str) -> Self {
        Self(text!(
            "没有接口 `{name}`；`fcproto codes` 列出全部接口",
            "there is no operation `{name}`; `fcproto codes` lists them"
        ))
    }
}

text_error!(InputError);
