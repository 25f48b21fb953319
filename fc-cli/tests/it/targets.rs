//! Projects with an `fc.yaml`.

#![cfg(unix)]

use std::os::unix::fs::PermissionsExt as _;
use std::path::Path;
use std::process::Command;

use crate::support::Project;

/// Creates a project with this `fc.yaml` and its spec in `protocol/`.
fn project(targets: &str) -> Project {
    let project = Project::new();
    std::fs::rename(project.path("spec"), project.path("protocol")).expect("moved");
    project.write("fc.yaml", &format!("spec: protocol\ntargets:\n{targets}"));
    project
}

fn program(project: &Project, path: &str, text: &str) {
    project.write(path, text);
    let all = std::fs::Permissions::from_mode(0o755);
    std::fs::set_permissions(project.path(path), all).expect("its mode");
}

#[test]
fn project_is_found_from_a_subdirectory() {
    let project = project("  vectors: { out: golden }\n");
    project.write("some/where/note.txt", "");
    project.fc_in("some/where", &["check"]).expect(0);
    let run = project.fc_in("some/where", &["generate"]).expect(0);
    assert!(run.stdout.contains("golden/frames.json\n"), "{run:#?}");
    assert!(project.path("golden/frames.json").is_file());
    assert!(!project.path("fc-generated").exists());
    project.fc(&["generate", "--check"]).expect(0);

    // Files of removed targets disappear.
    project.write(
        "fc.yaml",
        "spec: protocol\ntargets: { schema: { out: schema } }\n",
    );
    let run = project.fc(&["generate"]).expect(0);
    assert!(run.stdout.contains("removed "), "{run:#?}");
    assert!(!project.path("golden/frames.json").exists());
    assert!(project.path("schema/fc-spec.schema.json").is_file());
}

#[test]
fn errors_of_the_settings_have_places_and_suggestions() {
    let project = project(
        "  rust: { ouut: here, timeout_ms: 0 }\n  typescrip: { languages: [fr] }\n  schema: { audience: nobody }\n",
    );
    let run = project.fc(&["check"]).expect(2);
    for text in [
        "error[FC0101]: `ouut` is not a key of the target",
        "--> fc.yaml:3:11",
        "did you mean `out`?",
        "error[FC0108]: ",
        "error[FC0109]: `fr` is not allowed here",
    ] {
        assert!(run.stderr.contains(text), "{text}: {run:#?}");
    }
    project.write(
        "fc.yaml",
        "spec: protocol\ntargets:\n  typescrip:\n  schema: { audience: nobody }\n",
    );
    let run = project.fc(&["check", "--lang", "zh"]).expect(2);
    for text in [
        "没有产物 `typescrip`",
        "是否为 `typescript`？",
        "目标 `schema` 不能有 `audience`",
        "--> fc.yaml:4:13",
    ] {
        assert!(run.stderr.contains(text), "{text}: {run:#?}");
    }
}

#[test]
fn plugin_gets_model_and_options_and_writes_files() {
    let project = project("  mine: { plugin: tools/mine, out: made, options: { word: hello } }\n");
    program(
        &project,
        "tools/mine",
        "#!/bin/sh\ncat > asked.json\n\
         grep -o '\"options\":{\"word\":\"hello\"}' asked.json >&2\n\
         printf '%s' '[{\"path\": \"a/b.txt\", \"contents\": \"one\\n\"}]'\n",
    );
    let run = project.fc(&["generate"]).expect(0);
    assert!(run.stdout.contains("made/a/b.txt\n"), "{run:#?}");
    assert_eq!(run.stderr, "\"options\":{\"word\":\"hello\"}\n");
    assert_eq!(project.read("made/a/b.txt"), "one\n");
    project.fc(&["generate", "--check"]).expect(0);
    // The plugin has received a dump.
    project
        .fc(&["generate", "--check", "--from", "asked.json"])
        .expect(0);

    project.write("made/a/b.txt", "two\n");
    let run = project
        .fc(&["generate", "--check", "--only", "mine"])
        .expect(1);
    assert!(run.stdout.contains("\n-two\n+one\n"), "{run:#?}");
}

#[test]
fn a_plugin_that_fails_leaves_everything_as_it_was() {
    let project = project("  schema: { out: made }\n  mine: { plugin: ./mine, out: made }\n");
    for (script, message) in [
        (
            "#!/bin/sh\ncat > /dev/null\necho no luck >&2\nexit 3\n",
            "cannot generate the target `mine` with `./mine`: exit status 3",
        ),
        (
            "#!/bin/sh\ncat > /dev/null\necho '{}'\n",
            "`./mine` did not answer with a list of { path, contents } for the target `mine`: ",
        ),
        (
            "#!/bin/sh\nexit 0\n",
            "`./mine` did not answer with a list of { path, contents } for the target `mine`: ",
        ),
        (
            "#!/bin/sh\ncat > /dev/null\necho '[{\"path\": \"../x\", \"contents\": \"\"}]'\n",
            "`made/../x` cannot be written: it must not contain `.` or `..`",
        ),
    ] {
        program(&project, "mine", script);
        let run = project.fc(&["generate"]).expect(2);
        assert!(run.stderr.contains(message), "{run:#?}");
        assert!(!project.path("made").exists());
        assert!(!project.path("fc-manifest.json").exists());
    }
    std::fs::remove_file(project.path("mine")).expect("removed");
    let run = project.fc(&["generate"]).expect(2);
    assert!(
        run.stderr
            .contains("cannot generate the target `mine` with `./mine`: No such file"),
        "{run:#?}"
    );
}

