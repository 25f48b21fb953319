//! The resolved model of a spec, with every name resolved and every default filled in.
//!
//! **Architecture invariant.** Emitters read this model and nothing else. Every emitter can emit a model that passed all checks, so
//! emitters need no checks for spec errors.

mod available;
mod body;
mod cadence;
mod condition;
mod constraint;
mod coordinates;
mod dump;
mod dump_check;
mod entity;
mod exchange_dump;
mod frame;
mod glossary;
mod named;
mod operation;
mod pattern;
mod precondition;
mod process;
mod projection;
mod protocol;
mod question;
mod reference;
mod schema;
mod sections;
mod stream;
mod text;
mod text_form;
mod types;
mod value;
mod waiver;

pub use crate::names::{has_unprintable, is_hidden};
pub use crate::vocabulary::{
    AnswerKind, BodyState, ByteOrder, DigestAlgorithm, Direction, Effect, EncodingRole,
    EnvelopeRole, Fact, FloatKind, HeaderQuirk, HeaderRole, Impact, IntKind, JsonRule, Kind,
    KindRole, PortRole, Quirk, RangeUse, ResultRole, Severity, Side, StateOrder, WireForm,
};
pub use available::{Availability, Available, Declared};
pub use body::{
    BodyField, EnumRepr, EnumType, EnumValue, Example, Field, FieldDetails, OneOf, StructType,
    Type, TypeDef, TypeShape, Variant,
};
pub use cadence::{Cadence, Step};
pub use condition::{Asked, Condition};
pub use constraint::{Argument, Constraint, Constraints, Judged};
pub use coordinates::*;
pub use dump::DumpError;
pub use entity::*;
pub use frame::{Encoding, Frame, FrameKind, FrameKinds, HeaderField, HeaderType};
pub use glossary::Term;
pub use operation::{
    Ack, Body, CallDefaults, Code, DeclaredError, Exchange, Group, Messages, Operation,
};
pub use pattern::{Pattern, PatternError};
pub use precondition::{Accepted, AcceptedIn, StateSet};
pub use process::{KeyPath, SetOff, Tie};
pub(crate) use process::{enums, way};
pub use projection::ProjectionError;
pub use protocol::{
    CodeRange, Conflict, Envelope, EnvelopeField, Limits, MissingSection, Party, Port, Ports,
    Protocol, ResultCode, RetiredCode, Table, Transport,
};
pub use question::{Confirmation, Governed, Question};
pub use reference::{StructRef, TypeId, TypeRef};
pub use sections::{Dump, Model, Partial};
pub use stream::{Content, Stream};
pub use text::{
    Aliases, Answer, Change, Deprecation, Lang, Languages, Location, Part, Subject, Text,
};
pub(crate) use types::link;
pub use types::{Types, Unlinked};
pub use value::{Number, Scalar, Value};
pub use waiver::{Waiver, fingerprint, is_past};

use std::collections::BTreeSet;

impl Model {
    /// Sets the id of every reference.
    ///
    /// # Errors
    ///
    /// [`Unlinked`] if a reference names a missing type, or a type that is not a struct where a struct is required. A checked spec has no
    /// such reference.
    pub(crate) fn link(mut self) -> Result<Self, Unlinked> {
        let missing = link(
            &mut self.types,
            &mut self.operations,
            &mut self.tables,
            Some(&mut self.envelope),
        );
        missing.map_or(Ok(self), Err)
    }

    /// Returns the operation with this name, if there is one.
    #[must_use]
    pub fn operation(&self, name: &str) -> Option<&Operation> {
        self.operations
            .iter()
            .find(|operation| operation.name == name)
    }

    /// Returns the commands that set off a report, in the order of the spec.
    pub fn commands_that_set_off<'m>(
        &'m self,
        report: &'m Operation,
    ) -> impl Iterator<Item = &'m Operation> {
        let operations = self.operations.iter();
        operations.filter(|operation| {
            let mut sets_off = operation.sets_off().iter();
            sets_off.any(|set_off| set_off.report == report.name)
        })
    }

    /// Returns the streams that a command starts or stops, in the order of the spec.
    pub fn streams_of<'m>(&'m self, command: &'m Operation) -> impl Iterator<Item = &'m Operation> {
        let operations = self.operations.iter();
        operations.filter(|operation| {
            let mut commands = operation.stream().into_iter().flat_map(Stream::commands);
            commands.any(|name| name == command.name)
        })
    }

    /// Returns the group with this id, if there is one.
    #[must_use]
    pub fn group(&self, id: &str) -> Option<&Group> {
        self.groups.iter().find(|group| group.id == id)
    }

    /// Returns the entity with this name, if there is one.
    #[must_use]
    pub fn entity(&self, name: &str) -> Option<&Entity> {
        self.entities.iter().find(|entity| entity.name == name)
    }

    /// Returns the answers of the spec to a gap in the source. A checked model has an answer to each gap.
    pub fn answers_to(&self, conflict: &Conflict) -> impl Iterator<Item = &Answer> + Clone {
        let answers = self.answers.iter();
        answers.filter(|answer| answer.ids.contains(&conflict.id))
    }

    /// Returns the codes in use and the retired codes. New operations cannot get them.
    #[must_use]
    pub fn taken_codes(&self) -> BTreeSet<u16> {
        taken_codes(self.operations.iter(), self.retired.iter())
    }

    /// Returns the next code of a group in the ranges with this use. `None` allows the ranges of any group.
    #[must_use]
    pub fn next_code(&self, usage: RangeUse, group: Option<&str>) -> Option<u16> {
        let (operations, retired) = (self.operations.iter(), self.retired.iter());
        next_code(operations, retired, self.ranges.iter(), usage, group)
    }
}

fn taken_codes<'m>(
    operations: impl Iterator<Item = &'m Operation>,
    retired: impl Iterator<Item = &'m RetiredCode>,
) -> BTreeSet<u16> {
    let used = operations.filter_map(|operation| operation.code.value);
    used.chain(retired.map(|retired| retired.code)).collect()
}

/// Returns the next code in a spec that may have errors.
///
/// The ranges of a group are the ranges that name it. If no range names it, they are the ranges without `groups`. Of these, ranges that
/// already contain codes of the group come first.
pub(crate) fn next_code<'m>(
    operations: impl Iterator<Item = &'m Operation> + Clone,
    retired: impl Iterator<Item = &'m RetiredCode>,
    ranges: impl Iterator<Item = &'m CodeRange>,
    usage: RangeUse,
    group: Option<&str>,
) -> Option<u16> {
    let mut ranges: Vec<&CodeRange> = ranges.filter(|range| range.usage == usage).collect();
    if let Some(group) = group {
        let names = |range: &&CodeRange| range.groups.iter().any(|it| it == group);
        if ranges.iter().any(names) {
            ranges.retain(names);
        } else {
            ranges.retain(|range| range.groups.is_empty());
            let own = operations.clone().filter(|it| it.group == group);
            let own: Vec<u16> = own.filter_map(|it| it.code.value).collect();
            ranges.sort_by_key(|range| !own.iter().any(|code| range.has(*code)));
        }
    }
    let taken = taken_codes(operations, retired);
    ranges.into_iter().find_map(|range| range.next(&taken))
}
