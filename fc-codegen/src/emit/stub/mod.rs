//! What the packages of all languages have in common: a file under construction, what its comments say, and where the
//! pages are to which they point. How a language writes any of it is its [`Style`](style::Style).

pub mod about;
pub mod conditions;
pub mod context;
pub mod digits;
pub mod docs;
pub mod facts;
pub mod marks;
pub mod process;
pub mod ranges;
pub mod samples;
pub mod source;
pub mod style;
