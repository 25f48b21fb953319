//! What the owner of the protocol has still to say: as lists for people, and as a sheet that goes to the owner and
//! comes back.

mod list;
mod sheet;

pub use crate::emit::markdown::Lang;
pub use sheet::{SheetError, read};

use crate::emit::markdown::{Book, Page, TabsOf};
use fc_spec::model::{Governed, Model, Question};

/// Some of a spec's questions, in an order and a language.
pub struct List<'m> {
    book: Book<'m>,
    questions: Vec<&'m Question>,
    lang: Lang,
    by: By,
}

/// By what questions are gathered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum By {
    /// By what they hold up.
    Impact,
    /// By the group of operations in whose file they stand.
    Group,
    /// By whether they are open.
    State,
}

impl<'m> List<'m> {
    /// The questions of which `wanted` is true.
    #[must_use]
    pub fn new(model: &'m Model, lang: Lang, by: By, wanted: impl Fn(&Question) -> bool) -> Self {
        Self {
            book: Book::new(model, TabsOf::new()),
            questions: model.questions.iter().filter(|it| wanted(it)).collect(),
            lang,
            by,
        }
    }

    /// How many there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.questions.len()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.questions.is_empty()
    }

    /// As they are in `fcproto inspect`, as one JSON document.
    #[must_use]
    pub fn json(&self) -> String {
        // Nothing of a question has keys that are no texts, which is all that can fail.
        serde_json::to_string_pretty(&self.questions).unwrap_or_default() + "\n"
    }

    /// What one is about, for people.
    fn about(&self, question: &Question) -> String {
        self.book.name_of(&question.subject, self.lang, Page::Index)
    }
}

/// The facts that a question governs and what is said of them until it is settled: `code: open`.
fn facts(about: &[Governed]) -> String {
    let facts = about
        .iter()
        .map(|it| format!("{}: {}", it.path, it.meanwhile));
    facts.collect::<Vec<_>>().join("; ")
}
