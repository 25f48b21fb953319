//! The choice of records.

use super::Record;
use crate::error::InputError;
use fc_spec::model::Model;
use fc_spec::text;

/// Selects records. An empty list selects all.
#[derive(Clone, Debug, Default)]
pub struct Filter {
    /// Names of operations.
    pub names: Vec<String>,
    /// Result codes of responses.
    pub results: Vec<i64>,
    /// Command codes.
    pub codes: Vec<u16>,
    /// Message ids.
    pub ids: Vec<u32>,
    /// Selects frames with errors only.
    pub only_errors: bool,
}

impl Filter {
    /// Selects operations by name, and responses by the code or the name of their result.
    ///
    /// # Errors
    /// [`InputError`] if the spec has no operation or result with a name.
    pub fn new(model: &Model, names: &[String], results: &[String]) -> Result<Self, InputError> {
        let unknown = names.iter().find(|name| model.operation(name).is_none());
        if let Some(name) = unknown {
            return Err(InputError::unknown_operation(name));
        }
        let results = results.iter().map(|name| result(model, name));
        Ok(Self {
            names: names.to_vec(),
            results: results.collect::<Result<_, _>>()?,
            ..Self::default()
        })
    }

    /// Returns `true` if a record is selected.
    #[must_use]
    pub fn wants(&self, record: &Record<'_>) -> bool {
        let name = record.operation.map(|operation| &operation.name);
        (!self.only_errors || record.error.is_some())
            && has(&self.codes, record.id.map(|id| id.code).as_ref())
            && has(&self.ids, record.id.map(|id| id.id).as_ref())
            && has(&self.names, name)
            && has(&self.results, record.result().as_ref())
    }
}

/// Returns the code of a result.
fn result(model: &Model, name: &str) -> Result<i64, InputError> {
    let known = model.results.iter().find(|result| result.name == name);
    let code = known
        .map(|result| result.code)
        .or_else(|| name.parse().ok());
    code.ok_or_else(|| {
        InputError(text!(
            "没有结果 `{name}`；写结果码，或规范中的名称",
            "there is no result `{name}`; write a code, or a name of the spec"
        ))
    })
}

/// Returns `true` if a list has a value. An empty list has every value.
fn has<T: PartialEq>(wanted: &[T], value: Option<&T>) -> bool {
    wanted.is_empty() || value.is_some_and(|value| wanted.contains(value))
}