/// A plugin without `/` in its name is a program on the `PATH`, not a file of the project.
#[test]
fn a_plugin_may_be_a_program_of_the_system() {
    let project = project("  mine: { plugin: cat, out: made }\n");
    program(&project, "cat", "#!/bin/sh\ncat > /dev/null\necho '[]'\n");
    // `cat` returns its input, which is a dump and not a list.
    let run = project.fc(&["generate"]).expect(2);
    assert!(
        run.stderr.contains(
            "`cat` did not answer with a list of { path, contents } for the target `mine`: "
        ),
        "{run:#?}"
    );
    assert!(!project.path("fc-manifest.json").exists());
}

/// Uses the plugin and the `fc.yaml` of the guide.
#[test]
fn the_plugin_of_the_guide_makes_a_header() {
    if Command::new("python3").arg("--version").output().is_err() {
        assert!(std::env::var_os("CI").is_none(), "python3 is not there");
        println!("skipped: python3 is not there");
        return;
    }
    let project = Project::new();
    let guide = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs-site/guides/targets");
    for name in ["fc.yaml", "codes.py"] {
        std::fs::copy(guide.join(name), project.path(name)).expect("a file of the guide");
    }
    project.fc(&["generate"]).expect(0);
    assert!(project.path("protocol/src/lib.rs").is_file());
    assert!(project.path("protocol/vectors/frames.json").is_file());
    assert!(project.path("docs/en/reference/index.md").is_file());
    let header = project.read("firmware/codes.h");
    assert!(
        header.contains("#ifndef FC_CODES_H\n#define FC_CODES_H\n"),
        "{header}"
    );
    assert!(header.matches("#define FC_").count() > 2, "{header}");
}

#[test]
fn names_are_free_in_the_languages_of_the_targets() {
    let command = "group: { id: doors, zh: 门, en: Doors }\n\
         commands:\n  \
         open_doors:\n    code: unassigned\n    zh: 开门\n    en: Open the doors\n    effect: motion\n    \
         source: { sections: [] }\n    request:\n      \
         door1: { type: bool, zh: 门一, en: Door one }\n      \
         door_1: { type: bool, zh: 门二, en: Door two }\n";
    let plugin = "  mine: { plugin: ./mine, out: made, names: kotlin }\n";
    for (targets, status) in [(plugin, 1), ("  rust: { out: made }\n", 0)] {
        let project = project(targets);
        project.write("protocol/commands/doors.yaml", command);
        let run = project.fc(&["check"]).expect(status);
        let message = "two names are both `door1` in Kotlin";
        assert_eq!(run.stderr.contains(message), status == 1, "{run:#?}");
        assert_eq!(
            run.stderr.contains("first used here"),
            status == 1,
            "{run:#?}"
        );
    }

    let project = project("  rust: { out: made }\n");
    project.write(
        "protocol/commands/doors.yaml",
        &command
            .replace("door1: { type: bool,", "door1: { type: Option,")
            .replace("      door_1: { type: bool, zh: 门二, en: Door two }\n", "types:\n  Option: { enum: u8, zh: 选项, en: Option, values: { 0: { name: idle, zh: 关, en: Inactive } } }\n"),
    );
    let run = project.fc(&["generate"]).expect(1);
    let message = "`Option` already has a meaning in Rust";
    assert!(run.stderr.contains(message), "{run:#?}");

    // A dump of a project without a Rust target may contain such names.
    project.write(
        "fc.yaml",
        "spec: protocol\ntargets: { vectors: { out: made } }\n",
    );
    let dump = project.fc(&["inspect"]).expect(0).stdout;
    project.write("model.json", &dump);
    project.write(
        "fc.yaml",
        "spec: protocol\ntargets: { rust: { out: made } }\n",
    );
    let run = project.fc(&["generate", "--from", "model.json"]).expect(2);
    assert!(
        run.stderr
            .contains("`model.json`: `enum Option` cannot be called `Option` in Rust"),
        "{run:#?}"
    );

    let wrong = "  mine: { plugin: ./mine, out: made, names: cobol }\n";
    project.write("fc.yaml", &format!("targets:\n{wrong}"));
    let run = project.fc(&["check"]).expect(2);
    assert!(
        run.stderr.contains("no programming language `cobol`") && run.stderr.contains("`kotlin`"),
        "{run:#?}"
    );
}

