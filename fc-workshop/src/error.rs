//! The error in an input from a person.

use fc_spec::model::Text;
use fc_spec::text_error;

/// The reason why an argument, a fault or recorded bytes cannot be read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct InputError(pub(crate) Text);

impl InputError {
    /// Returns the message in both languages.
    #[must_use]
    pub fn text(&self) -> &Text {
        &self.0
    }
}

text_error!(InputError);
