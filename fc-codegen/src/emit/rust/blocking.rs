//! `blocking.rs`: the app's stub without `async`, for tools and tests.

use super::context::Context;

/// Generates `blocking.rs`.
pub fn blocking_file(context: &Context<'_>) -> String {
    let protocol = &context.package.name;
    let mut out = context.source();
    out.template("blocking", &[("protocol", protocol)]);
    out.finish()
}
