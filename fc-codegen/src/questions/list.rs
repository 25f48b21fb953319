//! Renders questions as text and as Markdown.

use super::{By, List, facts};
use crate::emit::markdown::{Word as _, confirmed};
use fc_spec::model::Question;
use std::fmt::Write as _;

impl List<'_> {
    /// Returns the questions for a terminal.
    #[must_use]
    pub fn text(&self) -> String {
        let mut text = String::new();
        for (title, questions) in self.gathered() {
            // Writing to a String cannot fail.
            let _ = writeln!(text, "{title} ({})\n", questions.len());
            for question in questions {
                let place = &question.location;
                let _ = writeln!(
                    text,
                    "  {} · {} · {}:{}",
                    question.id,
                    self.about(question).replace('`', ""),
                    place.file,
                    place.line
                );
                let _ = writeln!(text, "    {}", self.lang.text(&question.text));
                if !question.about.is_empty() {
                    let _ = writeln!(text, "    [{}]", facts(&question.about));
                }
                if let Some(word) = self.word(question) {
                    let _ = writeln!(text, "    {word}");
                }
                text.push('\n');
            }
        }
        text
    }

    /// Returns the lines that the answers change.
    #[must_use]
    pub fn edits(&self) -> String {
        let open = self.questions.iter().filter(|it| it.is_open());
        open.map(|it| it.edit.as_str()).collect()
    }

    /// Returns the questions as a document for the owner.
    #[must_use]
    pub fn markdown(&self) -> String {
        let mut text = format!(
            "# {}\n",
            self.lang.pick("待确认的问题", "Questions for the owner")
        );
        for (title, questions) in self.gathered() {
            let _ = writeln!(text, "\n## {title}\n");
            for question in questions {
                let _ = write!(
                    text,
                    "- **{}** · {}{}{}",
                    question.id,
                    self.about(question),
                    self.lang.pick("：", ": "),
                    self.lang.text(&question.text)
                );
                if !question.about.is_empty() {
                    let _ = write!(text, " `{}`", facts(&question.about));
                }
                if let Some(word) = self.word(question) {
                    let _ = write!(text, " *{word}*");
                }
                text.push('\n');
            }
        }
        text
    }

    /// Returns the questions by section, in the order of their first questions.
    fn gathered(&self) -> Vec<(String, Vec<&Question>)> {
        let mut gathered: Vec<(String, Vec<&Question>)> = Vec::new();
        for question in &self.questions {
            let title = self.title(question);
            match gathered.iter_mut().find(|(known, _)| *known == title) {
                Some((_, questions)) => questions.push(question),
                None => gathered.push((title, vec![question])),
            }
        }
        gathered
    }

    fn title(&self, question: &Question) -> String {
        let lang = self.lang;
        let settled = lang.pick("已确认", "Confirmed");
        match self.by {
            By::Impact if question.is_open() => question.impact.word(lang).to_owned(),
            By::State if question.is_open() => lang.pick("待确认", "Open").to_owned(),
            By::Impact | By::State => settled.to_owned(),
            By::Group => {
                let group = question.group.as_deref();
                match group.and_then(|id| self.book.model.group(id)) {
                    Some(group) => lang.text(&group.title).to_owned(),
                    None => lang.pick("整个协议", "The protocol as a whole").to_owned(),
                }
            }
        }
    }

    /// Returns the confirmation of a question.
    fn word(&self, question: &Question) -> Option<String> {
        let word = question.confirmed.as_ref()?;
        Some(confirmed(word, self.lang))
    }
}
