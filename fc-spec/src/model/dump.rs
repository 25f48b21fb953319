//! The model as one document for other programs, and back: `fcproto inspect` and `fcproto generate --from`.
//!
//! Every part is serialized as it is; only what lies below the messages is gathered under `protocol`.

use super::{
    Answer, Availability, CallDefaults, Change, CodeRange, Condition, Conflict, CoordinateSystem,
    Entity, Envelope, Frame, Group, JsonRule, Limits, MissingSection, Model, Operation, Protocol,
    Question, ResultCode, RetiredCode, Store, Table, Term, Text, Transport, TypeShape, Types,
    Unlinked, Waiver,
};
use crate::{names, text};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// What the generator knows of a protocol, for other programs.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Dump {
    /// Counts up when a key changes its meaning or goes. A key that is new in a format has a default.
    pub format: u32,
    /// The protocol as a whole, and what lies below its messages.
    protocol: Below,
    /// Groups of operations, in the order of their files' names.
    groups: Vec<Group>,
    /// Commands, reports and streams, by group, in the order of the files.
    operations: Vec<Operation>,
    /// Declared types and those made for bodies, as they stand in the spec.
    types: Types,
    /// By number.
    result_codes: Vec<ResultCode>,
    /// By number, both ends included.
    ranges: Vec<CodeRange>,
    /// By number.
    retired_codes: Vec<RetiredCode>,
    /// Published tables of constants.
    tables: Vec<Table>,
    /// What the ids in bodies stand for.
    entities: Vec<Entity>,
    /// In which positions are given.
    coordinates: Vec<CoordinateSystem>,
    /// Where things are kept.
    stores: Vec<Store>,
    /// Audiences, lines of machines and series of releases.
    availability: Availability,
    /// The words of the protocol and what they mean.
    glossary: Vec<Term>,
    /// Findings that are accepted for a time.
    #[serde(default)]
    waivers: Vec<Waiver>,
    /// What the source lacks or contradicts.
    conflicts: Vec<Conflict>,
    /// What the spec answers to that.
    answers: Vec<Answer>,
    /// What only the owner of the protocol can say, the most pressing first.
    questions: Vec<Question>,
    /// Sections of the source of which nothing is left.
    lost_sections: Vec<MissingSection>,
    /// Of the protocol as a whole.
    changes: Vec<Change>,
}

/// The protocol as a whole, and what lies below its messages.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[schemars(rename = "Protocol")]
struct Below {
    #[serde(flatten)]
    protocol: Protocol,
    #[serde(flatten)]
    transport: Transport,
    frame: Frame,
    /// What is done where JSON leaves it open, by rule.
    json: BTreeMap<JsonRule, Text>,
    /// The keys beside those of a message.
    envelope: Envelope,
    calls: CallDefaults,
    limits: Limits,
}

/// Why a text is no dump that can be used.
#[derive(Debug)]
pub enum DumpError {
    /// It is not JSON, or a key is missing or holds something else.
    Shape(serde_json::Error),
    /// It was written by a version whose keys have other meanings.
    Format(u32),
    /// A name that stands for nothing.
    Name(Unlinked),
    /// The spelling of a code is that of another code.
    Spelling(String),
    /// The example or default of a field, `Type.key`, is no value of its type.
    Value(String),
}

impl DumpError {
    /// The sentence for the user.
    #[must_use]
    pub fn text(&self) -> Text {
        match self {
            Self::Shape(error) => text!(
                "不是 `fcproto inspect` 的输出：{error}",
                "not a dump of `fcproto inspect`: {error}"
            ),
            Self::Format(found) => {
                let format = Dump::FORMAT;
                text!(
                    "输出的格式是 {found}；这个版本读取的格式是 {format}：用这个 `fcproto inspect` 从规范重新输出",
                    "a dump of format {found}; this version reads format {format}: print it again from its spec, with this `fcproto inspect`"
                )
            }
            Self::Spelling(spelling) => text!(
                "功能码的写法 {spelling} 与它的数值不一致",
                "the spelling {spelling} of a code does not match its number"
            ),
            Self::Value(field) => text!(
                "`{field}` 的示例或默认值与它的类型不符",
                "the example or default of `{field}` does not fit its type"
            ),
            Self::Name(Unlinked { missing, user }) => text!(
                "{user} 用到了 {missing}，而输出中没有它",
                "{user} names {missing}, which is not in the dump"
            ),
        }
    }
}

impl std::fmt::Display for DumpError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.text().en)
    }
}

impl std::error::Error for DumpError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Shape(error) => Some(error),
            Self::Format(_) | Self::Name(_) | Self::Spelling(_) | Self::Value(_) => None,
        }
    }
}

