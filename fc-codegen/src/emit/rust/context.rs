//! The model with what every file of the crate asks of it: types by name, modules, links.

use super::names::{free, ident, method};
use fc_spec::model::{
    Exchange, Kind, Location, Messages, Model, Operation, StructRef, Type, TypeRef,
};
use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};

/// The model, indexed once.
pub struct Context<'m> {
    pub model: &'m Model,
    types: HashSet<&'m str>,
    operations: HashMap<&'m str, &'m Operation>,
    shared: String,
    /// Where the docs are, from the project's root, if it has them.
    docs: Option<&'m str>,
}

impl<'m> Context<'m> {
    pub fn new(model: &'m Model, docs: Option<&'m str>) -> Self {
        Self {
            model,
            types: model.types.iter().map(|ty| ty.name.as_str()).collect(),
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

    /// Whether a type of the spec is called that.
    pub fn has_type(&self, name: &str) -> bool {
        self.types.contains(name)
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
        method(&operation.name)
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
        if self.has_type(name) {
            format!("fc_runtime::{name}")
        } else {
            name.to_owned()
        }
    }

    /// Operations that have a code, by group: were they in the order of their codes, any two new ones
    /// would stand side by side, and two branches could not be merged.
    fn coded(&self) -> impl Iterator<Item = &'m Operation> {
        let operations = self.model.operations.iter();
        operations.filter(|operation| operation.code.value.is_some())
    }

    /// Commands that have a code.
    pub fn commands(&self) -> Vec<Coded<'m>> {
        let messages = |operation: &'m Operation| match &operation.exchange {
            Exchange::Command { messages, .. } => Some(Coded::of(operation, messages)),
            Exchange::Report { .. } | Exchange::Stream => None,
        };
        self.coded().filter_map(messages).collect()
    }

    /// Reports that have a code.
    pub fn reports(&self) -> Vec<Coded<'m>> {
        let messages = |operation: &'m Operation| match &operation.exchange {
            Exchange::Report { messages, .. } => Some(Coded::of(operation, messages)),
            Exchange::Command { .. } | Exchange::Stream => None,
        };
        self.coded().filter_map(messages).collect()
    }

    /// Streams that have a code.
    pub fn streams(&self) -> Vec<&'m Operation> {
        let is_stream = |operation: &&Operation| matches!(operation.exchange, Exchange::Stream);
        self.coded().filter(is_stream).collect()
    }

    /// Types that `home` does not hold, by the module that does.
    pub fn imports<'a>(
        &self,
        home: Option<&str>,
        types: impl IntoIterator<Item = &'a TypeRef>,
    ) -> BTreeMap<String, BTreeSet<&'a str>> {
        let mut imports: BTreeMap<String, BTreeSet<&'a str>> = BTreeMap::new();
        for named in types {
            let group = self.model.types.get(named).group.as_deref();
            if group != home {
                let module = ident(self.module_of(group));
                imports.entry(module).or_default().insert(named.name());
            }
        }
        imports
    }
}

/// A command or report that has a code.
#[derive(Clone, Copy)]
pub struct Coded<'m> {
    pub operation: &'m Operation,
    /// What is asked or reported.
    pub request: &'m StructRef,
    /// The answer or acknowledgement.
    pub response: &'m StructRef,
}

impl<'m> Coded<'m> {
    fn of(operation: &'m Operation, messages: &'m Messages) -> Self {
        Self {
            operation,
            request: &messages.request.ty,
            response: &messages.response.ty,
        }
    }
}

/// Where the stubs find a type of the spec, whatever it is called.
pub fn message(ty: &TypeRef) -> String {
    format!("messages::{ty}")
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
        Type::Named(named) => named.to_string(),
    }
}

/// Path of an operation's page below the documentation's root.
pub fn page_of(operation: &Operation) -> String {
    let folder = match operation.kind() {
        Kind::Command => "commands",
        Kind::Report => "reports",
        Kind::Stream => "streams",
    };
    format!("reference/{folder}/{}.md", operation.name)
}