/// The path of a plugin is relative to the project, wherever the command runs.
#[test]
fn plugin_path_is_relative_to_the_project() {
    let script = "#!/bin/sh\ncat > /dev/null\necho '[]'\n";
    let project = project("  mine: { plugin: ./mine, out: made }\n");
    program(&project, "mine", script);
    let name = project.path("");
    let name = name.file_name().and_then(|name| name.to_str());
    let name = name.expect("the name of the project");
    std::fs::create_dir_all(project.path("below")).expect("a directory");
    for (directory, root) in [
        ("", "."),
        ("below", ".."),
        ("..", name),
        ("..", &format!("./{name}/below/..")),
    ] {
        let run = project.fc_in(directory, &["generate", "--root", root]);
        run.expect(0);
    }
}

/// The children of a plugin keep its output open. They must end too.
#[test]
fn hanging_plugin_ends_with_its_children() {
    let scripts = [
        // The plugin waits, its child waits, or the plugin ends before its child.
        ("en", "exec sleep 1000"),
        ("zh", "sleep 1000 & wait"),
        ("en", "sleep 1000 &"),
        ("zh", "cat > /dev/null; echo '[]'; sleep 1000 &"),
    ];
    for (lang, script) in scripts {
        let target = "  mine: { plugin: ./mine, out: made, timeout_ms: 1000 }\n";
        let project = project(target);
        let script = format!("#!/bin/sh\necho $$ > group\n{script}\n");
        program(&project, "mine", &script);
        let message = match lang {
            "zh" => "无法由 `./mine` 生成目标 `mine`：运行时间超过 `timeout_ms: 1000`",
            _ => {
                "cannot generate the target `mine` with `./mine`: it runs longer than `timeout_ms: 1000`"
            }
        };
        let run = project.fc(&["generate", "--lang", lang]).expect(2);
        assert!(run.stderr.contains(message), "{run:#?}");
        let group = project.read("group");
        assert!(!is_running(group.trim()), "{script}");
        assert!(!project.path("made").exists());
    }
}

/// Returns `true` if a process of this group runs. An ended process may remain as a zombie.
fn is_running(group: &str) -> bool {
    let output = Command::new("ps")
        .args(["-e", "-o", "pgid=,stat="])
        .output();
    let output = output.expect("ps can be run").stdout;
    let lines = String::from_utf8_lossy(&output).into_owned();
    lines.lines().any(|line| {
        let mut words = line.split_whitespace();
        words.next() == Some(group) && words.next().is_some_and(|it| !it.starts_with('Z'))
    })
}

#[test]
fn the_output_of_a_plugin_is_limited() {
    let project = project("  mine: { plugin: ./mine, out: made, output_bytes: 20 }\n");
    let start = "#!/bin/sh\ncat > /dev/null\n";
    program(&project, "mine", &format!("{start}exec yes\n"));
    for (lang, message) in [
        ("en", "its output is larger than `output_bytes: 20`"),
        ("zh", "输出超过 `output_bytes: 20`"),
    ] {
        let run = project.fc(&["generate", "--lang", lang]).expect(2);
        assert!(run.stderr.contains(message), "{run:#?}");
    }
    // This output has exactly the largest allowed length.
    program(&project, "mine", &format!("{start}printf '[%18s]' ''\n"));
    project.fc(&["generate"]).expect(0);
    program(&project, "mine", &format!("{start}printf '[%19s]' ''\n"));
    project.fc(&["generate"]).expect(2);
}

#[test]
fn plugin_limits_have_bounds() {
    for (key, most) in [("timeout_ms", 3_600_000_u64), ("output_bytes", 1 << 30)] {
        for (value, status) in [(0, 2), (1, 0), (most, 0), (most + 1, 2)] {
            let target = format!("  mine: {{ plugin: cat, out: made, {key}: {value} }}\n");
            let run = project(&target).fc(&["check"]).expect(status);
            let message = format!("{value} is outside 1..={most}");
            assert_eq!(run.stderr.contains(&message), status == 2, "{run:#?}");
        }
        let run = project(&format!("  schema: {{ {key}: 1 }}\n")).fc(&["check"]);
        let message = format!("`schema` cannot have `{key}`");
        assert!(run.expect(2).stderr.contains(&message));
    }
}

#[test]
fn errors_of_the_settings_are_chinese_in_chinese_runs() {
    for (targets, message) in [
        ("  rust: { ouut: here }\n", "--> fc.yaml:3:11"),
        ("  rust: { ouut: here }\n", "“目标”没有键 `ouut`"),
        (
            "  rust: { newtypes: often }\n",
            "应为 `true` 或 `false`，实际为 `often`",
        ),
        ("  rust: [out]\n", "应为“目标”映射，实际为列表"),
        ("  rust: { out: a, out: b }\n", "键 `out` 出现两次"),
        ("  markdown: { languages: [de] }\n", "这里不能写 `de`"),
        (
            "  x: { plugin: a, out: z, names: kotln }\n",
            "语言有：`rust`、",
        ),
        ("  rust: { out: a\n", "`{` 没有闭合"),
        ("  rust: \"a\n", "引号没有闭合"),
        ("  rust: *a\n", "别名 `*a`"),
    ] {
        let run = project(targets).fc(&["check", "--lang", "zh"]).expect(2);
        assert!(run.stderr.contains(message), "{run:#?}");
    }
}
