//! References in a spec. Every name leads to its declaration, and every declaration that needs a use has one.

use crate::good_spec;
use fc_spec::diagnostic::Faults;
use fc_spec::index::{Index, definitions, occurrence_at, references};
use fc_spec::load::Trees;
use fc_spec::model::Languages;
use fc_spec::source::{FileId, SourceFile, Sources};
use fc_spec::syntax::parse;
use std::path::Path;

/// Returns the small spec, and the one that uses every part of the language.
fn specs() -> [Sources; 2] {
    let good = good_spec::FILES.map(|path| (format!("spec/{path}"), good_spec::file(path)));
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fc-codegen/tests/docs");
    let docs = fc_spec::syntax::read_dir(&docs, Path::new("spec"), &mut Faults::new());
    [Sources::from_texts(good), docs]
}

#[test]
fn every_name_leads_to_its_definition() {
    for sources in specs() {
        let (places, uses) = (definitions(&sources), references(&sources));
        assert!(uses.iter().count() > 0);
        for reference in uses.iter() {
            let text = sources.slice(reference.span);
            assert_eq!(text, reference.name, "{reference:?}");
            let (item, place) = reference.found(&places).expect("the spec has it");
            assert!(reference.is(&item), "{reference:?}");
            assert_eq!(places.get(&item), Some(place));
        }
    }
}

/// The language requires a use of every type, entity, store and coordinate system.
#[test]
fn every_thing_that_has_to_be_named_is() {
    for sources in specs() {
        let (places, uses) = (definitions(&sources), references(&sources));
        let declared = places.iter().filter(|(item, place)| {
            let is_declared = item.owner.is_none() && sources.slice(place.key) == item.name;
            is_declared
                && (item.is_type() || ["entity", "store", "coordinate system"].contains(&item.kind))
        });
        for (item, _) in declared {
            assert!(uses.of(item).next().is_some(), "{item}");
        }
    }
}

#[test]
fn no_offset_of_a_file_is_too_odd() {
    for sources in specs() {
        for (id, file) in sources.iter() {
            let tree = parse(id, &file.text, &mut Faults::new()).expect("a tree");
            for offset in (0..file.text.len() + 2).step_by(7) {
                if let Some(occurrence) = occurrence_at(tree.root(), offset) {
                    let span = occurrence.node.span();
                    assert!(span.start <= offset && offset <= span.end);
                    let _ = (
                        occurrence.words(),
                        occurrence.other_keys(),
                        occurrence.names(),
                        occurrence.reference(),
                    );
                }
            }
        }
    }
    let empty = parse(FileId(0), "", &mut Faults::new());
    assert!(empty.is_none());
}

/// A file changes, becomes invalid YAML, and gets its old text back. Each time, the updated index equals a new one.
#[test]
fn a_kept_index_equals_a_new_one() {
    for sources in specs() {
        let mut index = Index::new(Trees::new(&sources));
        let files: Vec<_> = sources.iter().map(|(_, file)| file.clone()).collect();
        for file in files {
            let broken = file.text.replacen(": ", ": [", 1);
            let moved = format!("# 在前\n{}", file.text.replacen("u16", "u61", 1));
            for text in [moved, broken, file.text.clone()] {
                let mut changed = sources.clone();
                changed.replace(SourceFile::new(file.path.as_str(), text));
                index = index.with(index.trees().with(&changed));
                let new = Index::new(Trees::new(&changed));
                let faults = [&index, &new].map(|index| {
                    let mut faults = Faults::new();
                    let _ = index.trees().load(Languages::All, &mut faults);
                    faults.iter().cloned().collect::<Vec<_>>()
                });
                assert_eq!(faults[0], faults[1], "{}", file.path);
                let (kept, read) = (index.definitions(), new.definitions());
                assert!(kept.iter().eq(read.iter()), "{}", file.path);
                for (id, _) in changed.iter() {
                    let own = read.iter().filter(|(_, place)| place.key.file == id);
                    let own: Vec<_> = own.collect();
                    let mut found: Vec<_> = kept.in_file(id).collect();
                    found.retain(|(item, place)| read.get(item) == Some(place));
                    found.sort_by_key(|(item, _)| *item);
                    assert_eq!(found, own);
                }
                assert!(index.references().iter().eq(new.references().iter()));
            }
        }
    }
}
