//! The command in a shell: completions, manual pages, quiet output and exit statuses.

use std::io::ErrorKind;
use std::process::Command;

use crate::support::{Project, Run, command, path_to_command};

/// Words of a command line, and the completions of the last one.
const CASES: &[(&[&str], &[&str])] = &[
    (&["call", "get_l"], &["get_level"]),
    (&["encode", "get_l"], &["get_level"]),
    (&["decode", "--name", "get_l"], &["get_level"]),
    (&["call", "no_such", "k"], &[]),
    (&["call", "set_level", "data.la"], &["data.label="]),
    (
        &["call", "set_level", "data.level=1", "data.la"],
        &["data.label="],
    ),
    (&["call", "set_level", "data.armed=t"], &["data.armed=true"]),
    // Bash splits the words at `=`.
    (&["call", "set_level", "data.armed", ""], &["true", "false"]),
    (&["call", "set_level", "data.armed", "=", "t"], &["true"]),
    (
        &["call", "set_level", "data.level", "=", "1", "data.la"],
        &["data.label="],
    ),
];

/// Returns the commands that the help lists.
fn commands(project: &Project) -> Vec<String> {
    let help = project.fc(&["--help"]).expect(0).stdout;
    let (_, list) = help.split_once("Commands:\n").expect("a list");
    let lines = list.lines().take_while(|line| !line.is_empty());
    let names = lines.filter_map(|line| line.strip_prefix("  ")?.split(' ').next());
    let names = names.filter(|name| !name.is_empty() && *name != "help");
    names.map(str::to_owned).collect()
}

#[test]
fn each_shell_has_a_script() {
    let project = Project::empty();
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let script = project.fc(&["completions", shell]).expect(0).stdout;
        assert!(script.contains("fcproto"), "{shell}: {script}");
    }
    let unknown = project.fc(&["completions", "tcsh"]).expect(2);
    assert!(unknown.stderr.contains("bash"), "{unknown:#?}");
}

/// Returns the completions of the last word.
fn completed(project: &Project, words: &[&str]) -> Vec<String> {
    let output = command(&[&["--", "fcproto"], words].concat())
        .env("COMPLETE", "zsh")
        .env("_CLAP_COMPLETE_INDEX", words.len().to_string())
        .env("_CLAP_IFS", "\n")
        .current_dir(project.path(""))
        .output();
    let run = Run::new(&output.expect("the command can be run")).expect(0);
    let lines = run.stdout.lines().map(|line| line.split(':').next());
    lines.flatten().map(str::to_owned).collect()
}

#[test]
fn words_are_completed_by_the_spec() {
    let project = Project::new();
    let all = commands(&project);
    let mut found = completed(&project, &[""]);
    found.retain(|word| !word.starts_with('-') && word != "help");
    found.sort();
    let mut sorted = all.clone();
    sorted.sort();
    assert_eq!(found, sorted);
    for (words, expected) in CASES {
        let mut found = completed(&project, words);
        found.retain(|word| !word.starts_with('-'));
        assert_eq!(found, *expected, "{words:?}");
    }
    // With a broken spec there are no completions.
    project.write("spec/types.yaml", "types: [");
    assert!(completed(&project, &["call", "get_l"]).is_empty());
}

#[test]
fn each_command_has_a_manual_page() {
    let project = Project::empty();
    let run = project.fc(&["man", "share/man1"]).expect(0);
    let commands = commands(&project);
    let pages = project.files("share/man1").len();
    assert_eq!(run.stdout, format!("wrote {pages} pages in share/man1\n"));
    // `fcproto git` has subcommands with pages.
    assert!(pages > commands.len() + 1, "{pages}");
    for command in commands {
        let page = project.read(&format!("share/man1/fcproto-{command}.1"));
        assert!(page.contains(".SH SYNOPSIS"), "{command}");
    }
    assert!(project.read("share/man1/fcproto.1").contains("EXTRA"));
    project.write("file", "");
    let run = project.fc(&["man", "file"]).expect(2);
    assert!(run.stderr.contains("cannot write `file`"), "{run:#?}");
}

