//! `fcproto where`.

use fc_spec::diagnostic::Faults;
use fc_spec::index::{DefId, DefSite as Written, definitions};
use fc_spec::load::load;
use fc_spec::source::Sources;
use fc_spec::syntax::read_dir;

use crate::lang::{both, in_lang, said};
use crate::outcome::{Failure, Status};
use crate::print;
use crate::project::Project;
use crate::project_dirs::ProjectDirs;

/// Options of `fcproto where`.
#[derive(Debug, clap::Args)]
pub struct Options {
    #[arg(
        value_name = "NAME",
        help = both("名称、`Station.name` 这样的路径，或功能码", "Name, path such as `Station.name`, or code")
    )]
    name: String,
}

pub fn run(dirs: &ProjectDirs, options: &Options) -> Result<Status, Failure> {
    let project = Project::find(dirs)?;
    let mut faults = Faults::new();
    let sources = read_dir(&project.root, &project.spec, &mut faults);
    let loaded = load(&sources, &mut faults);
    let name = options.name.as_str();
    let operations = loaded.partial.operations.iter();
    let coded = operations.filter(|it| it.code.value.is_some() && it.code.spelling == name);
    let mut names: Vec<&str> = coded.map(|operation| operation.name.as_str()).collect();
    if names.is_empty() {
        names.push(name);
    }
    let places = definitions(&sources);
    let found = names.iter().flat_map(|name| places.named(name));
    let found: Vec<_> = found.map(|(item, at)| shown(item, at, &sources)).collect();
    if found.is_empty() {
        let near = places.nearest(name);
        let near = near.map(|near| said!("；是否想写 `{near}`？", "; did you mean `{near}`?"));
        let cause = || {
            said!(
                "；规范有错误，`fcproto check` 会列出",
                "; the spec has errors, which `fcproto check` shows"
            )
        };
        let cause = near.or(faults.has_errors().then(cause));
        let cause = cause.unwrap_or_default();
        let message = said!(
            "规范中没有 `{name}`{cause}",
            "there is no `{name}` in the spec{cause}"
        );
        return Err(message.into());
    }
    print::result(&found.concat())?;
    Ok(Status::Fine)
}

fn shown(item: &DefId, written: &Written, sources: &Sources) -> String {
    let path = sources.path(written.key);
    let at = sources.line_col(written.key);
    let item = in_lang(&item.text());
    let place = format!("{path}:{}:{}: {item}\n", at.line, at.column);
    let comments = written.comments.iter();
    let comments = comments.map(|comment| format!("    {}\n", sources.slice(*comment)));
    std::iter::once(place).chain(comments).collect()
}
