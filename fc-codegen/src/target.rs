//! What is made of a model, and where: `fc.yaml` at a project's root.
//!
//! ```yaml
//! spec: spec
//! languages: [zh, en]
//! targets:
//!   rust: { out: fc-generated, crate: fc_generated }
//!   markdown: { out: docs-site, languages: [zh, en] }
//!   handbook: { plugin: tools/handbook.py, out: handbook, options: { title: Robots } }
//! ```
//!
//! A target with the name of a product is made here; one with a `plugin` is made by that program, which gets what
//! `fcproto inspect` prints and answers with files ([`Plugin`]). A project without the file, or without `targets` in it, has every product at its
//! usual place. Each text of the spec is required in the `languages`, both by default. `lint` is read by `fc_spec::lint`. `newtypes: true` on `rust` or `python` gives the ids of each entity a type of their own, in both. A target with an `audience` is
//! made of what that audience has ([`part`]). A plugin's `names: kotlin` says that the names of the spec have to be free in
//! that language.

pub use crate::plugin::Plugin;

use crate::check::Requirements;
use crate::package::language as languages;
use crate::plugin::{OUTPUT_BYTES, TIMEOUT_MS};
use crate::product::{Artifact, Product};
use fc_spec::model::{Lang, Languages, Model, ProjectionError, Text};
use serde::Deserialize;
use serde::de::IgnoredAny;
use serde_yaml::Value as Options;
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::time::Duration;

/// The file, from the project's root.
pub const FILE: &str = "fc.yaml";

/// What the Rust package calls itself, unless the file says otherwise.
const CRATE: &str = "fc_generated";

/// Where the spec is, unless the file says otherwise.
const SPEC: &str = "spec";

/// What a project makes of its spec.
#[derive(Clone, Debug)]
pub struct Targets {
    /// Directory of the spec, from the root.
    pub spec: String,
    /// Languages in which each text of the spec is required.
    pub texts: Languages,
    products: BTreeMap<Product, Settings>,
    plugins: Vec<Plugin>,
    /// Whether the ids of each entity have a type of their own in the Rust package. The docs show them, also where
    /// they are made alone.
    newtypes: bool,
    /// What the project has besides, and is not made this time: comments point to the docs all the same, and these show
    /// the samples of each package.
    others: BTreeMap<Product, Settings>,
}

/// Where a product goes, and what is left out of it.
#[derive(Clone, Debug)]
struct Settings {
    out: String,
    languages: Vec<Lang>,
    /// What the Rust package calls itself.
    krate: String,
    /// Whose part of the protocol it holds; all of it where nobody is named.
    audience: Option<String>,
}

/// Why `fc.yaml` cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum TargetError {
    /// It is not YAML, or has keys that nobody knows.
    #[error("`{FILE}`: {0}")]
    Shape(#[from] serde_yaml::Error),
    /// There is no product of this name, and the target has no plugin.
    #[error(
        "`{FILE}`: there is no product `{name}`; the products are {}. A target of another name needs a `plugin`",
        products()
    )]
    Unknown {
        /// The name.
        name: String,
    },
    /// A list of languages is empty.
    #[error("`{FILE}`: `languages` needs at least one of `zh` and `en`")]
    NoLanguage,
    /// A key that means nothing in this target.
    #[error("`{FILE}`: the target `{name}` cannot have `{key}`")]
    Misplaced {
        /// The target.
        name: String,
        /// The key.
        key: &'static str,
    },
    /// A key that this target needs.
    #[error("`{FILE}`: the target `{name}` needs `{key}`")]
    Missing {
        /// The target.
        name: String,
        /// The key.
        key: &'static str,
    },
    /// A number is too small or too large.
    #[error("`{FILE}`: `{key}` of the target `{name}` must be from 1 to {most}")]
    OutOfRange {
        /// The target.
        name: String,
        /// The key.
        key: &'static str,
        /// The largest value.
        most: u64,
    },
    /// `names` of a target is no language whose names are known.
    #[error(
        "`{FILE}`: the target `{target}` has names in `{language}`; the languages are {}",
        languages()
    )]
    Language {
        /// The target.
        target: String,
        /// What it says.
        language: String,
    },
    /// Something is to be made for nobody that the spec knows.
    #[error("{0}")]
    Audience(#[from] ProjectionError),
    /// `--only` names a target that the project does not have.
    #[error("there is no target `{name}`; the targets are {known}")]
    NotThere {
        /// The name.
        name: String,
        /// Those that it has.
        known: String,
    },
}

