//! The steps that all derives have in common.

use crate::attr::{self, ItemReader, Slot};
use crate::errors::Errors;
use proc_macro2::TokenStream;
use quote::ToTokens;
use syn::punctuated::Punctuated;
use syn::{Data, DeriveInput, Fields, Generics, Ident, Path, Token, Type, Variant};

/// The expansion of an item, with its errors.
pub type Expand = fn(&DeriveInput, Errors) -> TokenStream;

/// Parses the item and expands it.
pub fn derive(input: TokenStream, expand: Expand) -> TokenStream {
    match syn::parse2(input) {
        Ok(input) => expand(&input, Errors::default()),
        Err(error) => error.into_compile_error(),
    }
}

/// Reads the attributes of an item and returns the path of the runtime. Keys other than `crate` are read by `item`.
pub fn read_attributes(
    input: &DeriveInput,
    errors: &mut Errors,
    place: &str,
    item: &mut ItemReader<'_>,
) -> Path {
    let mut runtime = Slot::default();
    attr::read(&input.attrs, errors, place, &mut |key, input| {
        if key == "crate" {
            runtime.set(key, attr::path(input))
        } else {
            item(key, input)
        }
    });
    attr::runtime(runtime)
}

/// Reports an item with generic parameters.
pub fn forbid_parameters(generics: &Generics, errors: &mut Errors, item: &str) {
    if !generics.params.is_empty() {
        errors.on(&generics.params, format!("{item} has no parameters"));
    }
}

/// Returns the fields of a struct. Reports any other item with `message`, and an enum with `hint` behind it.
pub fn fields<'a>(
    input: &'a DeriveInput,
    errors: &mut Errors,
    message: &str,
    hint: &str,
) -> Option<&'a Fields> {
    match &input.data {
        Data::Struct(data) => return Some(&data.fields),
        Data::Enum(data) => errors.on(&data.enum_token, format!("{message}{hint}")),
        Data::Union(data) => errors.on(&data.union_token, message),
    }
    None
}

/// Returns the variants of an enum. Reports any other item with `message`, and a struct with `hint` behind it.
pub fn variants<'a>(
    input: &'a DeriveInput,
    errors: &mut Errors,
    message: &str,
    hint: &str,
) -> Option<&'a Punctuated<Variant, Token![,]>> {
    match &input.data {
        Data::Enum(data) => return Some(&data.variants),
        Data::Struct(data) => errors.on(&data.struct_token, format!("{message}{hint}")),
        Data::Union(data) => errors.on(&data.union_token, message),
    }
    None
}

/// Returns the fields of a struct whose fields have names, or none for a unit struct. Reports any other item for the
/// derive of this name.
pub fn named_fields<'a>(
    input: &'a DeriveInput,
    errors: &mut Errors,
    derive: &str,
) -> Vec<&'a syn::Field> {
    let message = format!("`{derive}` is for structs");
    match fields(input, errors, &message, "") {
        Some(Fields::Named(fields)) => return fields.named.iter().collect(),
        Some(Fields::Unnamed(fields)) => {
            errors.on(fields, format!("{message} whose fields have names"));
        }
        Some(Fields::Unit) | None => {}
    }
    Vec::new()
}

/// Returns the type that a tuple of one field holds.
pub fn payload(fields: &Fields) -> Option<&Type> {
    let mut types = match fields {
        Fields::Unnamed(fields) => fields.unnamed.iter().map(|field| &field.ty),
        Fields::Named(_) | Fields::Unit => return None,
    };
    types.next().filter(|_| types.next().is_none())
}

/// Returns the payload of a variant. Reports a variant that does not hold exactly one value with `message`.
pub fn variant_payload<'a>(
    variant: &'a Variant,
    errors: &mut Errors,
    message: &str,
) -> Option<&'a Type> {
    let payload = payload(&variant.fields);
    if payload.is_none() {
        errors.on(place(variant), message);
    }
    payload
}

/// Returns the payload of a variant, or its name without one, as the place of an error.
pub fn place(variant: &Variant) -> &dyn ToTokens {
    match &variant.fields {
        Fields::Unit => &variant.ident,
        fields => fields,
    }
}

/// Returns the last name of a type's path.
pub fn last_name(ty: &Type) -> Option<&Ident> {
    match ty {
        Type::Path(path) => path.path.segments.last().map(|segment| &segment.ident),
        _ => None,
    }
}
