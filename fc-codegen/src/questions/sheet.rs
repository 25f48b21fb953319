//! Questions as a sheet of comma-separated values. The owner fills in a column and sends it back.

use super::{List, facts};
use crate::emit::markdown::{Lang, Word as _};
use fc_spec::load::Said;
use fc_spec::model::{Confirmation, Governed, Model, Question, Text};
use fc_spec::text;
use std::fmt;

/// Without this mark, spreadsheets assume another encoding.
const BYTE_ORDER_MARK: &str = "\u{feff}";

/// The columns, in Chinese and English.
const COLUMNS: [(Column, &str, &str); 9] = [
    (Column::Id, "编号", "id"),
    (Column::Impact, "影响", "impact"),
    (Column::About, "对象", "about"),
    (Column::Question, "问题", "question"),
    (Column::Facts, "目前的写法", "facts"),
    (Column::Answer, "答复", "answer"),
    (Column::By, "答复人", "by"),
    (Column::Date, "日期", "date"),
    (Column::Reference, "凭据", "reference"),
];

/// The values of `answer` that confirm the spec unchanged.
const YES: [&str; 5] = ["ok", "yes", "确认", "是", "对"];

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Column {
    Id,
    Impact,
    About,
    Question,
    Facts,
    Answer,
    By,
    Date,
    Reference,
}

/// The reason why a sheet cannot be read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SheetError {
    /// It is not comma-separated, or not UTF-8.
    Malformed(String),
    /// A column is missing. The values are its English and Chinese names.
    NoColumn(&'static str, &'static str),
    /// A line cannot be used.
    Line {
        /// The number of the line, from 1.
        line: u64,
        /// The value of its `id`.
        id: String,
        /// The reason, as a sentence without a full stop.
        why: Text,
    },
}

impl SheetError {
    /// Returns the reason in both languages, as a sentence without a full stop.
    #[must_use]
    pub fn text(&self) -> Text {
        match self {
            Self::Malformed(why) => text!(
                "无法读取表格：{why}；存为 UTF-8 编码的 CSV",
                "the sheet cannot be read: {why}; save it as comma-separated values in UTF-8"
            ),
            Self::NoColumn(en, zh) => text!(
                "表格没有 `{zh}`（`{en}`）列",
                "the sheet has no column `{en}` (`{zh}`)"
            ),
            Self::Line { line, id, why } => {
                text!(
                    "第 {line} 行（{id}）：{why}",
                    "line {line} ({id}): {why}",
                    why = why
                )
            }
        }
    }
}

impl fmt::Display for SheetError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text().en)
    }
}

impl std::error::Error for SheetError {}

impl List<'_> {
    /// Returns comma-separated values with an empty column for the answers.
    #[must_use]
    pub fn csv(&self) -> String {
        let mut writer = csv::Writer::from_writer(Vec::new());
        let header = COLUMNS.map(|(_, zh, en)| self.lang.pick(zh, en));
        // Writing to memory cannot fail.
        let _ = writer.write_record(header);
        for question in &self.questions {
            let _ = writer.write_record(COLUMNS.map(|(column, ..)| self.cell(column, question)));
        }
        let bytes = writer.into_inner().unwrap_or_default();
        format!("{BYTE_ORDER_MARK}{}", String::from_utf8_lossy(&bytes))
    }

    fn cell(&self, column: Column, question: &Question) -> String {
        let word = question.confirmed.as_ref();
        match column {
            Column::Id => question.id.clone(),
            Column::Impact => question.impact.word(self.lang).to_owned(),
            Column::About => self.about(question).replace('`', ""),
            Column::Question => self.lang.text(&question.text).to_owned(),
            Column::Facts => facts(&question.about),
            Column::Answer => word.and_then(|word| word.reply.clone()).unwrap_or_default(),
            Column::By => word.map(|word| word.by.clone()).unwrap_or_default(),
            Column::Date => word.map(|word| word.date.clone()).unwrap_or_default(),
            Column::Reference => word
                .and_then(|word| word.reference.clone())
                .unwrap_or_default(),
        }
    }
}

