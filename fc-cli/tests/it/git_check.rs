//! `fcproto git check`, which checks the staged files only.

use crate::support::Project;
use crate::support::git::{git, run_git};

const LIGHT: &str = "spec/commands/light.yaml";

/// A project of `init` under version control, with hooks. `directory` is its path in the repository.
struct Repository {
    project: Project,
    directory: &'static str,
}

impl Repository {
    fn new(directory: &'static str) -> Self {
        let project = Project::empty();
        let of_git = ["init", "--quiet", "--initial-branch=main"];
        if directory.is_empty() {
            let lamp = ["init", "."];
            git(&project, &of_git);
            project.fc(&lamp).expect(0);
        } else {
            git(&project, &of_git);
            project.fc(&["init", directory]).expect(0);
        }
        let repository = Self { project, directory };
        repository.fc(&["git", "setup", "--hooks"]).expect(0);
        repository.git(&["add", "--all"]);
        repository.git(&["commit", "--quiet", "--message", "Begin"]);
        repository
    }

    fn fc(&self, args: &[&str]) -> crate::support::Run {
        self.project.fc_in(self.directory, args)
    }

    fn git(&self, args: &[&str]) -> String {
        git(&self.project, args)
    }

    fn path(&self, path: &str) -> String {
        match self.directory {
            "" => path.to_owned(),
            directory => format!("{directory}/{path}"),
        }
    }

    fn read(&self, path: &str) -> String {
        self.project.read(&self.path(path))
    }

    fn write(&self, path: &str, text: &str) {
        self.project.write(&self.path(path), text);
    }

    /// Commits the staged files. Returns `true` on success, and the output.
    fn commit(&self, options: &[&str]) -> (bool, String) {
        let commit = ["commit", "--quiet", "--message", "A change"];
        run_git(&self.project, &[&commit, options].concat())
    }
}

const PLACES: [&str; 2] = ["", "below/it's a lamp"];

#[test]
fn broken_staged_file_stops_a_commit() {
    for place in PLACES {
        for (old, new, message) in [
            ("effect: config", "effect: konfig", "FC0109"),
            ("effect: config", "effect:  config", "light.yaml"),
            ("en: Set the light", "en: Set the lamp", "stale"),
        ] {
            let repository = Repository::new(place);
            let good = repository.read(LIGHT);
            assert!(good.contains(old), "{good}");
            repository.write(LIGHT, &good.replacen(old, new, 1));
            repository.git(&["add", "--all"]);
            repository.write(LIGHT, &good);
            repository.fc(&["check"]).expect(0);
            let (is_committed, said) = repository.commit(&[]);
            assert!(!is_committed, "{place}: {new}");
            assert!(said.contains(message), "{place}: {said}");
            // Messages do not name the temporary copy.
            assert!(!said.contains("fcproto-"), "{said}");
            // A commit of named paths uses a separate index.
            let path = repository.path(LIGHT);
            let (is_committed, said) = repository.commit(&["--", &path]);
            assert!(is_committed || said.contains("nothing"), "{said}");
        }
    }
}

#[test]
fn unstaged_changes_stop_no_commit() {
    for place in PLACES {
        let repository = Repository::new(place);
        let good = repository.read(LIGHT);
        repository.write("README.md", "# Mine\n");
        repository.git(&["add", "--all"]);
        repository.write(LIGHT, &good.replace("effect: config", "effect: konfig"));
        repository.write("spec/commands/mine.yaml", "not yet");
        repository.write("spec/commands/intended.yaml", "not yet");
        let intended = repository.path("spec/commands/intended.yaml");
        repository.git(&["add", "--intent-to-add", &intended]);
        let (is_committed, said) = repository.commit(&[]);
        assert!(is_committed, "{place}: {said}");
        // A commit that includes the change fails.
        let (is_committed, said) = repository.commit(&["--all"]);
        assert!(!is_committed, "{place}: {said}");
    }
}

#[test]
fn untracked_file_of_the_spec_is_missed() {
    let repository = Repository::new("");
    let good = repository.read(LIGHT);
    let (before, types) = good.split_once("\ntypes:\n").expect("types");
    repository.write(LIGHT, before);
    repository.write("spec/types.yaml", &format!("types:\n{types}"));
    repository.fc(&["fmt"]).expect(0);
    repository.fc(&["generate"]).expect(0);
    repository.git(&["add", "--update"]);
    let (is_committed, said) = repository.commit(&[]);
    assert!(!is_committed && said.contains("Mood"), "{said}");
    repository.git(&["add", "--all"]);
    let (is_committed, said) = repository.commit(&[]);
    assert!(is_committed, "{said}");
}

/// Commits do not contain ignored files, so the check uses those of the working tree.
#[test]
fn ignored_generated_files_are_copied() {
    let repository = Repository::new("");
    let ignored = repository.read(".gitignore") + "/vectors/\n/fc-manifest.json\n";
    repository.write(".gitignore", &ignored);
    repository.git(&[
        "rm",
        "-r",
        "--quiet",
        "--cached",
        "vectors",
        "fc-manifest.json",
    ]);
    repository.git(&["add", "--all"]);
    let (is_committed, said) = repository.commit(&[]);
    assert!(is_committed, "{said}");
}

#[test]
fn commit_without_a_project_passes() {
    let repository = Repository::new("below/it's a lamp");
    repository.git(&["rm", "-r", "--quiet", "--cached", "below"]);
    let (is_committed, said) = repository.commit(&[]);
    assert!(is_committed, "{said}");
}

/// Git runs a hook with the paths of the main repository in its environment.
#[test]
fn linked_working_tree_is_checked() {
    let repository = Repository::new("below/it's a lamp");
    let tree = Project::empty();
    let path = tree.path("tree");
    let path = path.to_str().expect("UTF-8");
    repository.git(&["worktree", "add", "--quiet", "-b", "other", path]);
    let light = format!("tree/below/it's a lamp/{LIGHT}");
    let good = tree.read(&light);
    let bad = good.replace("effect: config", "effect: konfig");
    for (staged, later, passes) in [(&bad, &good, false), (&good, &bad, true)] {
        tree.write(&light, staged);
        tree.write("tree/other.txt", staged);
        git(&tree, &["-C", "tree", "add", "--all"]);
        tree.write(&light, later);
        let commit = ["-C", "tree", "commit", "--quiet", "--message", "A change"];
        let (is_committed, said) = run_git(&tree, &commit);
        assert_eq!(is_committed, passes, "{said}");
    }
}