impl TargetError {
    /// The sentence for the user.
    #[must_use]
    pub fn text(&self) -> Text {
        let zh = match self {
            Self::Audience(error) => return error.text(),
            Self::Shape(error) => format!("`{FILE}`：{}", crate::yaml_error::chinese(error)),
            Self::Unknown { name } => format!(
                "`{FILE}`：没有产物 `{name}`；产物有：{}。其他名称的目标需要 `plugin`",
                products()
            ),
            Self::NoLanguage => format!("`{FILE}`：`languages` 至少需要 `zh` 和 `en` 中的一个"),
            Self::Misplaced { name, key } => {
                format!("`{FILE}`：目标 `{name}` 不能有 `{key}`")
            }
            Self::Missing { name, key } => format!("`{FILE}`：目标 `{name}` 需要 `{key}`"),
            Self::OutOfRange { name, key, most } => {
                format!("`{FILE}`：目标 `{name}` 的 `{key}` 应为 1 到 {most}")
            }
            Self::Language { target, language } => format!(
                "`{FILE}`：目标 `{target}` 的名称所用的语言是 `{language}`；语言有：{}",
                languages()
            ),
            Self::NotThere { name, known } => format!("没有目标 `{name}`；目标有：{known}"),
        };
        let en = self.to_string();
        Text { zh, en }
    }
}

fn products() -> String {
    quoted(Product::ALL.iter().map(|product| product.name()))
}

fn languages() -> String {
    quoted(
        languages::Language::ALL
            .iter()
            .map(|language| language.name),
    )
}

fn quoted<'n>(names: impl Iterator<Item = &'n str>) -> String {
    let names: Vec<_> = names.map(|name| format!("`{name}`")).collect();
    names.join(", ")
}

/// The file as it is written.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Written {
    #[serde(default = "usual_spec")]
    spec: String,
    languages: Option<Vec<Lang>>,
    targets: Option<BTreeMap<String, WrittenTarget>>,
    /// Read by `fc_spec::lint`, which tells of faults in it with their places.
    #[serde(default, rename = "lint")]
    _lint: IgnoredAny,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct WrittenTarget {
    out: Option<String>,
    languages: Option<Vec<Lang>>,
    #[serde(rename = "crate")]
    krate: Option<String>,
    newtypes: Option<bool>,
    plugin: Option<String>,
    names: Option<String>,
    audience: Option<String>,
    timeout_ms: Option<u64>,
    output_bytes: Option<u64>,
    options: Option<Options>,
}

fn usual_spec() -> String {
    SPEC.to_owned()
}

impl Default for Targets {
    /// Every product at its usual place.
    fn default() -> Self {
        Self::of(Product::ALL)
    }
}

impl Settings {
    fn usual(product: Product, texts: Languages) -> Self {
        let languages = Lang::ALL.into_iter();
        Self {
            out: product.usual_place().to_owned(),
            languages: languages.filter(|it| texts.include(*it)).collect(),
            krate: CRATE.to_owned(),
            audience: None,
        }
    }
}

impl Targets {
    /// These products at their usual places.
    pub fn of(products: impl IntoIterator<Item = Product>) -> Self {
        Self::in_languages(Languages::All, products)
    }

    fn in_languages(texts: Languages, products: impl IntoIterator<Item = Product>) -> Self {
        let products = products.into_iter();
        Self {
            spec: usual_spec(),
            texts,
            products: products
                .map(|product| (product, Settings::usual(product, texts)))
                .collect(),
            plugins: Vec::new(),
            newtypes: false,
            others: BTreeMap::new(),
        }
    }

    /// Reads the text of `fc.yaml`.
    ///
    /// # Errors
    ///
    /// [`TargetError`] with the place in the file, or the target and the key.
    pub fn read(yaml: &str) -> Result<Self, TargetError> {
        let written: Written = serde_yaml::from_str(yaml)?;
        let texts = match written.languages.as_deref() {
            Some([]) => return Err(TargetError::NoLanguage),
            Some([first, others @ ..]) if others.iter().all(|other| other == first) => {
                Languages::Only(*first)
            }
            Some(_) | None => Languages::All,
        };
        let usual = match written.targets {
            None => Product::ALL.as_slice(),
            Some(_) => &[],
        };
        let mut targets = Self {
            spec: written.spec,
            ..Self::in_languages(texts, usual.iter().copied())
        };
        let written_targets = written.targets.unwrap_or_default();
        for (name, target) in written_targets {
            match Product::named(&name) {
                Some(product) => {
                    targets.newtypes |= target.newtypes == Some(true);
                    let settings = target.settings(product, name, texts)?;
                    targets.products.insert(product, settings);
                }
                None => targets.plugins.push(target.into_plugin(name)?),
            }
        }
        Ok(targets)
    }