/// Returns the answers of the owner. Skips lines without an answer and lines of settled questions. `by` and `date` are
/// the defaults for lines without these values.
///
/// # Errors
///
/// The error of a malformed sheet or a missing column, or of every unusable line. A line is unusable if its question is
/// unknown or has changed, if it names no person, or if its answer is invalid.
pub fn read(
    sheet: &[u8],
    model: &Model,
    by: Option<&str>,
    date: &str,
) -> Result<Vec<Said>, Vec<SheetError>> {
    let malformed = |error: csv::Error| vec![SheetError::Malformed(error.to_string())];
    let first = sheet
        .split(|byte| *byte == b'\n')
        .next()
        .unwrap_or_default();
    // The separator of a spreadsheet depends on its country settings.
    let count = |byte: &u8| first.split(|it| it == byte).count();
    let delimiter = [b',', b';', b'\t']
        .into_iter()
        .max_by_key(|byte| (count(byte), *byte == b','));
    let mut reader = csv::ReaderBuilder::new()
        .delimiter(delimiter.unwrap_or(b','))
        .flexible(true)
        .from_reader(sheet);
    let header = reader.headers().map_err(malformed)?.clone();
    let place = |wanted: Column| {
        let (_, zh, en) = COLUMNS.into_iter().find(|(column, ..)| *column == wanted)?;
        header
            .iter()
            .position(|name| [zh, en].contains(&name.trim_start_matches(BYTE_ORDER_MARK).trim()))
    };
    for (column, zh, en) in COLUMNS {
        if matches!(column, Column::Id | Column::Answer) && place(column).is_none() {
            return Err(vec![SheetError::NoColumn(en, zh)]);
        }
    }
    let (mut said, mut errors) = (Vec::new(), Vec::new());
    for record in reader.records() {
        let record = match record {
            Ok(record) => record,
            Err(error) => {
                errors.extend(malformed(error));
                break;
            }
        };
        let cell = |column| {
            place(column)
                .and_then(|at| record.get(at))
                .unwrap_or_default()
                .trim()
        };
        let (id, answer) = (cell(Column::Id), cell(Column::Answer));
        if answer.is_empty() {
            continue;
        }
        let fail = |why: Text| SheetError::Line {
            line: record.position().map_or(0, csv::Position::line),
            id: id.to_owned(),
            why,
        };
        let Some(question) = model.questions.iter().find(|question| question.id == id) else {
            errors.push(fail(text!("没有这个问题", "there is no such question")));
            continue;
        };
        if !question.is_open() {
            continue;
        }
        let asked = cell(Column::Question);
        let texts = [Lang::Zh, Lang::En].map(|lang| lang.text(&question.text));
        if !asked.is_empty() && !texts.contains(&asked) {
            errors.push(fail(text!(
                "导出表格之后问题已改写；重新导出表格",
                "the question has changed since the export; export a new sheet"
            )));
            continue;
        }
        let Some(by) = Some(cell(Column::By)).filter(|by| !by.is_empty()).or(by) else {
            errors.push(fail(text!(
                "`答复人` 为空；填写它，或用 `--by` 指定",
                "`by` is empty; fill it in, or pass `--by`"
            )));
            continue;
        };
        match values(&question.about, answer) {
            Ok((values, reply)) => said.push(Said {
                id: id.to_owned(),
                values,
                confirmation: Confirmation {
                    by: by.to_owned(),
                    date: Some(cell(Column::Date))
                        .filter(|it| !it.is_empty())
                        .unwrap_or(date)
                        .to_owned(),
                    reference: Some(cell(Column::Reference).to_owned()).filter(|it| !it.is_empty()),
                    reply,
                },
            }),
            Err(why) => errors.push(fail(why)),
        }
    }
    if errors.is_empty() {
        Ok(said)
    } else {
        Err(errors)
    }
}

/// The values of an answer by path, or the answer in the owner's words if it is about no fact.
type Values = (Vec<(String, String)>, Option<String>);

fn values(about: &[Governed], answer: &str) -> Result<Values, Text> {
    let is_yes = YES.contains(&answer.to_lowercase().as_str());
    match about {
        _ if is_yes => Ok((Vec::new(), None)),
        [] => Ok((Vec::new(), Some(answer.to_owned()))),
        [one] => Ok((vec![(one.path.clone(), answer.to_owned())], None)),
        several => {
            let parts = answer.split([';', '；', '\n']).map(str::trim);
            let parts = parts.filter(|part| !part.is_empty());
            let values = parts.map(|part| match part.split_once(['=', '＝', ':', '：']) {
                Some((path, value)) => Ok((path.trim().to_owned(), value.trim().to_owned())),
                None => Err(text!(
                    "问题涉及多项内容；每项写成 `{first}=VALUE`，用 `;` 隔开",
                    "the question has several facts; write `{first}=VALUE` for each, separated by `;`",
                    first = several.first().map_or("", |first| first.path.as_str())
                )),
            });
            Ok((values.collect::<Result<_, _>>()?, None))
        }
    }
}
