//! The sections of a spec: one list that defines the model, the partial model and the dump.

use super::{
    Answer, Availability, CallDefaults, Change, CodeRange, Conflict, CoordinateSystem, Entity,
    Envelope, Frame, Group, JsonRule, Limits, MissingSection, Operation, Protocol, Question,
    RangeUse, ResultCode, RetiredCode, Store, Table, Term, Text, Transport, Types, Waiver,
    next_code,
};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Declares [`Model`], [`Partial`] and [`Dump`] with the sections of a spec.
///
/// `once` lists the sections that every spec has exactly once; a dump groups them under `protocol`. `lists` contains the other sections.
/// The attributes in parentheses are serde attributes for the dump. The doc comments appear in the schema of the dump.
macro_rules! sections {
    (
        once { $($(#[doc = $once_doc:literal])* $once:ident $(($($once_serde:tt)+))?: $Once:ty,)+ }
        lists { $($(#[doc = $doc:literal])+ $list:ident $(($($serde:tt)+))?: $List:ty,)+ }
    ) => {
        /// A complete, resolved protocol.
        #[derive(Clone, Debug)]
        #[allow(missing_docs, reason = "the types tell")]
        pub struct Model {
            $($(#[doc = $once_doc])* pub $once: $Once,)+
            $($(#[doc = $doc])+ pub $list: $List,)+
        }

        /// The readable parts of a spec that may have errors, as a partial [`Model`].
        ///
        /// It omits missing and malformed sections, and fields with an unknown type. It keeps texts as written, and its references are
        /// linked.
        ///
        /// It has passed no checks, so no product can be made from it. Types may contain themselves, and two operations may have the same
        /// code.
        #[derive(Clone, Debug, Default)]
        #[allow(missing_docs, reason = "they are those of `Model`")]
        pub struct Partial {
            $(pub $once: Option<$Once>,)+
            $(pub $list: $List,)+
        }

        impl Partial {
            /// Returns the model. If a section is missing, returns the partial model again; the loader has reported the section.
            pub(crate) fn whole(self) -> Result<Model, Box<Self>> {
                match self {
                    Self { $($once: Some($once),)+ $($list,)+ } => Ok(Model { $($once,)+ $($list,)+ }),
                    partial => Err(Box::new(partial)),
                }
            }
        }

        /// A complete, resolved protocol, for other programs.
        #[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
        pub struct Dump {
            /// Version of the format. It grows when a key is removed or changes its meaning.
            /// A key added within a version has a default.
            pub format: u32,
            /// The protocol as a whole, and the layers below its messages.
            protocol: Below,
            $($(#[doc = $doc])+ $(#[serde($($serde)+)])? $list: $List,)+
        }

        /// The protocol as a whole, and the layers below its messages.
        #[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
        #[schemars(rename = "Protocol")]
        struct Below {
            $($(#[doc = $once_doc])* $(#[serde($($once_serde)+)])? $once: $Once,)+
        }

        impl From<&Model> for Dump {
            fn from(model: &Model) -> Self {
                let Model { $($once,)+ $($list,)+ } = model.clone();
                Self {
                    format: Self::FORMAT,
                    protocol: Below { $($once,)+ },
                    $($list,)+
                }
            }
        }

        impl Dump {
            /// Returns the sections as a model. Its references have names but no ids.
            pub(super) fn model(self) -> Model {
                let Self { format: _, protocol: Below { $($once,)+ }, $($list,)+ } = self;
                Model { $($once,)+ $($list,)+ }
            }
        }
    };
}

sections! {
    once {
        protocol (flatten): Protocol,
        transport (flatten): Transport,
        frame: Frame,
        /// Handling of JSON where RFC 8259 leaves it open, by rule.
        json: BTreeMap<JsonRule, Text>,
        /// Keys of every message, in addition to those of its body.
        envelope: Envelope,
        calls: CallDefaults,
        limits: Limits,
    }
    lists {
        /// Groups of operations, in the order of their files' names.
        groups: Vec<Group>,
        /// Commands, reports and streams, by group, in the order of the files.
        operations: Vec<Operation>,
        /// Declared types and the types made for bodies, in the order of the spec.
        types: Types,
        /// By number.
        results (rename = "result_codes"): Vec<ResultCode>,
        /// By number, both ends included.
        ranges: Vec<CodeRange>,
        /// By number.
        retired (rename = "retired_codes"): Vec<RetiredCode>,
        /// Published tables of constants.
        tables: Vec<Table>,
        /// Kinds of things that the ids in bodies identify.
        entities: Vec<Entity>,
        /// Coordinate systems of positions.
        coordinates: Vec<CoordinateSystem>,
        /// Stores: the places where values are kept.
        stores: Vec<Store>,
        /// Audiences, lines of machines and series of releases.
        availability: Availability,
        /// Terms of the protocol and their meanings.
        glossary: Vec<Term>,
        /// Findings that are accepted for a time.
        waivers (default): Vec<Waiver>,
        /// Gaps and contradictions of the source.
        conflicts: Vec<Conflict>,
        /// Answers of the spec to the conflicts.
        answers: Vec<Answer>,
        /// Questions and decisions for the owner of the protocol: open ones first, the most urgent at the top.
        questions: Vec<Question>,
        /// Sections that are missing from the source.
        missing_sections (rename = "lost_sections"): Vec<MissingSection>,
        /// Dated changes of the protocol as a whole.
        changes: Vec<Change>,
    }
}

impl Partial {
    /// Returns the next code of a group in the ranges with this use. `None` allows the ranges of any group.
    #[must_use]
    pub fn next_code(&self, usage: RangeUse, group: Option<&str>) -> Option<u16> {
        let (operations, retired) = (self.operations.iter(), self.retired.iter());
        next_code(operations, retired, self.ranges.iter(), usage, group)
    }
}
