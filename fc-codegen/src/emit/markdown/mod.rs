//! The reference pages of the docs, in Chinese and English.
//!
//! A typed view per kind of page (`pages`) and a template that only lays it out (`templates`). Both
//! languages share a template: a fixed phrase stands there in both, side by side, so that neither
//! can be forgotten. The spec's own sentences are picked by language in the views.
//!
//! Pages are plain Markdown with explicit anchors, and render in `VitePress` as they stand.

mod available;
mod book;
mod bytes;
mod commented;
mod conditions;
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
pub(crate) use tabs::TabsOf;
pub(crate) use words::{Word, confirmed};

use crate::product::{Artifact, Product};
use crate::target::{Language, Targets};
use engine::{Engine, tidy};
use fc_spec::model::Model;
use pages::Desk;
use rayon::iter::{IntoParallelRefIterator as _, ParallelIterator as _};

/// Every page, Chinese first, and what the site's sidebar lists.
///
/// # Panics
///
/// If a template is wrong. Templates are source code: none of them depends on what the spec says
/// beyond the types of the views, and tests render each of them.
#[must_use]
#[allow(clippy::panic)]
pub fn emit(model: &Model, targets: &Targets) -> Vec<Artifact> {
    let book = Book::new(model, tabs::of(model, targets));
    let engine = Engine::new().unwrap_or_else(|error| panic!("{error:#}"));
    let render = |lang| {
        let engine = engine.speaking(lang);
        render(&book, &engine, targets, lang).unwrap_or_else(|error| panic!("{error:#}"))
    };
    let navigation = navigation::navigation(model);
    let navigation = targets.artifact(Product::Markdown, "reference/navigation.json", navigation);
    let languages = Lang::ALL.into_iter();
    let languages = languages.filter(|lang| targets.speaks(lang.pick(Language::Zh, Language::En)));
    languages.flat_map(render).chain([navigation]).collect()
}

fn render(
    book: &Book<'_>,
    engine: &Engine,
    targets: &Targets,
    lang: Lang,
) -> Result<Vec<Artifact>, minijinja::Error> {
    let operations = book.model.operations.iter().map(Page::Operation);
    let pages: Vec<Page<'_>> = Page::FIXED.into_iter().chain(operations).collect();
    let rendered = pages.par_iter().map(|&page| {
        let desk = Desk { book, lang, page };
        let contents = match page {
            Page::Index => engine.render("index.md.j2", &pages::index(desk)),
            Page::Wire => engine.render("wire.md.j2", &pages::wire(desk)),
            Page::Codes => engine.render("codes.md.j2", &pages::codes(desk)),
            Page::Types => engine.render("types.md.j2", &pages::types(desk)),
            Page::Results => engine.render("results.md.j2", &pages::results(desk)),
            Page::Tables => engine.render("tables.md.j2", &pages::tables(desk)),
            Page::Entities => engine.render("entities.md.j2", &pages::entities(desk)),
            Page::Places => engine.render("places.md.j2", &pages::places(desk)),
            Page::Glossary => engine.render("glossary.md.j2", &pages::glossary(desk)),
            Page::Changelog => engine.render("changelog.md.j2", &pages::changelog(desk)),
            Page::OpenQuestions => {
                engine.render("open-questions.md.j2", &pages::open_questions(desk))
            }
            Page::Language => engine.render("language.md.j2", &pages::language(desk)),
            Page::Errors => engine.render("errors.md.j2", &pages::errors(desk)),
            Page::Operation(operation) => {
                engine.render("operation.md.j2", &pages::operation(desk, operation))
            }
        };
        let directory = lang.pick("reference", "en/reference");
        let path = format!("{directory}/{}", page.path());
        let contents = tidy(&book.terms(lang).first_uses(page, &contents?));
        Ok(targets.artifact(Product::Markdown, &path, contents))
    });
    rendered.collect()
}
