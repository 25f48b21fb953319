//! Converts a model to one JSON document and back, for `fcproto inspect` and `fcproto generate --from`.
//!
//! The dump has the same parts as the model. Only the layers below the messages are grouped under `protocol`.

use super::{Condition, Dump, Model, Text, Unlinked};
use crate::{names, text};
use serde::Deserialize;

/// The reason why a text is not a usable dump.
#[derive(Debug)]
pub enum DumpError {
    /// The text is not JSON, lacks a key, or has a value of another type.
    Shape(serde_json::Error),
    /// The dump has another format version, in which keys have other meanings.
    Format(u32),
    /// A name that refers to an undeclared thing.
    Name(Unlinked),
    /// The spelling of a code does not match its number.
    Spelling(String),
    /// A value does not fit its type: the example or default of a field, `Type.key`, or a row of a table.
    Value(String),
}

impl DumpError {
    /// Returns the message for the user.
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
            Self::Value(place) => text!(
                "`{place}` 中有与类型不符的值",
                "a value of `{place}` does not fit its type"
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

impl Dump {
    /// Returns the JSON Schema of a dump, indented, with a newline at its end. It omits computed keys.
    #[must_use]
    pub fn schema() -> String {
        // Serialization fails only for keys that are not strings, and a schema has none.
        let schema = serde_json::to_string_pretty(&schemars::schema_for!(Self));
        schema.unwrap_or_default() + "\n"
    }

    /// The format version that this crate writes and reads.
    pub const FORMAT: u32 = 3;

    /// Returns the model of a dump.
    ///
    /// # Errors
    ///
    /// [`DumpError`] if the text is not a dump, has another format version, or refers to an undeclared thing. Other checks of `fcproto
    /// check` ran when the dump was made.
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
        let model = dump.model();
        model.check_codes()?;
        model.check_conditions().map_err(DumpError::Name)?;
        model.check_names().map_err(DumpError::Name)?;
        let model = model.link().map_err(DumpError::Name)?;
        model.check_ways().map_err(DumpError::Name)?;
        model.check_bodies().map_err(DumpError::Name)?;
        if let Some(place) = model.misfit() {
            return Err(DumpError::Value(place));
        }
        Ok(model)
    }
}

impl Model {
    /// Checks that the spelling of every code matches its number.
    fn check_codes(&self) -> Result<(), DumpError> {
        let operations = self.operations.iter().map(|it| &it.code);
        let operations = operations.map(|code| (code.value, &code.spelling));
        let ranges = self.ranges.iter().flat_map(|it| {
            [
                (Some(it.first), &it.first_spelling),
                (Some(it.last), &it.last_spelling),
            ]
        });
        let retired = self.retired.iter();
        let retired = retired.map(|it| (Some(it.code), &it.spelling));
        let mut codes = operations.chain(ranges).chain(retired);
        match codes.find(|(value, spelling)| names::code(spelling) != *value) {
            Some((_, spelling)) => Err(DumpError::Spelling(spelling.clone())),
            None => Ok(()),
        }
    }

    /// Checks that the fields in every condition exist in the same struct.
    fn check_conditions(&self) -> Result<(), Unlinked> {
        for ty in &self.types {
            let Some(shape) = ty.shape.structure() else {
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
