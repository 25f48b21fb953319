//! The code samples of an operation's page, in each language for which the project has a package.

use crate::emit::{cpp, kotlin, python, rust, typescript};
use crate::package::context::Context;
use crate::package::samples::{self, Sample, SampleTab};
use crate::product::Product;
use crate::product::below;
use crate::target::{Targets, part};
use fc_spec::model::Model;
use minijinja::{Value, context};
use rayon::iter::{IntoParallelRefIterator as _, ParallelIterator as _};
use serde::Serialize;
use std::collections::HashMap;

/// The languages, in the order of their tabs.
const TABS: [(Product, &SampleTab); 5] = [
    (Product::Rust, &rust::samples::TAB),
    (Product::TypeScript, &typescript::samples::TAB),
    (Product::Python, &python::samples::TAB),
    (Product::Kotlin, &kotlin::samples::TAB),
    (Product::Cpp, &cpp::samples::TAB),
];

/// Samples by operation name. Operations without a code have none.
pub(crate) type TabsByOperation = HashMap<String, Tabs>;

/// The samples of an operation, with a tab for each language.
#[derive(Clone, Debug, Default, Serialize)]
pub(crate) struct Tabs {
    /// The samples for an app, each with the info string of its fence.
    app: Vec<Value>,
    /// The samples for a robot.
    robot: Vec<Value>,
    /// The files that contain the same code, in the order of the languages.
    files: Vec<Value>,
}

/// Returns the samples of all operations of a model.
pub(super) fn by_operation(model: &Model, targets: &Targets) -> TabsByOperation {
    let mut all = TabsByOperation::new();
    for (product, tab) in TABS {
        let Some(place) = targets.place(product) else {
            continue;
        };
        // The samples of a package leave out operations for other audiences.
        let Ok(model) = part(model, targets.audience(product)) else {
            continue;
        };
        let language = targets.naming(tab.language);
        let context = Context::new(&model, language, tab.style);
        let written = |sample: Sample<'_, '_>| {
            let mut out = context.source();
            (tab.write)(&mut out, &context, &sample);
            context! {
                info => format!("{} [{}]", tab.fence, language.title),
                code => out.finish(),
            }
        };
        let both = model.operations.par_iter().map(|operation| {
            let app = samples::app(&context, operation);
            let robot = samples::robot(&context, operation);
            (
                operation.name.as_str(),
                [app, robot].map(|it| it.map(written)),
            )
        });
        for (name, [app, robot]) in both.collect::<Vec<_>>() {
            if app.is_none() && robot.is_none() {
                continue;
            }
            let tabs = all.entry(name.to_owned()).or_default();
            tabs.app.extend(app);
            tabs.robot.extend(robot);
            let path = below(place, tab.file);
            tabs.files
                .push(context! { language => language.title, path });
        }
    }
    all
}
