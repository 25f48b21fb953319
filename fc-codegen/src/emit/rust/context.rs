//! The model with what every file of the crate asks of it: types by name, modules, links.

use super::names::{free, ident, method};
use fc_spec::model::{Kind, Location, Model, Operation, Type, TypeDef};
use std::collections::{BTreeMap, HashMap};

/// The model, indexed once.
pub struct Context<'m> {
    pub model: &'m Model,
    types: HashMap<&'m str, &'m TypeDef>,
    operations: HashMap<&'m str, &'m Operation>,
    shared: String,
    /// Where the docs are, from the project's root, if it has them.
    docs: Option<&'m str>,
}

impl<'m> Context<'m> {
    pub fn new(model: &'m Model, docs: Option<&'m str>) -> Self {
        Self {
            model,
            types: model
                .types
                .iter()
                .map(|ty| (ty.name.as_str(), ty))
                .collect(),
            operations: model
                .operations
                .iter()
                .map(|operation| (operation.name.as_str(), operation))
                .collect(),
            shared: free(&["types", "shared", "shared_types"], |name| {
                model.group(name).is_some()
            }),
            docs,
        }
    }

    pub fn type_named(&self, name: &str) -> Option<&'m TypeDef> {
        self.types.get(name).copied()
    }

    pub fn operation(&self, name: &str) -> Option<&'m Operation> {
        self.operations.get(name).copied()
    }

    /// Name of the module, and of the file, that holds the types of a group; of those without one.
    pub fn module_of<'a>(&'a self, group: Option<&'a str>) -> &'a str {
        group.unwrap_or(&self.shared)
    }

    /// Name of an operation's method in the stubs, whose own methods keep theirs.
    #[allow(
        clippy::unused_self,
        reason = "asked like everything else about the model"
    )]
    pub fn method(&self, operation: &Operation) -> String {
        method(&operation.name, OWN_METHODS)
    }

    /// The end of a comment: where the spec and the documentation tell of it.
    pub fn links(&self, location: &Location, page: &str) -> String {
        let spec = format!("Spec: `{}` in `{}`", location.name, location.file);
        match self.docs {
            Some(docs) => format!("- {spec}\n- Docs: `{docs}/{page}`"),
            None => format!("{spec}."),
        }
    }

    /// Where the documentation tells of it, if there is one.
    pub fn page(&self, page: &str) -> Option<String> {
        self.docs.map(|docs| format!("Docs: `{docs}/{page}`."))
    }

    /// A name of the runtime beside types of the spec; by its full path where one of them has it.
    pub fn runtime(&self, name: &str) -> String {
        if self.type_named(name).is_some() {
            format!("fc_runtime::{name}")
        } else {
            name.to_owned()
        }
    }

    /// Operations of a kind that have a code, by group: were they in the order of their codes, any two
    /// new ones would stand side by side, and two branches could not be merged.
    pub fn coded(&self, kind: Kind) -> Vec<(u16, &'m Operation)> {
        self.model
            .operations
            .iter()
            .filter(|operation| operation.kind == kind)
            .filter_map(|operation| operation.code.value.map(|code| (code, operation)))
            .collect()
    }

    /// Types that `home` does not hold, by the module that does.
    pub fn imports<'a>(
        &self,
        home: Option<&str>,
        names: impl IntoIterator<Item = &'a str>,
    ) -> BTreeMap<String, Vec<&'a str>> {
        let mut imports: BTreeMap<String, Vec<&'a str>> = BTreeMap::new();
        for name in names {
            let Some(ty) = self.type_named(name) else {
                continue;
            };
            if ty.group.as_deref() != home {
                let module = ident(self.module_of(ty.group.as_deref()));
                imports.entry(module).or_default().push(name);
            }
        }
        imports
    }
}

/// Methods that the stubs have anyway: their own, and those of `Clone`, `From` and `Into`, which all
/// programs reach without an import.
const OWN_METHODS: &[&str] = &[
    "clone",
    "clone_from",
    "clone_into",
    "closed",
    "connect",
    "connect_lazy",
    "connection",
    "data",
    "from",
    "into",
    "new",
    "reports",
    "state",
    "states",
    "to_owned",
    "try_from",
    "try_into",
    "unknown",
];

/// Where the stubs find a type of the spec, whatever it is called.
pub fn message(name: &str) -> String {
    format!("messages::{name}")
}

/// The Rust type of a field without its optional mark.
pub fn rust_type(ty: &Type) -> String {
    match ty {
        Type::Bool | Type::Int(_) | Type::Float(_) => ty.to_string(),
        Type::String => "String".to_owned(),
        Type::TimestampMs | Type::TimestampS => "i64".to_owned(),
        Type::Base64 => "Bytes64".to_owned(),
        Type::Json => "Json".to_owned(),
        Type::Array(item) => format!("Vec<{}>", rust_type(item)),
        Type::Named(name) => name.clone(),
    }
}

/// Path of an operation's page below the documentation's root.
pub fn page_of(operation: &Operation) -> String {
    let folder = match operation.kind {
        Kind::Command => "commands",
        Kind::Report => "reports",
        Kind::Stream => "streams",
    };
    format!("reference/{folder}/{}.md", operation.name)
}
