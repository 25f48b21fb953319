//! The samples of an operation's page: how it is called and answered in each language that the project has a package of.

use crate::emit::{cpp, kotlin, python, rust, typescript};
use crate::package::context::Context;
use crate::package::samples::{self, Sample, Shown};
use crate::package::source::Source;
use crate::product::Product;
use crate::target::{Targets, below, part};
use fc_spec::model::Model;
use rayon::iter::{IntoParallelRefIterator as _, ParallelIterator as _};
use serde::Serialize;
use std::collections::HashMap;

/// The languages, in the order of their tabs.
const SHOWN: [(Product, &Shown); 5] = [
    (Product::Rust, &rust::samples::SHOWN),
    (Product::TypeScript, &typescript::samples::SHOWN),
    (Product::Python, &python::samples::SHOWN),
    (Product::Kotlin, &kotlin::samples::SHOWN),
    (Product::Cpp, &cpp::samples::SHOWN),
];

/// What shows each operation, by its name; one without a code is not there.
pub(crate) type TabsOf = HashMap<String, Tabs>;

/// What shows an operation: a tab for each language.
#[derive(Clone, Debug, Default, Serialize)]
pub(crate) struct Tabs {
    /// What an app does.
    app: Vec<Tab>,
    /// What a robot does.
    robot: Vec<Tab>,
    /// The files that have the same code, in the order of the languages.
    files: Vec<File>,
}

/// A sample in one language.
#[derive(Clone, Debug, Serialize)]
struct Tab {
    /// What its fence says: the language, and behind it the name of the tab.
    info: String,
    code: String,
}

/// A file with the samples of all operations.
#[derive(Clone, Debug, Serialize)]
struct File {
    /// Its language, by name.
    language: &'static str,
    /// From the project's root.
    path: String,
}

/// The tabs of all operations of a model.
pub(super) fn of(model: &Model, targets: &Targets) -> TabsOf {
    let mut all = TabsOf::new();
    for (product, shown) in SHOWN {
        let Some(place) = targets.place(product) else {
            continue;
        };
        // What a package's audience does not have, it does not show.
        let Ok(model) = part(model, targets.audience(product)) else {
            continue;
        };
        let language = (shown.language)(targets);
        let context = Context::new(&model, language, shown.style, None);
        let tab = |sample: Sample<'_, '_>| {
            let mut out = Source::new(context.style);
            (shown.write)(&mut out, &context, &sample);
            Tab {
                info: format!("{} [{}]", shown.fence, language.title),
                code: out.finish(),
            }
        };
        let both = model.operations.par_iter().map(|operation| {
            let app = samples::app(&context, operation);
            let robot = samples::robot(&context, operation);
            (operation.name.as_str(), [app, robot].map(|it| it.map(tab)))
        });
        for (name, [app, robot]) in both.collect::<Vec<_>>() {
            if app.is_none() && robot.is_none() {
                continue;
            }
            let tabs = all.entry(name.to_owned()).or_default();
            tabs.app.extend(app);
            tabs.robot.extend(robot);
            tabs.files.push(File {
                language: language.title,
                path: below(place, shown.file),
            });
        }
    }
    all
}
