//! Runs programs that generate targets.

mod group;

use std::io::{self, Write as _};
use std::path::Path;
use std::process::{Command, ExitStatus, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread;
use std::time::Instant;

use fc_codegen::inspect;
use fc_codegen::product::Artifact;
use fc_codegen::target::{Plugin, part};
use fc_spec::model::{Model, Text};
use fc_spec::text;

use crate::input::up_to;
use crate::lang::said;
use crate::outcome::Failure;
use group::Group;

/// Ends the running plugin and its children.
pub fn end() {
    group::end_running();
}

/// Runs the program of a target in the project's root and takes its files.
///
/// The program reads the output of `fcproto inspect` from standard input: the part of the target's audience, with the
/// target's `options` as an additional key. Its standard error goes to the user. A program that exceeds its time or its
/// output is ended with its children.
pub fn run(plugin: &Plugin, model: &Model, root: &Path) -> Result<Vec<Artifact>, Failure> {
    let (program, target) = (&plugin.program, &plugin.name);
    let model = part(model, plugin.audience.as_deref())?;
    let question = inspect::json_with(&model, &plugin.options);
    let answer = ask(plugin, question, root).map_err(|why| {
        said!(
            "无法由 `{program}` 生成目标 `{target}`：{why}",
            "cannot generate the target `{target}` with `{program}`: {why}",
            why = why
        )
    })?;
    plugin.artifacts(&answer).map_err(|error| {
        said!(
            "`{program}` 为目标 `{target}` 返回的不是 {{ path, contents }} 的列表：{error}",
            "`{program}` did not answer with a list of {{ path, contents }} for the target `{target}`: {error}"
        )
        .into()
    })
}

/// An event of a running program.
enum Event {
    /// The program closed its output, or exceeded the size limit.
    Answer(io::Result<Option<Vec<u8>>>),
    /// The program ended.
    End(io::Result<ExitStatus>),
}

/// Returns what the program prints, or why there is nothing to take.
fn ask(plugin: &Plugin, question: String, root: &Path) -> Result<Vec<u8>, Text> {
    let events = start(plugin, question, root).map_err(|error| text!("{error}", "{error}"))?;
    let answer = events.wait(plugin);
    if answer.is_err() {
        events.group.end();
    }
    answer
}

/// A running program.
struct Running {
    group: Group,
    events: Receiver<Event>,
}

fn start(plugin: &Plugin, question: String, root: &Path) -> io::Result<Running> {
    let program = &plugin.program;
    // The child starts in another directory, and systems differ in where a relative path begins.
    let root = std::path::absolute(root)?;
    let command = if program.contains('/') {
        root.join(program)
    } else {
        program.into()
    };
    let mut command = Command::new(command);
    command
        .current_dir(root)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped());
    let (mut child, group) = Group::spawn(&mut command)?;
    let (sender, events) = channel();
    let (stdin, mut stdout) = (child.stdin.take(), child.stdout.take());
    // Writing and reading at once: the program may answer before it has read everything. A program that does not read
    // closes its input. No thread is joined: a grandchild may hold its end of a pipe.
    thread::spawn(move || stdin.map(|mut stdin| stdin.write_all(question.as_bytes())));
    let most = plugin.output_bytes;
    let answered: Sender<Event> = sender.clone();
    thread::spawn(move || {
        let answer = stdout.as_mut();
        let answer = answer.map_or(Ok(Some(Vec::new())), |stdout| up_to(most, stdout));
        // The pipe is open until the answer is sent. Otherwise, SIGPIPE could end the program first.
        answered.send(Event::Answer(answer))
    });
    thread::spawn(move || sender.send(Event::End(child.wait())));
    Ok(Running { group, events })
}

impl Running {
    /// Waits for the output and the end of the program.
    fn wait(&self, plugin: &Plugin) -> Result<Vec<u8>, Text> {
        let begin = Instant::now();
        let (mut answer, mut status) = (None, None);
        loop {
            match (answer.take(), status) {
                (_, Some(status)) if !ExitStatus::success(&status) => {
                    return Err(match status.code() {
                        Some(code) => text!("退出码为 {code}", "exit status {code}"),
                        None => text!("被系统终止（{status}）", "{status}"),
                    });
                }
                (Some(answer), Some(_)) => return Ok(answer),
                (rest, _) => answer = rest,
            }
            let left = plugin.timeout.saturating_sub(begin.elapsed());
            match self.events.recv_timeout(left) {
                Ok(Event::Answer(Ok(Some(bytes)))) => answer = Some(bytes),
                Ok(Event::Answer(Ok(None))) => {
                    let most = plugin.output_bytes;
                    return Err(text!(
                        "输出超过 `output_bytes: {most}`",
                        "its output is larger than `output_bytes: {most}`"
                    ));
                }
                Ok(Event::End(Ok(ended))) => status = Some(ended),
                Ok(Event::Answer(Err(error)) | Event::End(Err(error))) => {
                    return Err(text!("{error}", "{error}"));
                }
                Err(RecvTimeoutError::Timeout) => {
                    let most = plugin.timeout.as_millis();
                    return Err(text!(
                        "运行时间超过 `timeout_ms: {most}`",
                        "it runs longer than `timeout_ms: {most}`"
                    ));
                }
                // Each thread sends one event before it ends.
                Err(RecvTimeoutError::Disconnected) => {
                    return Err(text!("没有输出", "it has no output"));
                }
            }
        }
    }
}
