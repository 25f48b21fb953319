//! References: values that name a thing of the spec.

use super::available::{AVAILABILITY, Audience, Machine, Series};
use super::common::{COMMON, Conflict};
use super::coordinates::{CoordinateSystem, Store};
use super::entity::Entity;
use super::field::{Enum, EnumValue, FIELD, Struct};
use super::file::FILE;
use super::form::{ConflictId, Form, Name, ResultNumber, TypeName};
use super::kind::{Kind, Table};
use super::operation::{Command, Group, Report, Stream};
use super::wire::ResultCode;
use crate::diagnostic::FaultCode;
use crate::syntax::Node;
use std::marker::PhantomData;

/// A kind of thing with a name that values can refer to.
pub(crate) trait Named {
    /// The form of its name.
    type Name: Form;
    /// The parts of the language that can declare it.
    const KINDS: &'static [&'static str];
}

/// The name of a `T`, which the spec declares elsewhere.
#[derive(Debug)]
pub(crate) struct Ref<T>(PhantomData<T>);

impl<T: Named> Form for Ref<T> {
    const KIND: Kind = Kind::Ref {
        name: &T::Name::KIND,
        kinds: T::KINDS,
    };
    type Value<'a> = <T::Name as Form>::Value<'a>;

    fn read(node: Node<'_>) -> Option<Self::Value<'_>> {
        T::Name::read(node)
    }
}

/// An operation of any kind.
#[derive(Debug)]
pub(crate) enum AnyOperation {}

macro_rules! named {
    ($($Thing:ident: $Name:ty = $($Kind:ident)|+;)+) => { $(
        impl Named for $Thing {
            type Name = $Name;
            const KINDS: &'static [&'static str] = &[$($Kind::NAME),+];
        }
    )+ };
}

named! {
    Group: Name = Group;
    Command: Name = Command;
    Report: Name = Report;
    AnyOperation: Name = Command | Report | Stream;
    Struct: TypeName = Struct;
    Enum: TypeName = Enum;
    EnumValue: Name = EnumValue;
    Entity: Name = Entity;
    CoordinateSystem: Name = CoordinateSystem;
    Store: Name = Store;
    Audience: Name = Audience;
    Machine: Name = Machine;
    Series: Name = Series;
    ResultCode: ResultNumber = ResultCode;
    Conflict: ConflictId = Conflict;
}

/// The parts of the language that can declare a type.
pub(crate) const TYPES: &[&str] = &[Struct::NAME, Enum::NAME, super::field::OneOf::NAME];

/// A kind of thing that the spec declares by name, and that must have a reference.
pub(crate) struct Declared {
    /// The mapping that declares one.
    pub table: &'static Table,
    /// The part of a spec that declares them.
    pub home: Home,
    /// The error of a reference to an unknown one.
    pub unknown: FaultCode,
    /// The error of one without a reference.
    pub unused: FaultCode,
}

/// The part of a spec that declares things.
#[derive(Clone, Copy)]
pub(crate) enum Home {
    /// The sections of operations.
    Operations,
    /// A section; `by` is the key of the references.
    Section { key: &'static str, by: &'static str },
    /// A key of `availability`.
    Availability(&'static str),
}

impl Declared {
    const fn available(table: &'static Table, key: &'static str) -> Self {
        Self {
            table,
            home: Home::Availability(key),
            unknown: FaultCode::UnknownAvailability,
            unused: FaultCode::UnusedAvailability,
        }
    }
}

/// The kinds of declared things, except operations and types.
pub(crate) static DECLARED: [Declared; 6] = [
    Declared {
        table: Entity::TABLE,
        home: Home::Section {
            key: FILE.entities.name,
            by: FIELD.refers.name,
        },
        unknown: FaultCode::UnknownEntity,
        unused: FaultCode::UnusedEntity,
    },
    Declared {
        table: CoordinateSystem::TABLE,
        home: Home::Section {
            key: FILE.coordinates.name,
            by: FIELD.coordinates.name,
        },
        unknown: FaultCode::UnknownCoordinates,
        unused: FaultCode::UnusedCoordinates,
    },
    Declared {
        table: Store::TABLE,
        home: Home::Section {
            key: FILE.stores.name,
            by: COMMON.kept.name,
        },
        unknown: FaultCode::UnknownStore,
        unused: FaultCode::UnusedStore,
    },
    Declared::available(Audience::TABLE, AVAILABILITY.audiences.name),
    Declared::available(Machine::TABLE, AVAILABILITY.hardware.name),
    Declared::available(Series::TABLE, AVAILABILITY.releases.name),
];
