//! The summary line at the end.

use super::super::Faults;
use crate::model::Lang;

/// Counts the errors and files, and names the command that explains the first error. `None` without errors.
#[must_use]
pub fn summary(faults: &Faults, lang: Lang) -> Option<String> {
    let first = faults
        .iter()
        .min_by_key(|fault| (fault.severity, fault.primary.span))?;
    let mut files: Vec<_> = faults.iter().map(|fault| fault.primary.span.file).collect();
    files.sort_unstable();
    files.dedup();
    let files = files.len();
    let level = first.severity.word(lang);
    let code = first.code;

    let counts = [
        (faults.errors(), lang.pick("个错误", "error")),
        (faults.warnings(), lang.pick("个警告", "warning")),
    ];
    let counts = counts.into_iter().filter(|(count, _)| *count > 0);
    let counts: Vec<_> = counts
        .map(|(count, what)| counted(count, what, lang))
        .collect();
    let counts = counts.join(lang.pick("、", " and "));
    Some(match lang {
        Lang::Zh => {
            let shown = match faults.omitted() {
                0 => String::new(),
                _ => format!("，只显示前 {} 个", faults.len()),
            };
            format!(
                "{level}：{files} 个文件中有 {counts}{shown}；运行 `fcproto explain {code}` 查看第一个的详细说明"
            )
        }
        Lang::En => {
            let shown = match faults.omitted() {
                0 => String::new(),
                _ => format!(", the first {} of them shown", faults.len()),
            };
            let files = counted(files, "file", lang);
            format!(
                "{level}: {counts} in {files}{shown}; run `fcproto explain {code}` to read more about the first"
            )
        }
    })
}

fn counted(count: usize, one: &str, lang: Lang) -> String {
    match lang {
        Lang::En if count != 1 => format!("{count} {one}s"),
        _ => format!("{count} {one}"),
    }
}
