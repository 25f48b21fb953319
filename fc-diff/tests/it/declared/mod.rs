//! Public declarations of generated packages, read from the text of their files.
//!
//! Each language has its rules in its own file. The rules cover the output of the generator only. A name includes the
//! module path that a program writes. The signature is the part that a compiler checks against the program.

mod cpp;
mod kotlin;
mod python;
mod rust;
mod tree;
mod typescript;

use fc_codegen::product::Artifact;
use fc_diff::Language;
use std::collections::{BTreeMap, BTreeSet};

/// The declarations of a package.
#[derive(Debug, Default)]
pub struct Declared {
    /// Names with their signatures. Many names have an empty signature.
    pub names: BTreeMap<String, String>,
    /// Names that break programs when they are added: methods to implement, required fields, cases of an exhaustive
    /// match.
    pub demands: BTreeSet<String>,
    /// Members whose order matters, by their owner.
    pub orders: BTreeMap<String, Vec<String>>,
}

/// Languages with a package. `JvmBinary` uses the package of Kotlin.
const LANGUAGES: [Language; 5] = [
    Language::Rust,
    Language::Typescript,
    Language::Python,
    Language::Kotlin,
    Language::Cpp,
];

/// Reads the declarations of each package among the artifacts.
pub fn declared(artifacts: &[Artifact]) -> BTreeMap<Language, Declared> {
    let read = |language: Language| {
        let (target, read): (_, fn(&mut Declared, &str, &str)) = match language {
            Language::Rust => ("rust", rust::read),
            Language::Typescript => ("typescript", typescript::read),
            Language::Python => ("python", python::read),
            Language::Kotlin | Language::JvmBinary => ("kotlin", kotlin::read),
            Language::Cpp => ("cpp", cpp::read),
        };
        let mut declared = Declared::default();
        for artifact in artifacts.iter().filter(|it| it.target == target) {
            read(&mut declared, &artifact.path, &artifact.contents);
        }
        (language, declared)
    };
    let made = LANGUAGES.into_iter().map(read);
    made.filter(|(_, declared)| !declared.names.is_empty())
        .collect()
}

impl Declared {
    fn name(&mut self, name: impl Into<String>, signature: impl Into<String>) {
        self.names.insert(name.into(), signature.into());
    }

    fn demand(&mut self, name: impl Into<String>, signature: impl Into<String>) {
        let name = name.into();
        self.demands.insert(name.clone());
        self.name(name, signature);
    }

    /// Returns the names of Kotlin declarations as compiled code spells them. A nullable primitive is a different type
    /// there, while `String?` is the same as `String`.
    pub fn compiled(&self) -> Self {
        let bare = |name: &String| {
            let mut bare = name.replace('?', "");
            for primitive in ["Boolean", "Int", "Long", "Float", "Double"] {
                if name.contains(&format!("{primitive}?")) {
                    bare = bare.replace(primitive, &format!("{primitive}?"));
                }
            }
            (bare, String::new())
        };
        Self {
            names: self.names.keys().map(bare).collect(),
            ..Self::default()
        }
    }

    /// Returns the names that `new` lacks.
    pub fn gone_in(&self, new: &Self) -> Vec<String> {
        let names = self
            .names
            .keys()
            .filter(|name| !new.names.contains_key(*name));
        names.cloned().collect()
    }

    /// Returns the reasons why a program for this version may not compile with `new`.
    pub fn broken_by(&self, new: &Self) -> Vec<String> {
        let gone = self
            .gone_in(new)
            .into_iter()
            .map(|name| format!("{name} is gone"));
        let changed = self.names.iter().filter_map(|(name, signature)| {
            let now = new.names.get(name).filter(|now| *now != signature)?;
            Some(format!("{name} is {now} and not {signature}"))
        });
        // A new type demands nothing from programs that do not know it.
        let is_known = |name: &&String| {
            let owners = name.match_indices(['.', ':', '|']);
            owners
                .into_iter()
                .any(|(at, _)| self.names.contains_key(&name[..at]))
        };
        let asked = new.demands.difference(&self.demands).filter(is_known);
        let asked = asked.map(|name| format!("{name} has to be there"));
        let moved = self.orders.iter().filter_map(|(owner, order)| {
            let now = new.orders.get(owner)?;
            let kept = order.iter().filter(|it| now.contains(it));
            let is_same = kept.zip(now).all(|(one, other)| one == other);
            (!is_same).then(|| format!("{owner} has {now:?} and not {order:?}"))
        });
        gone.chain(changed).chain(asked).chain(moved).collect()
    }
}
