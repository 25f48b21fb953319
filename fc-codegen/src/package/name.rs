//! Names that are next to each other: each claims its spelling in a language, and what cannot have it is a fault.

use super::language::{Language, Role};
use fc_spec::diagnostic::{Diagnostic, FaultCode};
use fc_spec::index::{DefId, Definitions};
use fc_spec::model::Text;
use fc_spec::source::Span;
use fc_spec::text;
use std::borrow::Cow;
use std::collections::{HashMap, HashSet};
use std::fmt;

/// What has a name in the spec, as an [`Item`] says it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Named<'m> {
    /// What it is in the spec language: `field`, `command`.
    pub kind: &'static str,
    /// What it belongs to, where its name alone does not tell it from others.
    pub owner: Option<&'m str>,
    /// Its name there.
    pub name: &'m str,
}

/// A name that a language cannot have.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Clash<'m> {
    /// The language, as people write it.
    pub language: &'static str,
    /// Whose name it is.
    pub who: Named<'m>,
    /// Its spelling in that language.
    pub spelling: String,
    /// Why it cannot be.
    pub reason: Reason<'m>,
}

/// Why a name cannot be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reason<'m> {
    /// The language, or the package itself, needs the name.
    Taken,
    /// Another name has this spelling already.
    Same(Named<'m>),
    /// Another name has this spelling but for upper and lower case, which not every file system tells apart.
    SameFile(Named<'m>),
}

/// With its kind: `field Station.name`.
impl fmt::Display for Named<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { kind, owner, name } = self;
        match owner {
            Some(owner) => write!(f, "`{kind} {owner}.{name}`"),
            None => write!(f, "`{kind} {name}`"),
        }
    }
}

/// For a model that has no places.
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
    /// What its name alone tells from others of its kind.
    pub(super) fn alone(kind: &'static str, name: &'m str) -> Self {
        Self {
            kind,
            owner: None,
            name,
        }
    }

    /// A part of something else.
    pub(super) fn part(kind: &'static str, owner: &'m str, name: &'m str) -> Self {
        Self {
            kind,
            owner: Some(owner),
            name,
        }
    }

    /// Where its name stands in the spec.
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
    /// As a fault of the spec; `None` of a model that has been read from a dump, which has no places.
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

/// Names that are next to each other, and so have to differ.
pub(super) struct Scope<'l, 'm> {
    language: &'l Language,
    role: Role,
    claimed: HashMap<Cow<'m, str>, Named<'m>>,
    files: HashMap<String, Named<'m>>,
}

impl<'l, 'm> Scope<'l, 'm> {
    /// An empty one.
    pub(super) fn new(language: &'l Language, role: Role) -> Self {
        Self {
            language,
            role,
            claimed: HashMap::new(),
            files: HashMap::new(),
        }
    }

    /// Gives a name, written in words that `_` or capitals part, its spelling.
    pub(super) fn claim(
        &mut self,
        words: &'m str,
        who: Named<'m>,
        clashes: &mut Vec<Clash<'m>>,
    ) -> Cow<'m, str> {
        let spelling = self.language.spelling(self.role, words);
        self.take(spelling, who, clashes)
    }

    /// The same for words that are not in the spec themselves.
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

    /// All that have been given.
    pub(super) fn into_names(self) -> HashSet<Cow<'m, str>> {
        self.claimed.into_keys().collect()
    }
}

/// The first of `wishes` that `taken` does not hold; failing all, the last with underscores.
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
