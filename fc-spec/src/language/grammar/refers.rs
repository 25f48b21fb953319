//! References: values that name a thing of the spec.

use super::available::{Audience, Machine, Series};
use super::common::Conflict;
use super::coordinates::{CoordinateSystem, Store};
use super::entity::Entity;
use super::field::{Enum, EnumValue, Struct};
use super::form::{ConflictId, Form, Name, ResultNumber, TypeName};
use super::kind::Kind;
use super::operation::{Command, Group, Report, Stream};
use super::wire::ResultCode;
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
