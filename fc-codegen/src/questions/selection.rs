//! The questions that a list shows, and those that remain after an answer.

use fc_spec::model::{AnswerKind, Model, Question, Text};
use fc_spec::{text, text_error};

/// The conditions for the questions of a list.
#[derive(Clone, Copy, Debug, Default)]
pub struct Selection<'s> {
    /// Ids of questions or conflicts. If there are any, `state`, `group` and `decisions` have no effect.
    pub ids: &'s [String],
    /// The state of the questions.
    pub state: State,
    /// The id of their group of operations; `None` for all.
    pub group: Option<&'s str>,
    /// `true` to include decisions that the owner can confirm.
    pub decisions: bool,
}

/// The state of the selected questions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum State {
    /// The owner has not answered.
    #[default]
    Open,
    /// The owner has answered.
    Confirmed,
    /// Both.
    All,
}

/// The reason why a selection is invalid.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SelectionError {
    /// The spec has no such group.
    NoGroup {
        /// The id that was looked up.
        id: String,
        /// The ids of all groups.
        known: Vec<String>,
    },
    /// The spec has no question with one of these ids.
    NoQuestion {
        /// The ids that were looked up.
        ids: Vec<String>,
    },
}

impl SelectionError {
    /// Returns the message for the user, in both languages.
    #[must_use]
    pub fn text(&self) -> Text {
        match self {
            Self::NoGroup { id, known } => text!(
                "没有分组 `{id}`；分组有：{known}",
                "there is no group `{id}`; there are {known}",
                id = id,
                known = Text::listed(known)
            ),
            Self::NoQuestion { ids } => text!(
                "没有问题 {ids}；`fcproto questions --state all --decisions` 列出全部问题",
                "there is no question {ids}; `fcproto questions --state all --decisions` lists them",
                ids = Text::listed(ids)
            ),
        }
    }
}

text_error!(SelectionError);

impl Selection<'_> {
    /// Returns the selected questions of a model.
    pub(super) fn of<'m>(&self, model: &'m Model) -> Result<Vec<&'m Question>, SelectionError> {
        if let Some(id) = self.group
            && model.group(id).is_none()
        {
            return Err(SelectionError::NoGroup {
                id: id.to_owned(),
                known: model.groups.iter().map(|it| it.id.clone()).collect(),
            });
        }
        let questions = model.questions.iter();
        let selected: Vec<_> = questions.filter(|it| self.includes(it)).collect();
        if selected.is_empty() && !self.ids.is_empty() {
            return Err(SelectionError::NoQuestion {
                ids: self.ids.to_vec(),
            });
        }
        Ok(selected)
    }

    fn includes(&self, question: &Question) -> bool {
        if !self.ids.is_empty() {
            let is_named = |id: &String| *id == question.id || question.ids.contains(id);
            return self.ids.iter().any(is_named);
        }
        let is_in_state = match self.state {
            State::Open => question.is_open(),
            State::Confirmed => !question.is_open(),
            State::All => true,
        };
        is_in_state
            && (self.decisions || question.kind == AnswerKind::Question)
            && (self.group.is_none() || question.group.as_deref() == self.group)
    }
}

/// The open questions after some have been answered.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Remaining<'m> {
    /// The number of open questions.
    pub open: usize,
    /// The ids of those with the same subject as an answered question.
    pub related: Vec<&'m str>,
}

impl<'m> Remaining<'m> {
    /// Returns the open questions of a model with answers to the questions with these ids.
    #[must_use]
    pub fn after(model: &'m Model, answered: &[String]) -> Self {
        let asked = model.questions.iter();
        let asked = asked.filter(|question| question.kind == AnswerKind::Question);
        let settled = asked.clone().filter(|it| answered.contains(&it.id));
        let subjects: Vec<_> = settled.map(|question| &question.subject).collect();
        let open: Vec<_> = asked.filter(|question| question.is_open()).collect();
        let related = open.iter().filter(|it| subjects.contains(&&it.subject));
        Self {
            open: open.len(),
            related: related.map(|question| question.id.as_str()).collect(),
        }
    }
}
