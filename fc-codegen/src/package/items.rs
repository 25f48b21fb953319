//! A protocol as a package of one language, with every name spelled in advance.
//!
//! The model holds the facts about fields, operations and tables, independent of any language. This module adds their
//! names and their modules. An emitter lays them out and spells no name.

use super::language::{Language, Role};
use super::name::{Clash, Named, Scope, free};
use fc_spec::model::{
    DeclaredError, Direction, Effect, Entity, EnumType, EnumValue, EnvelopeField, Field, Group,
    HeaderField, Kind, Messages, Model, OneOf, Operation, ResultCode, StructType, Table, Type,
    TypeDef, TypeRef, TypeShape, Variant,
};
use rayon::iter::{IntoParallelRefIterator as _, ParallelIterator as _};
use std::borrow::Cow;
use std::collections::{HashMap, HashSet};
use std::ops::Deref;

/// A protocol as a package of one language.
#[derive(Clone, Debug)]
pub struct Package<'m> {
    /// The protocol.
    pub model: &'m Model,
    /// The type of the protocol.
    pub name: Cow<'m, str>,
    /// The modules of message types, sorted by id: one for each group with types, and one for shared types.
    pub modules: Vec<Module<'m>>,
    /// The module and the index of each type, by the type's id.
    item_indices: Vec<ItemIndex>,
    /// The frame's header.
    pub header: Vec<Spelled<'m, HeaderField>>,
    /// The keys that every request carries.
    pub request_envelope: Vec<Spelled<'m, EnvelopeField>>,
    /// The keys that every response carries.
    pub response_envelope: Vec<Spelled<'m, EnvelopeField>>,
    /// The result codes, as the values of an enum.
    pub results: Vec<Spelled<'m, ResultCode>>,
    /// The tables of constants, as functions.
    pub tables: Vec<Spelled<'m, Table>>,
    /// The streams that have a code, as the values of an enum.
    pub streams: Vec<Spelled<'m, Operation>>,
    /// The enums of the errors that commands declare, by the commands' names in the spec.
    errors: HashMap<&'m str, Cow<'m, str>>,
    /// The method names of commands and reports, by their names in the spec.
    methods: HashMap<&'m str, Cow<'m, str>>,
    /// The id types of entities; empty if the language has no id types.
    pub ids: Vec<Spelled<'m, Entity>>,
    /// The groups as modules.
    pub(super) group_names: Vec<Spelled<'m, Group>>,
    types: HashSet<Cow<'m, str>>,
    /// Names that the language cannot use. A package with clashes must not be written.
    pub clashes: Vec<Clash<'m>>,
}

/// An element of the spec, with its name in the language.
#[derive(Clone, Debug)]
pub struct Spelled<'m, T> {
    /// The name in the source.
    pub name: Cow<'m, str>,
    /// The element.
    pub of: &'m T,
}

impl<T> Deref for Spelled<'_, T> {
    type Target = T;

    fn deref(&self) -> &T {
        self.of
    }
}

/// A module of message types.
#[derive(Clone, Debug)]
pub struct Module<'m> {
    /// The name of the file.
    pub id: String,
    /// The name in a path.
    pub name: Cow<'m, str>,
    /// The group of the types; `None` for types that several groups share.
    pub group: Option<&'m Group>,
    /// The types, in the order of the spec.
    pub items: Vec<Item<'m>>,
}

/// A message type, or a part of one.
#[derive(Clone, Debug)]
pub struct Item<'m> {
    /// The type, with its name.
    pub ty: Spelled<'m, TypeDef>,
    /// The structure of the type.
    pub shape: Shape<'m>,
    /// The operation whose bodies use the type, if there is only one.
    pub operation: Option<&'m Operation>,
}

/// The structure of a type.
#[derive(Clone, Debug)]
pub enum Shape<'m> {
    /// A struct and its fields.
    Record(&'m StructType, Vec<Spelled<'m, Field>>),
    /// An enum and its values.
    Enum(&'m EnumType, Vec<Spelled<'m, EnumValue>>),
    /// A one-of and its variants.
    Choice(&'m OneOf, Vec<Spelled<'m, Variant>>),
}

impl<'m> Item<'m> {
    /// Returns `true` for a struct with several required fields.
    ///
    /// Positional arguments could be passed in the wrong order, so these fields get a named type.
    #[must_use]
    pub fn has_field_type(&self) -> bool {
        let required = self.fields().iter().filter(|field| !field.optional);
        required.count() > 1
    }

    /// Returns the fields of a struct; empty for other types.
    #[must_use]
    pub fn fields(&self) -> &[Spelled<'m, Field>] {
        match &self.shape {
            Shape::Record(_, fields) => fields,
            Shape::Enum(..) | Shape::Choice(..) => &[],
        }
    }

