//! A view for each kind of page, with the data for its template.

mod changelog;
mod codes;
mod entities;
mod errors;
mod glossary;
mod index;
mod language;
mod needs;
mod open_questions;
mod operation;
mod picture;
mod places;
mod results;
mod shared;
mod streams;
mod tables;
mod types;
mod wire;

pub(super) use changelog::changelog;
pub(super) use codes::codes;
pub(super) use entities::entities;
pub(super) use errors::errors;
pub(super) use glossary::glossary;
pub(super) use index::index;
pub(super) use language::language;
pub(super) use open_questions::open_questions;
pub(super) use operation::operation;
pub(super) use places::places;
pub(super) use results::results;
pub(super) use tables::tables;
pub(super) use types::types;
pub(super) use wire::wire;
