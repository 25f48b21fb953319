//! The certificate as a page for people, in both languages.

use super::Certificate;
use super::json::Written;
use minijinja::value::{Serde, Value};
use minijinja::{Environment, context};

/// Returns the certificate as HTML. The page needs no other file.
///
/// # Errors
/// The template does not fit, which a test excludes.
pub fn page(certificate: &Certificate) -> Result<String, minijinja::Error> {
    let [passed, failed, skipped] = certificate.counts();
    let mut environment = Environment::new();
    environment.add_template("certificate.html", include_str!("certificate.html"))?;
    environment
        .get_template("certificate.html")?
        .render(context! {
            certificate => Value::from(Serde(Written::new(certificate))),
            passed,
            failed,
            skipped,
        })
}
