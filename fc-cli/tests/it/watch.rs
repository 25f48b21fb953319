//! `fcproto generate --watch`. The tests react to its output and never wait for a fixed time.

#![cfg(unix)]

use crate::support;
use std::io::{BufRead as _, BufReader, Read};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

use crate::support::Project;

const LAMP: &str = "spec/commands/lamp.yaml";
/// The line that the command prints after its work.
const WAITING: &str = "waiting for changes; Ctrl-C ends";
/// The time after which a missing line fails the test.
const PATIENCE: Duration = Duration::from_secs(120);

/// The running command, and the lines of both output streams.
struct Watch {
    child: Child,
    lines: Receiver<String>,
    complaints: Receiver<String>,
}

impl Watch {
    fn begin(project: &Project, args: &[&str]) -> Self {
        let args = [&["generate", "--watch", "--only", "schema,vectors"], args].concat();
        let mut child = support::command(&args)
            .current_dir(project.path(""))
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the command can be run");
        let lines = lines_of(child.stdout.take().expect("its output"));
        let complaints = lines_of(child.stderr.take().expect("its other output"));
        Self {
            child,
            lines,
            complaints,
        }
    }

    /// Returns the output up to the next wait.
    fn round(&self) -> String {
        let mut said = String::new();
        loop {
            let line = self.lines.recv_timeout(PATIENCE).expect("another line");
            if line == WAITING {
                return said;
            }
            said += &(line + "\n");
        }
    }

    /// Reads the output until a line contains `wanted`.
    fn until(&self, wanted: &str) {
        until(&self.lines, wanted);
    }

    /// Reads the errors until a line contains `wanted`.
    fn complains(&self, wanted: &str) {
        until(&self.complaints, wanted);
    }

    /// Sends Ctrl-C and returns the exit status.
    fn interrupt(mut self) -> Option<i32> {
        let id = self.child.id().to_string();
        let sent = Command::new("kill").args(["-INT", &id]).status();
        assert!(sent.is_ok_and(|sent| sent.success()));
        self.child.wait().expect("its end").code()
    }
}

/// Returns the lines of a stream as they arrive.
fn lines_of(stream: impl Read + Send + 'static) -> Receiver<String> {
    let (sender, lines) = channel();
    std::thread::spawn(move || {
        for line in BufReader::new(stream).lines().map_while(Result::ok) {
            if sender.send(line).is_err() {
                return;
            }
        }
    });
    lines
}

fn until(lines: &Receiver<String>, wanted: &str) {
    loop {
        let line = lines.recv_timeout(PATIENCE).expect(wanted);
        if line.contains(wanted) {
            return;
        }
    }
}

/// Saves a file as many editors do: it writes a new file and renames it, so that readers never see half of it.
fn save(project: &Project, path: &str, text: &str) {
    project.write("elsewhere", text);
    std::fs::rename(project.path("elsewhere"), project.path(path)).expect("renamed");
}

#[test]
fn watch_generates_after_each_change_until_ctrl_c() {
    let project = Project::new();
    let watch = Watch::begin(&project, &[]);
    let said = watch.round();
    assert!(said.contains("created "), "{said}");
    assert!(project.path("spec/fc-spec.schema.json").is_file());

    // The files that the command wrote into `spec` do not count as a change. The next change is the one below.
    let lamp = project.read(LAMP);
    save(&project, LAMP, &lamp.replace("0x0104", "0x0109"));
    let said = watch.round();
    assert!(
        said.starts_with(&format!("\nchanged    {LAMP}\nread ")),
        "{said}"
    );
    assert!(said.contains("updated    1 file\n"), "{said}");

    // A comment changes no generated file. The change is reported as one line.
    project.append("spec/types.yaml", "# A remark.\n");
    let said = watch.round();
    assert!(said.contains("changed    spec/types.yaml\n"), "{said}");
    assert!(!said.contains("updated"), "{said}");

    assert_eq!(watch.interrupt(), Some(0));
}

#[test]
fn faults_are_shown_and_it_goes_on() {
    let project = Project::new();
    let lamp = project.read(LAMP);
    save(&project, LAMP, &lamp.replace("type: ", "tyype: "));
    let watch = Watch::begin(&project, &[]);
    watch.complains("error[FC0101]");
    watch.until(WAITING);
    save(&project, LAMP, &lamp);
    watch.until("created ");
    watch.until(WAITING);
    save(&project, "fc.yaml", "targets: { schemaa: {} }\n");
    watch.until("new        fc.yaml");
    watch.complains("schemaa");
    watch.until(WAITING);
    save(
        &project,
        "fc.yaml",
        "targets: { schema: { out: schema }, vectors: { out: golden } }\n",
    );
    watch.until("changed    fc.yaml");
    watch.until("golden/");
    watch.until(WAITING);
    assert_eq!(watch.interrupt(), Some(0));
}

#[test]
fn files_and_the_directory_go_and_come_back() {
    let project = Project::new();
    let watch = Watch::begin(&project, &[]);
    watch.round();
    let (spec, away) = (project.path("spec"), project.path("away"));
    std::fs::rename(project.path(LAMP), project.path("spec/commands/light.yaml")).expect("renamed");
    let said = watch.round();
    for line in [
        "new        spec/commands/light.yaml\n",
        &format!("gone       {LAMP}\n"),
    ] {
        assert!(said.contains(line), "{said}");
    }
    std::fs::rename(&spec, &away).expect("renamed");
    watch.until("gone       spec/types.yaml");
    watch.until(WAITING);
    std::fs::rename(&away, &spec).expect("renamed");
    watch.until("new        spec/types.yaml");
    watch.until(WAITING);
    // The new directory is watched again.
    std::fs::remove_file(project.path("spec/types.yaml")).expect("removed");
    watch.until("gone       spec/types.yaml");
    watch.complains("error");
    watch.until(WAITING);
    assert_eq!(watch.interrupt(), Some(0));
}

#[test]
fn watch_follows_the_spec_directory() {
    let project = Project::new();
    let at = |spec: &str| {
        format!(
            "spec: {spec}\ntargets: {{ schema: {{ out: schema }}, vectors: {{ out: golden }} }}\n"
        )
    };
    std::fs::create_dir_all(project.path("deep/down")).expect("a directory");
    support::copy(&project.path("spec"), &project.path("deep/down/other"));
    save(&project, "fc.yaml", &at("spec"));
    let watch = Watch::begin(&project, &[]);
    watch.round();
    save(&project, "fc.yaml", &at("deep/down/other"));
    watch.until("gone       spec/types.yaml");
    watch.until(WAITING);
    project.append("deep/down/other/types.yaml", "# A remark.\n");
    watch.until("changed    deep/down/other/types.yaml");
    watch.until(WAITING);
    assert_eq!(watch.interrupt(), Some(0));
}

#[test]
fn watch_with_other_options_is_wrong_usage() {
    let project = Project::new();
    for other in ["--check", "--from=model.json"] {
        let run = project.fc(&["generate", "--watch", other]).expect(2);
        assert!(run.stderr.contains("--watch"), "{run:#?}");
    }
    let run = Project::empty().fc(&["generate", "--watch"]).expect(2);
    assert!(run.stderr.contains("no `fc.yaml`"), "{run:#?}");
}
