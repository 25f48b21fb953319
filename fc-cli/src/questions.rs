//! `fcproto questions`.

use clap::ValueEnum;
use fc_codegen::questions::{By, List};
use fc_spec::model::{AnswerKind, Question, Text};

use crate::lang::{lang, said};
use crate::outcome::{Failure, Status};
use crate::place::Place;
use crate::print;
use crate::spec::Spec;

/// List what the owner of the protocol has still to say.
///
/// Every question of the spec, everything that the source document has lost and every inference, the most pressing
/// first. With the id of one, the lines to edit as well.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  fcproto questions                         what is open, by what it holds up
  fcproto questions C040                    one of them, with the lines to edit
  fcproto questions --group task --lang zh  those of one group, in Chinese
  fcproto questions --format csv --lang zh > questions.csv
                                            a sheet for the owner; `fcproto settle --from` reads it")]
pub struct Options {
    /// Ids of questions or conflicts [default: all]
    #[arg(value_name = "ID")]
    ids: Vec<String>,
    /// By what they are gathered.
    #[arg(long, value_name = "ORDER", default_value = "impact")]
    by: Order,
    /// Which of them.
    #[arg(long, value_name = "STATE", value_enum, default_value_t = State::Open)]
    state: State,
    /// Only those of the group with this id.
    #[arg(long, value_name = "GROUP")]
    group: Option<String>,
    /// Also what the spec has decided, for the owner to confirm.
    #[arg(long)]
    decisions: bool,
    /// How to print them.
    #[arg(long, value_name = "FORMAT", default_value = "text")]
    format: Shown,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Order {
    /// What they hold up
    Impact,
    /// The group of operations they belong to
    Group,
    /// Open ones first
    State,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum State {
    /// Waiting for the owner
    Open,
    /// Settled by the owner
    Confirmed,
    /// Both
    All,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Shown {
    /// For reading on a terminal
    Text,
    /// One JSON document
    Json,
    /// A page to send to the owner
    Markdown,
    /// A sheet for the owner to fill in
    Csv,
}

pub fn run(place: &Place, options: &Options) -> Result<Status, Failure> {
    let spec = Spec::read(place)?;
    let Some(model) = &spec.model else {
        spec.show_faults()?;
        return Ok(spec.status());
    };
    if let Some(id) = &options.group
        && model.group(id).is_none()
    {
        let known: Vec<&str> = model.groups.iter().map(|group| group.id.as_str()).collect();
        let known = Text::listed(known);
        return Err(said!(
            "没有分组 `{id}`；分组有：{known}",
            "there is no group `{id}`; there are {known}",
            known = known
        )
        .into());
    }
    let lang = lang();
    let by = match options.by {
        Order::Impact => By::Impact,
        Order::Group => By::Group,
        Order::State => By::State,
    };
    let list = List::new(model, lang, by, |question| options.wants(question));
    if list.is_empty() && !options.ids.is_empty() {
        return Err(said!(
            "没有问题 {ids}；`fcproto questions --state all --decisions` 列出全部问题",
            "there is no question {ids}; `fcproto questions --state all --decisions` lists them",
            ids = Text::listed(&options.ids)
        )
        .into());
    }
    print::result(&match options.format {
        Shown::Text if list.is_empty() => said!("没有问题\n", "no questions\n"),
        Shown::Text if options.ids.is_empty() => list.text(),
        Shown::Text => list.text() + &print::diff(&list.edits()),
        Shown::Json => list.json(),
        Shown::Markdown => list.markdown(),
        Shown::Csv => list.csv(),
    })?;
    Ok(Status::Fine)
}

impl Options {
    /// Who names a question gets it, whatever its state.
    fn wants(&self, question: &Question) -> bool {
        if !self.ids.is_empty() {
            let named = |id: &String| *id == question.id || question.ids.contains(id);
            return self.ids.iter().any(named);
        }
        (match self.state {
            State::Open => question.is_open(),
            State::Confirmed => !question.is_open(),
            State::All => true,
        }) && (self.decisions || question.kind == AnswerKind::Question)
            && self
                .group
                .as_ref()
                .is_none_or(|id| question.group.as_ref() == Some(id))
    }
}
