//! Targets that other programs make.

use std::io::{Read as _, Write as _};
use std::path::Path;
use std::process::{Child, Command, Stdio};

use fc_codegen::inspect;
use fc_codegen::product::Artifact;
use fc_codegen::target::{Plugin, part};
use fc_spec::model::Model;

use crate::lang::said;
use crate::outcome::Failure;

/// Longest answer, in bytes.
const LONGEST: u64 = 256 * 1024 * 1024;

/// Runs the program of a target in the project's root and takes its files.
///
/// It gets what `fcproto inspect` prints, for the target's audience if it has one, with the target's `options` as one more key, on standard input. What it says
/// on standard error goes to the user.
pub fn run(plugin: &Plugin, model: &Model, root: &Path) -> Result<Vec<Artifact>, Failure> {
    let (program, target) = (&plugin.program, &plugin.name);
    let model = part(model, plugin.audience.as_deref())?;
    let command = if program.contains('/') {
        // Where the program starts does not tell on all systems from where its path counts.
        root.join(program)
    } else {
        program.into()
    };
    let mut child = Command::new(&command)
        .current_dir(root)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .map_err(|error| {
            said!(
                "无法为目标 `{target}` 运行 `{program}`：{error}",
                "cannot run `{program}` for the target `{target}`: {error}"
            )
        })?;
    let question = inspect::json_with(&model, &plugin.options);
    let answer = converse(&mut child, question.as_bytes()).map_err(|error| {
        said!(
            "无法与 `{program}` 通信：{error}",
            "cannot talk to `{program}`: {error}"
        )
    })?;
    let status = (child.wait()).map_err(|error| {
        said!(
            "无法等待 `{program}` 结束：{error}",
            "cannot wait for `{program}`: {error}"
        )
    })?;
    if !status.success() {
        return Err(said!(
            "`{program}` 没有为目标 `{target}` 生成任何内容：{status}",
            "`{program}` made nothing of the target `{target}`: {status}"
        )
        .into());
    }
    plugin.artifacts(&answer).map_err(|error| {
        said!(
            "`{program}` 为目标 `{target}` 返回的不是 {{ path, contents }} 的列表：{error}",
            "`{program}` did not answer with a list of {{ path, contents }} for the target `{target}`: {error}"
        )
        .into()
    })
}

/// Writes the question and reads the answer at once: the program may begin to answer before it has read all.
fn converse(child: &mut Child, question: &[u8]) -> std::io::Result<Vec<u8>> {
    let (stdin, stdout) = (child.stdin.take(), child.stdout.take());
    std::thread::scope(|scope| {
        scope.spawn(move || {
            // A program that does not want to know ends its input; its answer says whether that was right.
            stdin.map(|mut stdin| stdin.write_all(question))
        });
        let mut answer = Vec::new();
        if let Some(stdout) = stdout {
            stdout.take(LONGEST).read_to_end(&mut answer)?;
        }
        Ok(answer)
    })
}