#[test]
fn quiet_prints_errors_and_results() {
    let project = Project::new();
    for call in [
        &["-q", "check"][..],
        &["generate", "--quiet"],
        &["generate", "--check", "-q"],
        &["new", "added", "--group", "lamp", "-q"],
        &["fmt", "-q"],
    ] {
        let run = project.fc(call).expect(0);
        assert_eq!(
            (run.stdout.as_str(), run.stderr.as_str()),
            ("", ""),
            "{call:?}"
        );
    }
    // The new command has texts that are still placeholders.
    let run = project.fc(&["check", "-q"]).expect(0);
    assert_eq!(run.stdout, "");
    assert!(run.stderr.contains("warning"), "{run:#?}");
    let run = project.fc(&["generate", "--check", "-q"]).expect(1);
    assert!(run.stdout.contains("@@"), "{run:#?}");
    let map = project.fc(&["codes", "-q"]).expect(0);
    assert!(map.stdout.contains("added"), "{map:#?}");
}

#[test]
fn denied_warnings_change_the_status() {
    let project = Project::new();
    let deny = ["check", "--deny", "warnings"];
    project.fc(&deny).expect(0);
    project.fc(&["new", "added", "--group", "lamp"]).expect(0);
    project.fc(&["check"]).expect(0);
    for format in ["text", "json", "sarif", "github"] {
        let run = project.fc(&[&deny[..], &["--format", format]].concat());
        run.expect(1);
    }
}

/// Runs a script in a project with the command on the `PATH`. Returns `None` if the shell is not installed.
fn script(shell: &str, project: &Project, text: &str) -> Option<Run> {
    let output = Command::new(shell)
        .args(["-c", text])
        .env("PATH", path_to_command())
        .env("LC_ALL", "C")
        // The user's start-up files must not run.
        .env("ZDOTDIR", project.path(""))
        .env_remove("BASH_ENV")
        .env_remove("ENV")
        .current_dir(project.path(""))
        .output();
    match output {
        Ok(output) => Some(Run::new(&output)),
        Err(error) if error.kind() == ErrorKind::NotFound => None,
        Err(error) => panic!("{shell}: {error}"),
    }
}

#[test]
fn bash_completes_a_call() {
    const SCRIPT: &str = r#"
        source <(fcproto completions bash)
        COMP_WORDS=(fcproto call set_level data.armed = t) COMP_CWORD=5
        _clap_complete_fcproto fcproto t =
        echo "${COMPREPLY[@]}"
    "#;
    let run = script("bash", &Project::new(), SCRIPT).expect("there is a bash");
    assert_eq!(run.expect(0).stdout, "true\n");
}

/// A shell prefers its built-in commands: `fc check` succeeds in bash, whatever the spec contains.
#[test]
fn no_script_goes_past_a_broken_spec() {
    const SCRIPT: &str = "set -e; fcproto check; echo reached";
    let good = Project::new();
    let broken = Project::new();
    let types = broken.read("spec/types.yaml");
    broken.write("spec/types.yaml", &types.replacen("unit:", "unti:", 1));
    for shell in ["bash", "zsh", "sh"] {
        let Some(run) = script(shell, &broken, SCRIPT) else {
            assert!(
                std::env::var_os("FC_CI").is_none(),
                "there is no {shell} here"
            );
            println!("skipped: {shell} is not there");
            continue;
        };
        let run = run.expect(1);
        assert!(run.stderr.contains("unti"), "{shell}: {run:#?}");
        assert!(!run.stdout.contains("reached"), "{shell}: {run:#?}");
        let run = script(shell, &good, SCRIPT).expect("the same shell");
        let run = run.expect(0);
        assert!(run.stdout.ends_with("reached\n"), "{shell}: {run:#?}");
    }
}
