//! The reference pages of the docs, in Chinese and English.
//!
//! Each kind of page has a view with its values (`pages`) and a template for its layout (`templates`). Both languages
//! share a template, and each fixed phrase is in it in both languages, so that no translation is missing. The views
//! choose the language of the spec's sentences.
//!
//! Pages are plain Markdown with explicit anchors. `VitePress` renders them unchanged.

mod available;
mod book;
mod bytes;
mod commented;
mod conditions;
mod desk;
mod engine;
mod enums;
mod escape;
mod links;
mod mentions;
mod navigation;
mod pages;
mod places;
mod rows;
mod states;
mod tabs;
mod terms;
mod words;

pub(crate) use book::Book;
pub use fc_spec::model::Lang;
pub(crate) use links::Page;
pub(crate) use tabs::TabsByOperation;
pub(crate) use words::{Word, confirmed, purpose};

use crate::product::{Artifact, Product};
use crate::target::Targets;
use desk::Desk;
use engine::{Engine, tidy};
use fc_spec::model::Model;
use rayon::iter::{IntoParallelRefIterator as _, ParallelIterator as _};

/// Returns every page, Chinese first, and the contents of the site's sidebar.
///
/// # Panics
///
/// If a template is invalid. Templates are source code and depend only on the types of the views. Tests render each of
/// them.
#[must_use]
pub fn emit(model: &Model, targets: &Targets) -> Vec<Artifact> {
    let press = Press::new(model, targets);
    let operations = model.operations.iter().map(Page::Operation);
    let pages: Vec<Page<'_>> = Page::FIXED.into_iter().chain(operations).collect();
    let languages = press.languages.iter().flat_map(|(lang, engine)| {
        let pages = pages.par_iter();
        let printed = pages.map(|&page| press.page(*lang, engine, page));
        printed.collect::<Vec<_>>()
    });
    languages.chain([press.navigation()]).collect()
}

/// Passes the artifacts of [`emit`] to `wanted` one by one until it returns `false`, the pages of operations first. The
/// search for a difference uses it. Returns `true` if all were passed.
///
/// # Panics
///
/// As [`emit`] does.
pub fn emit_while(model: &Model, targets: &Targets, wanted: impl FnMut(Artifact) -> bool) -> bool {
    let press = Press::new(model, targets);
    let operations = model.operations.iter().map(Page::Operation);
    let pages: Vec<Page<'_>> = operations.chain(Page::FIXED).collect();
    let in_all = pages.iter().flat_map(|&page| {
        let press = &press;
        let languages = press.languages.iter();
        languages.map(move |(lang, engine)| press.page(*lang, engine, page))
    });
    // Pages after the last wanted one are not rendered.
    in_all.chain([press.navigation()]).all(wanted)
}

/// The input of all pages.
struct Press<'m> {
    book: Book<'m>,
    targets: &'m Targets,
    languages: Vec<(Lang, Engine)>,
}

impl<'m> Press<'m> {
    #[allow(clippy::panic)]
    fn new(model: &'m Model, targets: &'m Targets) -> Self {
        let engine = Engine::new().unwrap_or_else(|error| panic!("{error:#}"));
        let languages = Lang::ALL.into_iter();
        let languages = languages.filter(|lang| targets.texts_of(Product::Markdown).include(*lang));
        Self {
            book: Book::new(model, tabs::by_operation(model, targets)),
            targets,
            languages: languages.map(|it| (it, engine.speaking(it))).collect(),
        }
    }

    fn navigation(&self) -> Artifact {
        let navigation = navigation::navigation(self.book.model);
        let (product, path) = (Product::Markdown, "reference/navigation.json");
        self.targets.artifact(product, path, navigation)
    }

    #[allow(clippy::panic)]
    fn page(&self, lang: Lang, engine: &Engine, page: Page<'_>) -> Artifact {
        let book = &self.book;
        let desk = Desk { book, lang, page };
        let contents = match page {
            Page::Index => engine.render("index.md.j2", pages::index(desk)),
            Page::Wire => engine.render("wire.md.j2", pages::wire(desk)),
            Page::Codes => engine.render("codes.md.j2", pages::codes(desk)),
            Page::Types => engine.render("types.md.j2", pages::types(desk)),
            Page::Results => engine.render("results.md.j2", pages::results(desk)),
            Page::Tables => engine.render("tables.md.j2", pages::tables(desk)),
            Page::Entities => engine.render("entities.md.j2", pages::entities(desk)),
            Page::Places => engine.render("places.md.j2", pages::places(desk)),
            Page::Glossary => engine.render("glossary.md.j2", pages::glossary(desk)),
            Page::Changelog => engine.render("changelog.md.j2", pages::changelog(desk)),
            Page::OpenQuestions => {
                engine.render("open-questions.md.j2", pages::open_questions(desk))
            }
            Page::Language => engine.render("language.md.j2", pages::language(desk)),
            Page::Errors => engine.render("errors.md.j2", pages::errors(desk)),
            Page::Operation(operation) => {
                engine.render("operation.md.j2", pages::operation(desk, operation))
            }
        };
        let contents = contents.unwrap_or_else(|error| panic!("{error:#}"));
        let directory = lang.pick("reference", "en/reference");
        let path = format!("{directory}/{}", page.path());
        let contents = tidy(&book.terms(lang).first_uses(page, &contents));
        self.targets.artifact(Product::Markdown, &path, contents)
    }
}
