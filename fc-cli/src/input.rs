//! Input files of the command line, or standard input for `-`. Reading stops at a size limit.

use std::io::{self, Read};
use std::path::Path;

use fc_spec::model::Text;
use fc_spec::text;

use crate::lang::said;
use crate::outcome::Failure;
use crate::project::is_there;

/// The maximum size of an input, in bytes.
const LONGEST: u64 = 256 << 20;

/// Reads the bytes of an input.
fn bytes(path: &Path) -> Result<Vec<u8>, Failure> {
    let name = path.display();
    if path.as_os_str() == "-" {
        return bounded(io::stdin(), &text!("标准输入", "standard input"));
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

/// Reads the text of a file of the project, or returns `None` if nothing is there.
pub fn file_if_there(path: &Path) -> Result<Option<String>, Failure> {
    is_there(path).then(|| file(path)).transpose()
}

/// Reads standard input, up to one byte beyond a limit.
pub fn stdin(most: usize) -> Result<Vec<u8>, Failure> {
    let most = u64::try_from(most).unwrap_or(u64::MAX);
    let read = beyond(most, io::stdin());
    read.map_err(|error| cannot(&text!("标准输入", "standard input"), &error))
}

/// Reads bytes up to a limit and one more, which shows that the input is too large.
fn beyond(most: u64, input: impl Read) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    input.take(most.saturating_add(1)).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// Reads bytes up to a limit, or returns `None` if there are more.
pub fn up_to(most: u64, input: impl Read) -> io::Result<Option<Vec<u8>>> {
    let bytes = beyond(most, input)?;
    let fits = u64::try_from(bytes.len()).is_ok_and(|read| read <= most);
    Ok(fits.then_some(bytes))
}

fn bounded(input: impl Read, name: &Text) -> Result<Vec<u8>, Failure> {
    let read = up_to(LONGEST, input).map_err(|error| cannot(name, &error))?;
    if let Some(bytes) = read {
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

fn cannot(name: &Text, error: &io::Error) -> Failure {
    said!(
        "无法读取{name}：{error}",
        "cannot read {name}: {error}",
        name = name
    )
    .into()
}