    /// Returns the operation and the side if the type is a whole body.
    #[must_use]
    pub fn body_of(&self) -> Option<(&'m Operation, Direction)> {
        let place = self.ty.of.body_of.as_ref();
        let place = place.filter(|place| place.path.is_empty())?;
        Some((self.operation?, place.side))
    }
}

/// A command or a report that has a code.
#[derive(Clone, Copy, Debug)]
pub struct Call<'p> {
    /// The name of the method in the stubs.
    pub method: &'p str,
    /// The operation.
    pub operation: &'p Operation,
    /// The type of the request, or of the report.
    pub request: &'p Item<'p>,
    /// The type of the response, or of the acknowledgement.
    pub response: &'p Item<'p>,
}

impl Call<'_> {
    /// Returns `true` unless the spec states that the command moves nothing.
    #[must_use]
    pub fn may_move(&self) -> bool {
        let effect = self.operation.effect();
        !matches!(effect, Some(Effect::Read | Effect::Config))
    }
}

/// Candidate ids of the module of shared types. The first that is not the id of a group is used.
const SHARED: [&str; 3] = ["types", "shared", "shared_types"];

impl<'m> Package<'m> {
    /// Spells every name of a protocol in this language.
    #[must_use]
    pub fn build(model: &'m Model, language: &Language) -> Self {
        let mut names = Names::new(language);
        let mut types = Scope::new(language, Role::Type);
        let protocol = Named::alone("protocol", "protocol");
        let name = types.claim(&model.protocol.id, protocol, &mut names.clashes);
        let operations = model.operations.iter().map(|it| (it.name.as_str(), it));
        let operations: HashMap<&str, &Operation> = operations.collect();
        let shapes = model.types.par_iter().map(|ty| {
            let mut names = Names::new(language);
            (names.shape(ty), names.clashes)
        });
        let shapes: Vec<_> = shapes.collect();
        let items = model.types.iter().zip(shapes);
        let items = items.map(|(ty, (shape, clashes))| {
            let place = ty.body_of.as_ref();
            let operation = place.and_then(|place| operations.get(place.operation.as_str()));
            let who = Named::alone(kind(ty), &ty.name);
            let name = types.claim(&ty.name, who, &mut names.clashes);
            names.clashes.extend(clashes);
            Item {
                ty: Spelled { name, of: ty },
                shape,
                operation: operation.copied(),
            }
        });
        let items: Vec<_> = items.collect();
        let has_field_type = |item: &&Item<'_>| language.has_field_types && item.has_field_type();
        for item in items.iter().filter(has_field_type) {
            let words = format!("{}_fields", item.ty.of.name);
            let who = Named::alone(kind(item.ty.of), &item.ty.of.name);
            types.claim_made(&words, who, &mut names.clashes);
        }
        let errors = declaring(model).map(|command| {
            let words = format!("{}_error", command.name);
            let who = Named::alone(command.kind().name(), &command.name);
            let name = types.claim_made(&words, who, &mut names.clashes);
            (command.name.as_str(), name)
        });
        let errors = errors.collect();
        let entities = model.entities.iter().filter(|_| language.has_id_types);
        let ids = entities.map(|of| {
            let words = format!("{}_id", of.name);
            let who = Named::alone("entity", &of.name);
            let name = types.claim_made(&words, who, &mut names.clashes);
            Spelled { name, of }
        });
        let ids = ids.collect();
        for group in &model.groups {
            for part in language.group_types {
                let words = format!("{}_{part}", group.id);
                let who = Named::alone("group", &group.id);
                types.claim_made(&words, who, &mut names.clashes);
            }
        }
        let is_stream = |operation: &&Operation| operation.kind() == Kind::Stream;
        let (streams, calls): (Vec<_>, Vec<_>) = model.operations.iter().partition(is_stream);
        let methods = names.all(Role::Method, calls, |it| {
            (&it.name, Named::alone(it.kind().name(), &it.name))
        });
        let methods = methods.into_iter().map(|it| (&*it.of.name, it.name));
        let methods = methods.collect();
        let groups = names.all(Role::Module, &model.groups, |it| {
            (&it.id, Named::alone("group", &it.id))
        });
        let (modules, item_indices) = modules(language, &groups, items);
        let streams = streams.into_iter().filter(|it| it.code.value.is_some());
        let envelope = |names: &mut Names<'_, 'm>, direction: Direction, keys: &'m [_]| {
            names.all(Role::Field, keys, |it: &EnvelopeField| {
                let who = Named::part("envelope field", direction.name(), &it.wire);
                (&it.name, who)
            })
        };
        Self {
            model,
            name,
            modules,
            item_indices,
            errors,
            methods,
            ids,
            group_names: groups,
            tables: names.all(Role::Function, &model.tables, |it| {
                (&it.id, Named::alone("table", &it.id))
            }),
            results: names.all(Role::Value, &model.results, |it| {
                (&it.name, Named::alone("result code", &it.name))
            }),
            header: names.all(Role::Field, &model.frame.header, |it| {
                (&it.name, Named::alone("header field", &it.wire))
            }),
            request_envelope: envelope(&mut names, Direction::Request, &model.envelope.request),
            response_envelope: envelope(&mut names, Direction::Response, &model.envelope.response),
            streams: names.all(Role::Value, streams, |it| {
                (&it.name, Named::alone("stream", &it.name))
            }),
            types: types.into_names(),
            clashes: names.clashes,
        }
    }

    /// Returns `true` if a message type or the protocol has this name.
    #[must_use]
    pub fn has_type(&self, name: &str) -> bool {
        self.types.contains(name)
    }

    /// Returns `true` if a command or report of the spec has this name.
    #[must_use]
    pub fn has_call(&self, name: &str) -> bool {
        self.methods.contains_key(name)
    }

    /// Returns the enum of the errors that a command declares; `None` if it declares none.
    #[must_use]
    pub fn error_type(&self, command: &Operation) -> Option<&str> {
        self.errors.get(command.name.as_str()).map(|name| &**name)
    }

    /// Returns the id type that a field holds, if its entity has one.
    ///
    /// A string with a default keeps its type, because no constant can hold an id made from it.
    #[must_use]
    pub fn id_of(&self, field: &Field) -> Option<&Spelled<'m, Entity>> {
        let details = field.details();
        let entity = details.refers.as_deref()?;
        if details.default.is_some() && *field.ty.item() == Type::String {
            return None;
        }
        self.ids.iter().find(|id| id.of.name == entity)
    }

    /// Returns the declared errors of an operation, each with its result code.
    pub fn errors<'p>(
        &'p self,
        operation: &'p Operation,
    ) -> impl Iterator<Item = (&'p DeclaredError, &'p Spelled<'m, ResultCode>)> {
        let errors = operation.errors.iter();
        errors.filter_map(|error| {
            let mut results = self.results.iter();
            Some((error, results.find(|result| result.code == error.code)?))
        })
    }

    /// Returns the type that a reference names.
    #[must_use]
    #[expect(
        clippy::indexing_slicing,
        reason = "the ids are those of the model, and each type has been given an index"
    )]
    pub fn item(&self, reference: &TypeRef) -> &Item<'m> {
        let (module, item) = self.item_indices[reference.id().index()];
        &self.modules[module].items[item]
    }

    /// Returns the module of the type that a reference names.
    #[must_use]
    #[expect(clippy::indexing_slicing, reason = "as above")]
    pub fn module_of(&self, reference: &TypeRef) -> &Module<'m> {
        &self.modules[self.item_indices[reference.id().index()].0]
    }

    /// Returns all message types, in the order of the spec.
    pub fn items(&self) -> impl Iterator<Item = &Item<'m>> {
        let module = |index: &ItemIndex| self.modules.get(index.0);
        let items = self.item_indices.iter();
        items.filter_map(move |index| module(index)?.items.get(index.1))
    }

    /// Returns the method of a command or report; `None` for a stream, and for an operation without a code.
    #[must_use]
    pub fn call<'p>(&'p self, operation: &'p Operation) -> Option<Call<'p>> {
        operation.code.value?;
        let Messages { request, response } = operation.messages()?;
        Some(Call {
            method: self.methods.get(operation.name.as_str())?,
            operation,
            request: self.item(&request.ty),
            response: self.item(&response.ty),
        })
    }

    /// Returns the command or report whose request is this type; `None` without a code.
    #[must_use]
    pub fn opened_by<'p>(&'p self, item: &'p Item<'_>) -> Option<Call<'p>> {
        let (operation, side) = item.body_of()?;
        let is_request = side == Direction::Request;
        self.call(operation).filter(|_| is_request)
    }

    /// Returns the command whose request is this type, with the enum of its declared errors.
    #[must_use]
    pub fn declared_by<'i>(&self, item: &Item<'i>) -> Option<(&'i Operation, &str)> {
        let (command, side) = item.body_of()?;
        let errors = self.error_type(command)?;
        (side == Direction::Request).then_some((command, errors))
    }

    /// Returns a stream with its name; `None` without a code.
    #[must_use]
    pub fn stream(&self, operation: &Operation) -> Option<&Spelled<'m, Operation>> {
        let mut streams = self.streams.iter();
        streams.find(|known| known.of.name == operation.name)
    }

    /// Returns the commands or the reports that have a code, by group.
    ///
    /// The order is not that of the codes: two new operations would become neighbours, and their branches would
    /// conflict.
    #[must_use]
    pub fn calls(&self, kind: Kind) -> Vec<Call<'_>> {
        let operations = self.model.operations.iter();
        let operations = operations.filter(|operation| operation.kind() == kind);
        operations.filter_map(|it| self.call(it)).collect()
    }
}