    /// The same with nothing but the targets of these names; all of them where there are none.
    ///
    /// # Errors
    ///
    /// [`TargetError::NotThere`].
    pub fn only(mut self, names: &[String]) -> Result<Self, TargetError> {
        if let Some(name) = names
            .iter()
            .find(|name| !self.names().any(|known| known == *name))
        {
            return Err(TargetError::NotThere {
                name: name.clone(),
                known: quoted(self.names()),
            });
        }
        if !names.is_empty() {
            let chosen = |target: &str| names.iter().any(|name| name == target);
            let products = std::mem::take(&mut self.products).into_iter();
            let (made, others) = products.partition(|(product, _)| chosen(product.name()));
            (self.products, self.others) = (made, others);
            self.plugins.retain(|plugin| chosen(&plugin.name));
        }
        Ok(self)
    }

    /// Names of all targets, those of the products first.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        let products = self.products.keys().map(|product| product.name());
        products.chain(self.plugins.iter().map(|plugin| plugin.name.as_str()))
    }

    /// The products to be made.
    pub fn products(&self) -> impl Iterator<Item = Product> {
        self.products.keys().copied()
    }

    /// The targets that other programs make.
    #[must_use]
    pub fn plugins(&self) -> &[Plugin] {
        &self.plugins
    }

    /// Returns the requirements that the project has on its spec.
    #[must_use]
    pub fn requirements(&self) -> Requirements {
        Requirements {
            texts: self.texts,
            names: self.languages(),
        }
    }

    /// The programming languages in which the names of the spec have to be free.
    #[must_use]
    pub fn languages(&self) -> Vec<&'static languages::Language> {
        let packages = self
            .products()
            .flat_map(|product| self.languages_of(product));
        let plugins = self.plugins.iter().filter_map(|plugin| plugin.names);
        let mut languages: Vec<&languages::Language> = Vec::new();
        for language in packages.chain(plugins) {
            if !languages.iter().any(|known| known.name == language.name) {
                languages.push(language);
            }
        }
        languages
    }

    /// The programming languages that a product is written in.
    fn languages_of(&self, product: Product) -> Vec<&'static languages::Language> {
        match product {
            Product::Rust => vec![self.rust()],
            Product::TypeScript => vec![&languages::TYPESCRIPT],
            Product::Python => vec![self.python()],
            Product::Kotlin => vec![&languages::KOTLIN, &languages::JAVA],
            Product::Cpp => vec![&languages::CPP],
            Product::Markdown | Product::Vectors | Product::Schema => Vec::new(),
        }
    }

    /// Where a product goes, if the project has it.
    #[must_use]
    pub fn place(&self, product: Product) -> Option<&str> {
        Some(self.settings(product)?.out.as_str())
    }

    /// Whether the docs are made in this language.
    #[must_use]
    pub fn speaks(&self, language: Lang) -> bool {
        let settings = self.products.get(&Product::Markdown);
        settings.is_none_or(|settings| settings.languages.contains(&language))
    }

    /// The folders of the docs that the project has, one for each language.
    #[must_use]
    pub fn docs(&self) -> Vec<(Lang, String)> {
        let Some(out) = self.place(Product::Markdown) else {
            return Vec::new();
        };
        let spoken = Lang::ALL.into_iter().filter(|it| self.speaks(*it));
        let folder = |language| match language {
            Lang::Zh => out.to_owned(),
            Lang::En => format!("{out}/en"),
        };
        spoken
            .map(|language| (language, folder(language)))
            .collect()
    }

    /// What the Rust package calls itself.
    #[must_use]
    pub fn krate(&self) -> &str {
        let settings = self.products.get(&Product::Rust);
        settings.map_or(CRATE, |settings| &settings.krate)
    }

    /// Rust as the Rust package spells it.
    #[must_use]
    pub fn rust(&self) -> &'static languages::Language {
        if self.newtypes {
            &languages::RUST_WITH_IDS
        } else {
            &languages::RUST
        }
    }

    /// How names are spelled in the Python package.
    #[must_use]
    pub fn python(&self) -> &'static languages::Language {
        if self.newtypes {
            &languages::PYTHON_WITH_IDS
        } else {
            &languages::PYTHON
        }
    }

    /// Returns `true` if Rust and Python have a type for the IDs of each entity.
    #[must_use]
    pub fn has_id_types(&self) -> bool {
        self.newtypes
    }

    /// The same, with a type of its own for the ids of each entity.
    #[must_use]
    pub fn with_newtypes(self) -> Self {
        Self {
            newtypes: true,
            ..self
        }
    }

    /// Whose part of the protocol a product holds; all of it where nobody is named.
    #[must_use]
    pub fn audience(&self, product: Product) -> Option<&str> {
        self.settings(product)?.audience.as_deref()
    }

    /// Of a product that the project has, made this time or not.
    fn settings(&self, product: Product) -> Option<&Settings> {
        let made = self.products.get(&product);
        made.or_else(|| self.others.get(&product))
    }

    /// Whether the spec knows everyone for whom a target is made.
    ///
    /// # Errors
    ///
    /// [`TargetError::Audience`].
    pub fn check_audiences(&self, model: &Model) -> Result<(), TargetError> {
        let products = self.products.values().map(|settings| &settings.audience);
        let plugins = self.plugins.iter().map(|plugin| &plugin.audience);
        for audience in products.chain(plugins) {
            part(model, audience.as_deref())?;
        }
        Ok(())
    }

    /// A file of a product.
    pub(crate) fn artifact(&self, product: Product, path: &str, contents: String) -> Artifact {
        let out = self.place(product).unwrap_or(product.usual_place());
        Artifact {
            target: product.name().to_owned(),
            path: below(out, path),
            contents,
        }
    }
}

