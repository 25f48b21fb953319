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
        #[derive(Clone, Debug)]
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

        /// What the generator knows of a protocol, for other programs.
        #[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
        pub struct Dump {
            /// Counts up when a key changes its meaning or goes. A key that is new in a format has a default.
            pub format: u32,
            /// The protocol as a whole, and what lies below its messages.
            protocol: Below,
            $($(#[doc = $doc])+ $(#[serde($($serde)+)])? $list: $List,)+
        }

        /// The protocol as a whole, and what lies below its messages.
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
        /// What is done where JSON leaves it open, by rule.
        json: BTreeMap<JsonRule, Text>,
        /// The keys beside those of a message.
        envelope: Envelope,
        calls: CallDefaults,
        limits: Limits,
    }
    lists {
        /// Groups of operations, in the order of their files' names.
        groups: Vec<Group>,
        /// Commands, reports and streams, by group, in the order of the files.
        operations: Vec<Operation>,
        /// Declared types and those made for bodies, as they stand in the spec.
        types: Types,
        /// By number.
        results (rename = "result_codes"): Vec<ResultCode>,
        /// By number, both ends included.
        ranges: Vec<CodeRange>,
        /// By number.
        retired (rename = "retired_codes"): Vec<RetiredCode>,
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
        waivers (default): Vec<Waiver>,
        /// What the source lacks or contradicts.
        conflicts: Vec<Conflict>,
        /// What the spec answers to that.
        answers: Vec<Answer>,
        /// What only the owner of the protocol can say, the most pressing first.
        questions: Vec<Question>,
        /// Sections of the source of which nothing is left.
        missing_sections (rename = "lost_sections"): Vec<MissingSection>,
        /// Of the protocol as a whole.
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