/// Returns the commands that declare errors.
fn declaring(model: &Model) -> impl Iterator<Item = &Operation> {
    let operations = model.operations.iter();
    operations.filter(|it| it.kind() == Kind::Command && !it.errors.is_empty())
}

/// Returns every name of a protocol that one of these languages cannot use.
#[must_use]
pub fn clashes<'m>(model: &'m Model, languages: &[&Language]) -> Vec<Clash<'m>> {
    let languages = languages.iter();
    let packages = languages.map(|language| Package::build(model, language));
    packages.flat_map(|package| package.clashes).collect()
}

/// Returns the keyword of a type in the spec language.
fn kind(ty: &TypeDef) -> &'static str {
    match ty.shape {
        TypeShape::Struct(_) => "struct",
        TypeShape::Enum(_) => "enum",
        TypeShape::OneOf(_) => "choice",
    }
}

/// The index of a module, and the index of a type in it.
type ItemIndex = (usize, usize);

/// Puts each type into the module of its group. A group without types has no module.
fn modules<'m>(
    language: &Language,
    groups: &[Spelled<'m, Group>],
    items: Vec<Item<'m>>,
) -> (Vec<Module<'m>>, Vec<ItemIndex>) {
    let homes: HashSet<_> = items.iter().map(|it| it.ty.of.group.as_deref()).collect();
    let shared = free(&SHARED, |id| groups.iter().any(|group| group.of.id == id));
    let name = language.spelled(Role::Module, &shared);
    let shared = Module {
        name: Cow::Owned(name.into_owned()),
        id: shared,
        group: None,
        items: Vec::new(),
    };
    let groups = groups.iter().map(|Spelled { name, of }| Module {
        id: of.id.clone(),
        name: name.clone(),
        group: Some(of),
        items: Vec::new(),
    });
    let home = |module: &Module<'m>| module.group.map(|group| group.id.as_str());
    let modules = groups.chain([shared]);
    let mut modules: Vec<_> = modules.filter(|it| homes.contains(&home(it))).collect();
    modules.sort_by(|one, other| one.id.cmp(&other.id));
    let indices = modules.iter().map(home).zip(0..);
    let indices: HashMap<Option<&str>, usize> = indices.collect();
    let item_indices = items.into_iter().map(|item| {
        let index = indices.get(&item.ty.of.group.as_deref());
        let index = index.copied().unwrap_or_default();
        let module = modules.get_mut(index)?;
        module.items.push(item);
        Some((index, module.items.len() - 1))
    });
    let item_indices = item_indices.flatten().collect();
    (modules, item_indices)
}

