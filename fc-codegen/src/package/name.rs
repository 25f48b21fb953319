//! Checks that names in one scope have distinct spellings in a language, and reports clashes.

use super::language::{Language, Role};
use fc_spec::diagnostic::{Diagnostic, FaultCode};
use fc_spec::index::{DefId, Definitions};
use fc_spec::model::Text;
use fc_spec::source::Span;
use fc_spec::text;
use std::borrow::Cow;
use std::collections::{HashMap, HashSet};
use std::fmt;

/// An element of the spec that has a name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Named<'m> {
    /// The keyword in the spec language: `field`, `command`.
    pub kind: &'static str,
    /// The owner, if the name is unique only within it.
    pub owner: Option<&'m str>,
    /// The name in the spec.
    pub name: &'m str,
}

/// A name that a language cannot use.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Clash<'m> {
    /// The display name of the language.
    pub language: &'static str,
    /// The element with the name.
    pub who: Named<'m>,
    /// The spelling in that language.
    pub spelling: String,
    /// The reason for the clash.
    pub reason: Reason<'m>,
}

/// The reason why a language cannot use a name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reason<'m> {
    /// The language, or the package, needs the name.
    Taken,
    /// Another name already has this spelling.
    Same(Named<'m>),
    /// Another name differs only in case. Some file systems do not tell the two files apart.
    SameFile(Named<'m>),
}

/// Formats the element with its kind: `field Station.name`.
impl fmt::Display for Named<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { kind, owner, name } = self;
        match owner {
            Some(owner) => write!(f, "`{kind} {owner}.{name}`"),
            None => write!(f, "`{kind} {name}`"),
        }
    }
}

/// Formats the clash for a model without source positions.
impl fmt::Display for Clash<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            language,
            who,
            spelling,
            reason,
        } = self;
        write!(f, "{who} cannot be called `{spelling}` in {language}")?;
        match reason {
            Reason::Taken => Ok(()),
            Reason::Same(other) | Reason::SameFile(other) => write!(f, ", like {other}"),
        }
    }
}

impl<'m> Named<'m> {
    /// Names an element whose name is unique among its kind.
    pub(super) fn alone(kind: &'static str, name: &'m str) -> Self {
        Self {
            kind,
            owner: None,
            name,
        }
    }

    /// Names a part of an owner.
    pub(super) fn part(kind: &'static str, owner: &'m str, name: &'m str) -> Self {
        Self {
            kind,
            owner: Some(owner),
            name,
        }
    }

    /// Returns the position of the name in the spec.
    fn span(&self, places: &Definitions) -> Option<Span> {
        let item = DefId {
            kind: self.kind,
            owner: self.owner.map(str::to_owned),
            name: self.name.to_owned(),
        };
        places.get(&item).map(|place| place.key)
    }
}

impl Clash<'_> {
    /// Returns the clash as an error in the spec.
    ///
    /// Returns `None` for a model read from a dump, which has no positions.
    #[must_use]
    pub fn fault(&self, places: &Definitions) -> Option<Diagnostic> {
        let span = self.who.span(places)?;
        let Self {
            language, spelling, ..
        } = self;
        let same = |other: &Named<'_>, message: Text| {
            let fault = Diagnostic::error(FaultCode::DuplicateName, span, message);
            match other.span(places) {
                Some(earlier) => fault.also(earlier, text!("首次出现在这里", "first used here")),
                None => fault,
            }
        };
        let fault = match &self.reason {
            Reason::Taken => {
                let message = text!(
                    "`{spelling}` 在 {language} 中已有含义",
                    "`{spelling}` already has a meaning in {language}"
                );
                Diagnostic::error(FaultCode::ReservedName, span, message)
            }
            Reason::Same(other) => {
                let message = text!(
                    "有两个名称在 {language} 中都是 `{spelling}`",
                    "two names are both `{spelling}` in {language}"
                );
                same(other, message)
            }
            Reason::SameFile(other) => {
                let message = text!(
                    "{language} 中 `{spelling}` 的文件与另一个文件只有大小写不同",
                    "the file of `{spelling}` in {language} differs from another one only in case"
                );
                same(other, message)
            }
        };
        Some(fault.note(text!("换一个名称", "choose another name")))
    }
}

/// Names that share a scope and must differ.
pub(super) struct Scope<'l, 'm> {
    language: &'l Language,
    role: Role,
    claimed: HashMap<Cow<'m, str>, Named<'m>>,
    files: HashMap<String, Named<'m>>,
}

impl<'l, 'm> Scope<'l, 'm> {
    /// Creates an empty scope.
    pub(super) fn new(language: &'l Language, role: Role) -> Self {
        Self {
            language,
            role,
            claimed: HashMap::new(),
            files: HashMap::new(),
        }
    }

    /// Returns the spelling of a name of the spec and claims it. Underscores or capitals separate its words.
    pub(super) fn claim(
        &mut self,
        words: &'m str,
        who: Named<'m>,
        clashes: &mut Vec<Clash<'m>>,
    ) -> Cow<'m, str> {
        let spelling = self.language.spelling(self.role, words);
        self.take(spelling, who, clashes)
    }

    /// Claims the spelling of a name that is not itself in the spec.
    pub(super) fn claim_made(
        &mut self,
        words: &str,
        who: Named<'m>,
        clashes: &mut Vec<Clash<'m>>,
    ) -> Cow<'m, str> {
        let owned = |spelling: Cow<'_, str>| Cow::Owned(spelling.into_owned());
        let spelling = self.language.spelling(self.role, words);
        self.take(spelling.map(owned).map_err(owned), who, clashes)
    }

    fn take(
        &mut self,
        spelling: Result<Cow<'m, str>, Cow<'m, str>>,
        who: Named<'m>,
        clashes: &mut Vec<Clash<'m>>,
    ) -> Cow<'m, str> {
        let language = self.language;
        let (spelling, mut reason) = match spelling {
            Ok(spelling) => (spelling, None),
            Err(spelling) => (spelling, Some(Reason::Taken)),
        };
        if let Some(earlier) = self.claimed.get(&spelling) {
            reason = Some(Reason::Same(*earlier));
        } else if language.has_file_per_type && self.role == Role::Type {
            let file = spelling.to_lowercase();
            reason = reason.or(self.files.get(&file).copied().map(Reason::SameFile));
            self.files.entry(file).or_insert(who);
        }
        self.claimed.entry(spelling.clone()).or_insert(who);
        clashes.extend(reason.map(|reason| Clash {
            language: language.title,
            who,
            spelling: spelling.to_string(),
            reason,
        }));
        spelling
    }

    /// Returns all claimed names.
    pub(super) fn into_names(self) -> HashSet<Cow<'m, str>> {
        self.claimed.into_keys().collect()
    }
}

/// Returns the first of `wishes` that is not `taken`. If all are taken, appends underscores to the last.
pub fn free(wishes: &[&str], taken: impl Fn(&str) -> bool) -> String {
    for wish in wishes {
        if !taken(wish) {
            return (*wish).to_owned();
        }
    }
    let mut name = wishes.last().copied().unwrap_or("other").to_owned();
    while taken(&name) {
        name.push('_');
    }
    name
}

#[cfg(test)]
mod tests {
    use super::free;

    #[test]
    fn free_names() {
        let taken = ["Unknown", "Other"];
        let is_taken = |name: &str| taken.contains(&name);
        assert_eq!(
            free(&["Unknown", "Other", "Unlisted"], is_taken),
            "Unlisted"
        );
        assert_eq!(free(&["Unknown"], is_taken), "Unknown_");
    }
}
