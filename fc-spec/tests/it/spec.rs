//! The spec of this project loads without errors.

use camino::Utf8Path;
use fc_spec::diagnostic::{Faults, Format, render};
use fc_spec::load::load;
use fc_spec::model::Lang;
use fc_spec::syntax::read_dir;

#[test]
fn the_projects_own_spec_has_no_faults() {
    let root = Utf8Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut faults = Faults::new();
    let sources = read_dir(root.as_std_path(), "spec".as_ref(), &mut faults);
    let model = load(&sources, &mut faults).model();
    faults.sort();
    let shown = render(&faults, &sources, Format::Text, Lang::En);
    assert!(faults.is_empty(), "{shown}");
    let model = model.unwrap_or_else(|| panic!("no faults and yet no model"));
    println!(
        "{} operations, {} types, {} answers",
        model.operations.len(),
        model.types.len(),
        model.answers.len()
    );
}