/// What an audience has of a model; all of it where nobody is named.
///
/// # Errors
///
/// [`TargetError::Audience`] if the spec declares no audience of this name.
pub fn part<'m>(model: &'m Model, audience: Option<&str>) -> Result<Cow<'m, Model>, TargetError> {
    Ok(match audience {
        Some(audience) => Cow::Owned(model.for_audience(audience)?),
        None => Cow::Borrowed(model),
    })
}

/// A path below a directory, which may be the root itself.
pub(crate) fn below(directory: &str, path: &str) -> String {
    match directory.trim_end_matches('/') {
        "" | "." => path.to_owned(),
        directory => format!("{directory}/{path}"),
    }
}

impl WrittenTarget {
    fn settings(
        self,
        product: Product,
        name: String,
        texts: Languages,
    ) -> Result<Settings, TargetError> {
        let misplaced = [
            ("plugin", self.plugin.is_some()),
            ("names", self.names.is_some()),
            ("options", self.options.is_some()),
            (TIMEOUT_MS.key, self.timeout_ms.is_some()),
            (OUTPUT_BYTES.key, self.output_bytes.is_some()),
            (
                "languages",
                self.languages.is_some() && product != Product::Markdown,
            ),
            ("crate", self.krate.is_some() && product != Product::Rust),
            (
                "newtypes",
                self.newtypes.is_some() && !matches!(product, Product::Rust | Product::Python),
            ),
            // The language is the same for everyone.
            (
                "audience",
                self.audience.is_some() && product == Product::Schema,
            ),
        ];
        if let Some((key, _)) = misplaced.into_iter().find(|(_, is_there)| *is_there) {
            return Err(TargetError::Misplaced { name, key });
        }
        if self.languages.as_ref().is_some_and(Vec::is_empty) {
            return Err(TargetError::NoLanguage);
        }
        let usual = Settings::usual(product, texts);
        Ok(Settings {
            out: self.out.unwrap_or(usual.out),
            languages: self.languages.unwrap_or(usual.languages),
            krate: self.krate.unwrap_or(usual.krate),
            audience: self.audience,
        })
    }

    fn into_plugin(self, name: String) -> Result<Plugin, TargetError> {
        let Some(program) = self.plugin else {
            return Err(TargetError::Unknown { name });
        };
        let misplaced = [
            ("languages", self.languages.is_some()),
            ("crate", self.krate.is_some()),
            ("newtypes", self.newtypes.is_some()),
        ];
        if let Some((key, _)) = misplaced.into_iter().find(|(_, is_there)| *is_there) {
            return Err(TargetError::Misplaced { name, key });
        }
        let Some(out) = self.out else {
            return Err(TargetError::Missing { name, key: "out" });
        };
        let names = match self.names {
            Some(language) => match languages::Language::named(&language) {
                Some(known) => Some(known),
                None => {
                    return Err(TargetError::Language {
                        target: name,
                        language,
                    });
                }
            },
            None => None,
        };
        let timeout = TIMEOUT_MS.of(self.timeout_ms, &name)?;
        let output_bytes = OUTPUT_BYTES.of(self.output_bytes, &name)?;
        Ok(Plugin {
            name,
            program,
            out,
            names,
            audience: self.audience,
            timeout: Duration::from_millis(timeout),
            output_bytes,
            options: self.options.unwrap_or_default(),
        })
    }
}
