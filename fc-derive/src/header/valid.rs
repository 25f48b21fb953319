//! Requirements of a header.

use super::ast::{Field, Header, ROLES, Role, Shape};
use crate::errors::Errors;

/// The fields with a role.
pub struct Roles<'h> {
    pub head: &'h Field<'h>,
    pub kind: &'h Field<'h>,
    pub code: &'h Field<'h>,
    pub id: &'h Field<'h>,
    pub encoding: Option<&'h Field<'h>>,
    pub total_length: &'h Field<'h>,
    pub plain_length: Option<&'h Field<'h>>,
    pub digest: Option<&'h Field<'h>>,
}

/// Reports all conflicts between fields. Returns the roles if none is missing.
pub fn check<'h>(header: &'h Header<'h>, errors: &mut Errors) -> Option<Roles<'h>> {
    for field in &header.fields {
        check_field(field, errors);
    }
    let mut roles = [None; ROLES.len()];
    for ((name, role), slot) in ROLES.iter().zip(&mut roles) {
        let mut holders = header
            .fields
            .iter()
            .filter(|field| field.role.get().is_some_and(|(_, given)| given == role));
        *slot = holders.next();
        for again in holders {
            if let Some((literal, _)) = again.role.get() {
                errors.on(literal, format!("another field has the role `{name}`"));
            }
        }
        if slot.is_none() && is_needed(*role) && has_sound_roles(header) {
            errors.on(header.ident, format!("no field has the role `{name}`"));
        }
    }
    check_head_is_first(header, errors);
    let [
        head,
        kind,
        code,
        id,
        encoding,
        total_length,
        plain_length,
        digest,
        _,
    ] = roles;
    Some(Roles {
        head: head?,
        kind: kind?,
        code: code?,
        id: id?,
        encoding,
        total_length: total_length?,
        plain_length,
        digest,
    })
}

/// Returns `true` if every frame needs this role.
fn is_needed(role: Role) -> bool {
    match role {
        Role::Head | Role::Kind | Role::Code | Role::Id | Role::TotalLength => true,
        Role::Encoding | Role::PlainLength | Role::Digest | Role::Status => false,
    }
}

/// Returns `true` if all roles are valid. An invalid one may be the role that seems to be missing.
fn has_sound_roles(header: &Header<'_>) -> bool {
    header
        .fields
        .iter()
        .all(|field| field.role.key().is_none() || field.role.get().is_some())
}

fn check_field(field: &Field<'_>, errors: &mut Errors) {
    let role = field.role.get().map(|(_, role)| *role);
    match (role, field.value.key()) {
        (Some(Role::Status) | None, None) if field.role.key().is_none() || role.is_some() => {
            errors.on(
                field.ident,
                "the field needs `#[fc(role = …)]` or `#[fc(value = …)]`, what it is sent as",
            );
        }
        (Some(role), Some(value)) if role != Role::Status => {
            errors.at(
                value,
                "a field with a role is filled by the runtime; it has no `value`",
            );
        }
        _ => {}
    }
    if let Some(algorithm) = field.algorithm.key()
        && role != Some(Role::Digest)
    {
        errors.at(algorithm, "only the digest has an `algorithm`");
    }
    let Some(shape) = field.shape else { return };
    if let Some((wanted, fits)) = role.map(|role| wanted(field, role, shape))
        && !fits
    {
        errors.on(field.ty, format!("a field with this role is `{wanted}`"));
    }
    if let Some(value) = field.value.get() {
        let number: u64 = value.base10_parse().unwrap_or_default();
        match shape {
            Shape::Int(size) if size < 8 && number >> (8 * size) != 0 => {
                errors.on(value, format!("the value must fit `u{}`", 8 * size));
            }
            Shape::Bytes(_) if number != 0 => {
                errors.on(value, "a run of bytes can only be sent as `value = 0`");
            }
            _ => {}
        }
    }
}

/// Returns the required type of a role, and `true` if the field has it.
fn wanted(field: &Field<'_>, role: Role, shape: Shape) -> (&'static str, bool) {
    match role {
        Role::Head => ("[u8; N]", matches!(shape, Shape::Bytes(_))),
        Role::Kind | Role::Encoding => ("u8", shape == Shape::Int(1)),
        Role::Code => ("u16", shape == Shape::Int(2)),
        Role::Id => (
            "u16 or u32",
            shape == Shape::Int(2) || shape == Shape::Int(4),
        ),
        Role::TotalLength | Role::PlainLength => ("u32", shape == Shape::Int(4)),
        Role::Digest => {
            let (_, spelling, wanted) = field.algorithm().facts();
            (spelling, shape == wanted)
        }
        Role::Status => ("u8, u16, u32 or u64", matches!(shape, Shape::Int(_))),
    }
}

/// Reports a head that is not the first field.
fn check_head_is_first(header: &Header<'_>, errors: &mut Errors) {
    for field in header.fields.iter().skip(1) {
        if let Some((literal, Role::Head)) = field.role.get() {
            errors.on(
                literal,
                "the head opens a frame: its field must be the first",
            );
        }
    }
}
