//! Reads the spec and shows its diagnostics.

use fc_codegen::check::check;
use fc_spec::diagnostic::{Faults, Severity};
use fc_spec::model::{Languages, Model};
use fc_spec::source::Sources;
use fc_spec::syntax::read_dir;

use crate::lang::{both, lang, said};
use crate::outcome::{Failure, Reported, Status};
use crate::print;
use crate::progress;
use crate::project::Project;
use crate::project_dirs::ProjectDirs;

/// A spec that has been read and checked.
pub struct Spec {
    /// The project of the spec.
    pub project: Project,
    /// The files.
    pub sources: Sources,
    /// The diagnostics, in the order of the files.
    pub faults: Faults,
    /// The model, or `None` if the spec has errors.
    pub model: Option<Model>,
}

impl Spec {
    /// Finds the project, then reads and checks its spec.
    pub fn read(dirs: &ProjectDirs) -> Result<Self, Failure> {
        Ok(Self::in_project(Project::find(dirs)?))
    }

    /// Reads and checks the spec of a project.
    pub fn in_project(project: Project) -> Self {
        progress::doing(both("正在检查规范", "checking the spec"));
        let mut faults = Faults::new();
        let sources = read_dir(&project.root, &project.spec, &mut faults);
        Self::of(project, sources, faults)
    }

    fn of(project: Project, sources: Sources, mut faults: Faults) -> Self {
        let requirements = project.targets.requirements();
        let model = check(&sources, &requirements, &mut faults).model();
        Self {
            project,
            sources,
            faults,
            model,
        }
    }

    /// Returns the languages in which each text is required.
    pub fn texts(&self) -> Languages {
        self.project.targets.texts
    }

    /// Checks the spec with another text in one of its files.
    pub fn with(&self, path: &str, text: &str) -> Self {
        let texts = self.sources.iter().map(|(_, file)| {
            let text = if file.path == path { text } else { &file.text };
            (file.path.as_str(), text)
        });
        self.instead(Sources::from_texts(texts))
    }

    /// Checks other files as those of the project.
    pub fn instead(&self, sources: Sources) -> Self {
        Self::of(self.project.clone(), sources, Faults::new())
    }

    /// Returns the errors without their places. They are the reason why a changed spec is not written.
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

    /// Shows the diagnostics as text, with a hint for more information.
    pub fn show_faults(&self) -> Result<(), Failure> {
        Ok(print::faults(&self.faults, &self.sources)?)
    }

    /// Returns the model, or shows the diagnostics of a spec with errors.
    pub fn valid(&self) -> Result<&Model, Failure> {
        if let Some(model) = &self.model {
            return Ok(model);
        }
        self.show_faults()?;
        Err(Reported(self.status()).into())
    }

    /// Returns the exit status for the diagnostics.
    pub fn status(&self) -> Status {
        Status::of(&self.faults)
    }

    /// Returns the number of files.
    pub fn files(&self) -> usize {
        self.sources.iter().count()
    }
}
