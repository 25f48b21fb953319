//! Input files of the command line, or standard input for `-`. Reading stops at a size limit.

use std::io::Read;
use std::path::Path;

use fc_spec::model::Text;
use fc_spec::text;

use crate::lang::said;
use crate::outcome::Failure;

/// The maximum size of an input, in bytes.
const LONGEST: u64 = 256 << 20;

/// Reads the bytes of an input.
fn bytes(path: &Path) -> Result<Vec<u8>, Failure> {
    let name = path.display();
    if path.as_os_str() == "-" {
        return bounded(std::io::stdin(), &text!("标准输入", "standard input"));
    }
    if path.is_dir() {
        return Err(said!(
            "`{name}` 是目录，不是文件",
            "`{name}` is a directory, not a file"
        )
        .into());
    }
    let shown = text!("`{name}`", "`{name}`").spaced();
    match std::fs::File::open(path) {
        Ok(file) => bounded(file, &shown),
        Err(error) => Err(cannot(&shown, &error)),
    }
}

/// Reads the text of an input, without its byte order mark.
pub fn text(path: &Path) -> Result<String, Failure> {
    let text = String::from_utf8(bytes(path)?).map_err(|_| {
        let name = path.display();
        said!(
            "`{name}` 不是 UTF-8；请另存为 UTF-8",
            "`{name}` is not UTF-8; save it as UTF-8"
        )
    })?;
    let without_mark = text.strip_prefix('\u{feff}').map(str::to_owned);
    Ok(without_mark.unwrap_or(text))
}

/// Reads the text of a file of the project. Opening a pipe would wait for its writer, so pipes are refused.
pub fn file(path: &Path) -> Result<String, Failure> {
    if path.metadata().is_ok_and(|found| !found.is_file()) {
        let name = path.display();
        return Err(said!("`{name}` 不是普通文件", "`{name}` is not a regular file").into());
    }
    text(path)
}

fn bounded(input: impl Read, name: &Text) -> Result<Vec<u8>, Failure> {
    let mut bytes = Vec::new();
    // The extra byte shows that the input is too large.
    let mut input = input.take(LONGEST.saturating_add(1));
    input
        .read_to_end(&mut bytes)
        .map_err(|error| cannot(name, &error))?;
    if u64::try_from(bytes.len()).is_ok_and(|read| read <= LONGEST) {
        return Ok(bytes);
    }
    let most = LONGEST >> 20;
    Err(said!(
        "{name}超过 {most} MiB",
        "{name} is larger than {most} MiB",
        name = name
    )
    .trim_start()
    .into())
}

fn cannot(name: &Text, error: &std::io::Error) -> Failure {
    said!(
        "无法读取{name}：{error}",
        "cannot read {name}: {error}",
        name = name
    )
    .into()
}
