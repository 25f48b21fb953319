//! Questions for the owner of the protocol: lists for people, and a sheet that the owner fills in.

mod list;
mod selection;
mod sheet;

pub use crate::emit::markdown::Lang;
pub use selection::{Remaining, Selection, SelectionError, State};
pub use sheet::{SheetError, read};

use crate::emit::markdown::{Book, Page, TabsByOperation};
use fc_spec::model::{Governed, Model, Question};

/// Some of a spec's questions, in an order and a language.
pub struct List<'m> {
    book: Book<'m>,
    questions: Vec<&'m Question>,
    lang: Lang,
    by: By,
}

/// The sections of a list of questions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum By {
    /// By impact.
    Impact,
    /// By the group of operations whose file has the question.
    Group,
    /// By whether they are open.
    State,
}

impl<'m> List<'m> {
    /// Returns the selected questions.
    ///
    /// # Errors
    ///
    /// [`SelectionError`] if the spec does not have the group, or none of the named questions.
    pub fn new(
        model: &'m Model,
        lang: Lang,
        by: By,
        selection: &Selection<'_>,
    ) -> Result<Self, SelectionError> {
        Ok(Self {
            book: Book::new(model, TabsByOperation::new()),
            questions: selection.of(model)?,
            lang,
            by,
        })
    }

    /// Returns the number of questions.
    #[must_use]
    pub fn len(&self) -> usize {
        self.questions.len()
    }

    /// Returns `true` if there are no questions.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.questions.is_empty()
    }

    /// Returns the questions as one JSON document, in the form of `fcproto inspect`.
    #[must_use]
    pub fn json(&self) -> String {
        // Serialization only fails for keys that are not strings, and questions have none.
        serde_json::to_string_pretty(&self.questions).unwrap_or_default() + "\n"
    }

    /// Returns the title of the subject of a question.
    fn about(&self, question: &Question) -> String {
        self.book.name_of(&question.subject, self.lang, Page::Index)
    }
}

/// Returns the facts that a question governs, each with its state until the question is settled: `code: open`.
fn facts(about: &[Governed]) -> String {
    let facts = about
        .iter()
        .map(|it| format!("{}: {}", it.path, it.meanwhile));
    facts.collect::<Vec<_>>().join("; ")
}