impl From<&Model> for Dump {
    fn from(model: &Model) -> Self {
        let model = model.clone();
        Self {
            format: Self::FORMAT,
            protocol: Below {
                protocol: model.protocol,
                transport: model.transport,
                frame: model.frame,
                json: model.json,
                envelope: model.envelope,
                calls: model.calls,
                limits: model.limits,
            },
            groups: model.groups,
            operations: model.operations,
            types: model.types,
            result_codes: model.results,
            ranges: model.ranges,
            retired_codes: model.retired,
            tables: model.tables,
            entities: model.entities,
            coordinates: model.coordinates,
            stores: model.stores,
            availability: model.availability,
            glossary: model.glossary,
            waivers: model.waivers,
            conflicts: model.conflicts,
            answers: model.answers,
            questions: model.questions,
            lost_sections: model.missing_sections,
            changes: model.changes,
        }
    }
}

impl Dump {
    /// Returns the JSON Schema of a dump, indented, with a newline at its end. It lacks keys that are computed from others.
    #[must_use]
    pub fn schema() -> String {
        // Only keys that are no strings can fail, and a schema has none.
        let schema = serde_json::to_string_pretty(&schemars::schema_for!(Self));
        schema.unwrap_or_default() + "\n"
    }

    /// Version of the format that is written and read.
    pub const FORMAT: u32 = 3;

    /// The model of a dump.
    ///
    /// # Errors
    ///
    /// [`DumpError`] for what is not a dump, is one of another format, or names what is not in it. What else
    /// `fcproto check` demands of a spec was checked when the dump was made.
    pub fn read(json: &str) -> Result<Model, DumpError> {
        #[derive(Deserialize)]
        struct Head {
            format: u32,
        }
        let Head { format } = serde_json::from_str(json).map_err(DumpError::Shape)?;
        if format != Self::FORMAT {
            return Err(DumpError::Format(format));
        }
        let dump: Self = serde_json::from_str(json).map_err(DumpError::Shape)?;
        dump.check_codes()?;
        dump.check_conditions().map_err(DumpError::Name)?;
        let model = dump.model();
        model.check_names().map_err(DumpError::Name)?;
        let model = model.link().map_err(DumpError::Name)?;
        model.check_ways().map_err(DumpError::Name)?;
        model.check_bodies().map_err(DumpError::Name)?;
        if let Some((ty, field)) = model.misfit() {
            return Err(DumpError::Value(format!("{}.{}", ty.name, field.wire)));
        }
        Ok(model)
    }

    /// The same things in a model, whose references are by name only.
    fn model(self) -> Model {
        let below = self.protocol;
        Model {
            protocol: below.protocol,
            transport: below.transport,
            frame: below.frame,
            json: below.json,
            envelope: below.envelope,
            results: self.result_codes,
            calls: below.calls,
            limits: below.limits,
            ranges: self.ranges,
            retired: self.retired_codes,
            groups: self.groups,
            operations: self.operations,
            types: self.types,
            tables: self.tables,
            entities: self.entities,
            coordinates: self.coordinates,
            stores: self.stores,
            availability: self.availability,
            glossary: self.glossary,
            waivers: self.waivers,
            missing_sections: self.lost_sections,
            conflicts: self.conflicts,
            answers: self.answers,
            questions: self.questions,
            changes: self.changes,
        }
    }

    /// Every code is spelled as its number.
    fn check_codes(&self) -> Result<(), DumpError> {
        let operations = self.operations.iter().map(|it| &it.code);
        let operations = operations.map(|code| (code.value, &code.spelling));
        let ranges = self.ranges.iter().flat_map(|it| {
            [
                (Some(it.first), &it.first_spelling),
                (Some(it.last), &it.last_spelling),
            ]
        });
        let retired = self.retired_codes.iter();
        let retired = retired.map(|it| (Some(it.code), &it.spelling));
        let mut codes = operations.chain(ranges).chain(retired);
        match codes.find(|(value, spelling)| names::code(spelling) != *value) {
            Some((_, spelling)) => Err(DumpError::Spelling(spelling.clone())),
            None => Ok(()),
        }
    }

    /// Every condition asks fields that there are beside its own.
    fn check_conditions(&self) -> Result<(), Unlinked> {
        for ty in &self.types {
            let TypeShape::Struct(shape) = &ty.shape else {
                continue;
            };
            for field in &shape.fields {
                let condition = field.details().condition.as_ref();
                let mut asked = condition.map(Condition::asked).into_iter().flatten();
                if let Some(asked) = asked.find(|asked| shape.field(&asked.wire).is_none()) {
                    return Err(Unlinked {
                        missing: format!("the field `{}`", asked.wire),
                        user: format!("`{}.{}`", ty.name, field.wire),
                    });
                }
            }
        }
        Ok(())
    }
}
