//! Declarations by name, path or code, for people.

use super::{DefId, DefSite, definitions};
use crate::diagnostic::Faults;
use crate::load::load;
use crate::model::Text;
use crate::source::{LineCol, Sources};
use crate::{text, text_error};

/// A declaration and its place.
#[derive(Clone, Debug)]
pub struct Located {
    /// The declared thing.
    pub item: DefId,
    /// The path of the file.
    pub path: String,
    /// The start of its key.
    pub start: LineCol,
    /// The comments about it, with their `#`.
    pub comments: Vec<String>,
}

impl Located {
    fn new(sources: &Sources, item: &DefId, place: &DefSite) -> Self {
        let comments = place.comments.iter();
        Self {
            item: item.clone(),
            path: sources.path(place.key).to_owned(),
            start: sources.line_col(place.key),
            comments: comments
                .map(|comment| sources.slice(*comment).to_owned())
                .collect(),
        }
    }

    /// Returns the place and the thing on one line, and each comment on another. Each line ends with a newline.
    #[must_use]
    pub fn text(&self) -> Text {
        let (path, item) = (&self.path, self.item.text());
        let LineCol { line, column } = self.start;
        let comments = self.comments.iter().flat_map(|it| ["    ", it, "\n"]);
        let comments: String = comments.collect();
        text!(
            "{path}:{line}:{column}: {item}\n{comments}",
            "{path}:{line}:{column}: {item}\n{comments}",
            item = item
        )
    }
}

/// The error for a name or code that no declaration has.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NotDeclared {
    /// The name.
    pub name: String,
    /// The most similar name.
    pub nearest: Option<String>,
    /// `true` if the spec has errors. They can hide declarations.
    pub has_errors: bool,
}

impl NotDeclared {
    /// Returns the message for the user.
    #[must_use]
    pub fn text(&self) -> Text {
        let cause = match &self.nearest {
            Some(near) => text!("；是否想写 `{near}`？", "; did you mean `{near}`?"),
            None if self.has_errors => text!(
                "；规范有错误，`fcproto check` 会列出",
                "; the spec has errors, which `fcproto check` shows"
            ),
            None => Text::default(),
        };
        text!(
            "规范中没有 `{name}`{cause}",
            "there is no `{name}` in the spec{cause}",
            name = self.name,
            cause = cause
        )
    }
}

text_error!(NotDeclared);

/// Returns the declarations with a name, a path such as `Station.name`, or a code in the spelling of the spec.
///
/// The spec may have errors. `faults` has those found in reading, and gets those found in loading.
///
/// # Errors
///
/// [`NotDeclared`] if there is none.
pub fn locate(
    sources: &Sources,
    faults: &mut Faults,
    name: &str,
) -> Result<Vec<Located>, NotDeclared> {
    let loaded = load(sources, faults);
    let operations = loaded.partial.operations.iter();
    let coded = operations.filter(|it| it.code.value.is_some() && it.code.spelling == name);
    let mut names: Vec<&str> = coded.map(|operation| operation.name.as_str()).collect();
    if names.is_empty() {
        names.push(name);
    }
    let places = definitions(sources);
    let found = names.iter().flat_map(|name| places.named(name));
    let found: Vec<_> = found
        .map(|(item, place)| Located::new(sources, item, place))
        .collect();
    if found.is_empty() {
        return Err(NotDeclared {
            name: name.to_owned(),
            nearest: places.nearest(name).map(str::to_owned),
            has_errors: faults.has_errors(),
        });
    }
    Ok(found)
}
