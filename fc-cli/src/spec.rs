//! Reading the spec and showing its faults.

use fc_codegen::check::{Requirements, check};
use fc_spec::diagnostic::{FaultCode, Faults, Format, Severity, render, summary};
use fc_spec::model::{Languages, Model};
use fc_spec::source::Sources;
use fc_spec::syntax::read_dir;

use crate::lang::{both, lang, said};
use crate::outcome::{Failure, Status};
use crate::place::Place;
use crate::print;
use crate::progress;
use crate::project::Project;

/// A spec that has been read.
pub struct Spec {
    /// Its files.
    pub sources: Sources,
    /// Its faults, in the order of the files.
    pub faults: Faults,
    /// What it means, unless there is an error in it.
    pub model: Option<Model>,
    /// Those of its project.
    requirements: Requirements,
}

impl Spec {
    /// Reads the spec and finds its faults.
    pub fn read(place: &Place) -> Result<Self, Failure> {
        Ok(Self::in_project(&Project::find(place)?))
    }

    /// The same of a project that has been found.
    pub fn in_project(project: &Project) -> Self {
        progress::doing(both("正在检查规范", "checking the spec"));
        let mut faults = Faults::new();
        let sources = read_dir(&project.root, &project.spec, &mut faults);
        Self::of(sources, faults, project.targets.requirements())
    }

    fn of(sources: Sources, mut faults: Faults, requirements: Requirements) -> Self {
        let model = check(&sources, &requirements, &mut faults).model();
        Self {
            sources,
            faults,
            model,
            requirements,
        }
    }

    /// The languages in which each text is required.
    pub fn texts(&self) -> Languages {
        self.requirements.texts
    }

    /// The spec as it would be with another text in one of its files.
    pub fn with(&self, path: &str, text: &str) -> Self {
        let texts = self.sources.iter().map(|(_, file)| {
            let text = if file.path == path { text } else { &file.text };
            (file.path.as_str(), text)
        });
        self.instead(Sources::from_texts(texts))
    }

    /// The spec as it would be with other files.
    pub fn instead(&self, sources: Sources) -> Self {
        Self::of(sources, Faults::new(), self.requirements.clone())
    }

    /// Why a spec that is not on disk yet does not get there: its errors without their places.
    pub fn objection(&self) -> String {
        let errors = self.faults.iter();
        let errors = errors.filter(|fault| fault.severity == Severity::Error);
        let errors: Vec<_> = errors
            .map(|fault| {
                let code = fault.code;
                said!(
                    "{message}（{code}）",
                    "{message} ({code})",
                    message = fault.message
                )
            })
            .collect();
        let errors = errors.join(lang().pick("；", "; "));
        said!(
            "规范会有错误：{errors}",
            "the spec would have errors: {errors}"
        )
    }

    /// Shows the faults to people, and how to read more about them.
    pub fn show_faults(&self) -> Result<(), Failure> {
        show_faults(&self.faults, &self.sources)
    }

    /// The exit status for its faults.
    pub fn status(&self) -> Status {
        if self
            .faults
            .iter()
            .any(|fault| fault.code == FaultCode::Unreadable)
        {
            Status::Failed
        } else if self.faults.has_errors() {
            Status::Faulty
        } else {
            Status::Fine
        }
    }

    /// Number of files.
    pub fn files(&self) -> usize {
        self.sources.iter().count()
    }
}

/// Shows faults to people, and how to read more about them.
pub fn show_faults(faults: &Faults, sources: &Sources) -> Result<(), Failure> {
    let text = render(faults, sources, Format::Colored, lang());
    let summary = summary(faults, lang()).map(|line| print::leveled(&line) + "\n");
    print::message(&(text + &summary.unwrap_or_default()))?;
    Ok(())
}
