//! Tools that speak a protocol from its spec alone, without generated code.
//!
//! **Architecture invariant.** This crate contains no fact about a protocol and does not depend on generated code. All
//! facts come from the model, so a tool uses an edited spec at once.

pub mod address;
pub mod answer;
pub mod app;
pub mod arguments;
pub mod call;
pub mod capture;
pub mod certify;
pub mod client;
pub mod complete;
pub mod connection;
pub mod decode;
pub mod drift;
mod dump;
pub mod error;
pub mod facts;
pub mod fault;
pub mod listen;
pub mod mock;
pub mod paths;
pub mod permission;
pub mod proxy;
#[cfg(feature = "record")]
pub mod recording;
pub mod replay;
pub mod request;
pub mod run;
pub mod scenario;
pub mod stream;
pub mod table;
pub mod transcript;
#[cfg(feature = "view")]
pub mod view;
