//! Projects with texts in one language only.

use crate::support::Project;

/// Creates the small spec without its Chinese texts.
fn english() -> Project {
    let project = Project::new();
    for (path, _) in project.files("spec") {
        let text = std::fs::read_to_string(&path).expect("a file of the spec");
        std::fs::write(&path, without_chinese(&text)).expect("written");
    }
    project
}

fn without_chinese(text: &str) -> String {
    let indent = |line: &str| line.len() - line.trim_start().len();
    let mut kept = String::new();
    let mut lines = text.lines().peekable();
    while let Some(line) = lines.next() {
        if line.trim_start().starts_with("zh: ") && !line.contains("en: ") {
            let is_inside = |next: &&str| next.trim().is_empty() || indent(next) > indent(line);
            while lines.next_if(is_inside).is_some() {}
            continue;
        }
        let mut parts = line.split("zh: ");
        kept += parts.next().unwrap_or_default();
        for part in parts {
            let (_, english) = part.split_once("en: ").expect("both languages");
            kept.extend(["en: ", english]);
        }
        kept += "\n";
    }
    kept
}

#[test]
fn texts_of_one_language_are_enough() {
    let project = english();
    let run = project.fc(&["check"]).expect(1);
    assert!(run.stderr.contains("FC0601"), "{run:#?}");

    project.write("fc.yaml", "languages: [en]\n");
    project.fc(&["check"]).expect(0);
    project.fc(&["lint"]).expect(0);
    project.fc(&["fmt"]).expect(0);
    project.fc(&["check"]).expect(0);
    project.fc(&["generate"]).expect(0);
    assert!(project.path("docs-site/en/reference").is_dir());
    assert!(!project.path("docs-site/reference/wire.md").exists());
    let schema = project.read("spec/fc-spec.schema.json");
    assert!(!schema.contains("\"zh\",\n"), "a schema that requires `zh`");

    // A text in another language is allowed, but does not replace a required one.
    project.write("fc.yaml", "languages: [zh]\n");
    let run = project.fc(&["check"]).expect(1);
    assert!(run.stderr.contains("the Chinese text `zh` of"), "{run:#?}");
    assert!(!run.stderr.contains("the English text"), "{run:#?}");
}

#[test]
fn commands_write_texts_of_the_languages() {
    let project = english();
    project.write("fc.yaml", "languages: [en]\n");
    project
        .fc(&["new", "ring_bell", "--group", "lamp"])
        .expect(0);
    let all: String = project
        .files("spec/commands")
        .iter()
        .map(|(path, _)| std::fs::read_to_string(path).expect("a file of the spec"))
        .collect();
    assert!(all.contains("en: (to be written, what it does)"));
    assert!(!all.contains("zh:"), "a Chinese text");

    let run = project.fc(&["retire", "ring_bell"]).expect(2);
    assert!(run.stderr.contains("`--en` is missing"), "{run:#?}");
    project
        .fc(&["retire", "ring_bell", "--en", "Too loud"])
        .expect(0);

    project.fc(&["release", "2099.1"]).expect(0);
    assert!(project.path("spec/releases/CHANGELOG.en.md").is_file());
    assert!(!project.path("spec/releases/CHANGELOG.md").exists());
    project.fc(&["diff"]).expect(0);
}

#[test]
fn a_project_has_a_language() {
    let project = Project::new();
    project.write("fc.yaml", "languages: []\n");
    let run = project.fc(&["check"]).expect(2);
    assert!(
        run.stderr.contains("expected at least 1, found 0"),
        "{run:#?}"
    );
}