/// Spells names and collects clashes.
struct Names<'l, 'm> {
    language: &'l Language,
    clashes: Vec<Clash<'m>>,
}

impl<'l, 'm> Names<'l, 'm> {
    fn new(language: &'l Language) -> Self {
        Self {
            language,
            clashes: Vec::new(),
        }
    }

    /// Spells names that share a scope.
    fn all<T>(
        &mut self,
        role: Role,
        things: impl IntoIterator<Item = &'m T>,
        named: impl Fn(&'m T) -> (&'m str, Named<'m>),
    ) -> Vec<Spelled<'m, T>> {
        let mut scope = Scope::new(self.language, role);
        let things = things.into_iter().map(|of| {
            let (words, who) = named(of);
            let name = scope.claim(words, who, &mut self.clashes);
            Spelled { name, of }
        });
        things.collect()
    }

    /// Spells the parts of a type.
    fn shape(&mut self, ty: &'m TypeDef) -> Shape<'m> {
        let owner = ty.name.as_str();
        match &ty.shape {
            TypeShape::Struct(shape) => Shape::Record(
                shape,
                self.all(Role::Field, &shape.fields, |it| {
                    (&it.name, Named::part("field", owner, &it.wire))
                }),
            ),
            TypeShape::Enum(shape) => Shape::Enum(
                shape,
                self.all(Role::Value, &shape.values, |it| {
                    (&it.name, Named::part("enum value", owner, &it.name))
                }),
            ),
            TypeShape::OneOf(choice) => Shape::Choice(
                choice,
                self.all(Role::Value, &choice.variants, |it| {
                    (&it.name, Named::part("variant", owner, &it.name))
                }),
            ),
        }
    }
}
