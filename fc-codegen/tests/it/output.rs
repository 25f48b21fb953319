//! The writer in a real folder. Each case has the folder before, the artifacts, and the folder after.

use fc_codegen::output::{MANIFEST, OutputError, Plan, plan};
use fc_codegen::product::{Artifact, Product};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

type Tree<'a> = &'a [(&'a str, &'a str)];

/// A case of the writer. `markdown a.md` is the path `a.md` of the product `markdown`.
struct Case {
    name: &'static str,
    /// Files on disk.
    before: Tree<'static>,
    /// Owned paths, as `product path`.
    owned: &'static [&'static str],
    /// Artifacts: `product path`, and contents.
    artifacts: Tree<'static>,
    only: &'static [&'static str],
    /// `+` created, `~` updated, `=` unchanged, `-` orphaned, `!` foreign. The list omits the manifest.
    plan: &'static [&'static str],
    /// Files on disk after writing; `None` if the writer refuses and changes nothing.
    after: Option<Tree<'static>>,
    /// Owned paths after writing.
    owned_after: &'static [&'static str],
}

const CASES: &[Case] = &[
    Case {
        name: "a first run creates, folders included",
        before: &[("hand.txt", "mine")],
        owned: &[],
        artifacts: &[("rust src/a.rs", "a"), ("markdown docs/en/a.md", "b")],
        only: &[],
        plan: &["+docs/en/a.md", "+src/a.rs"],
        after: Some(&[
            ("docs/en/a.md", "b"),
            ("hand.txt", "mine"),
            ("src/a.rs", "a"),
        ]),
        owned_after: &["markdown docs/en/a.md", "rust src/a.rs"],
    },
    Case {
        name: "what is right stays, what is old is updated, what is gone is removed with its folder",
        before: &[
            ("src/a.rs", "a"),
            ("src/b.rs", "old"),
            ("src/old/deep/c.rs", "c"),
        ],
        owned: &["rust src/a.rs", "rust src/b.rs", "rust src/old/deep/c.rs"],
        artifacts: &[("rust src/a.rs", "a"), ("rust src/b.rs", "b")],
        only: &[],
        plan: &["-src/old/deep/c.rs", "=src/a.rs", "~src/b.rs"],
        after: Some(&[("src/a.rs", "a"), ("src/b.rs", "b")]),
        owned_after: &["rust src/a.rs", "rust src/b.rs"],
    },
    Case {
        name: "a folder that holds somebody's file stays",
        before: &[("src/old/c.rs", "c"), ("src/old/notes.txt", "mine")],
        owned: &["rust src/old/c.rs"],
        artifacts: &[],
        only: &[],
        plan: &["-src/old/c.rs"],
        after: Some(&[("src/old/notes.txt", "mine")]),
        owned_after: &[],
    },
    Case {
        name: "somebody's file is never touched, nor anything else then",
        before: &[("src/a.rs", "mine"), ("src/old.rs", "c")],
        owned: &["rust src/old.rs"],
        artifacts: &[("rust src/a.rs", "a"), ("rust src/b.rs", "b")],
        only: &[],
        plan: &["!src/a.rs", "+src/b.rs", "-src/old.rs"],
        after: None,
        owned_after: &["rust src/old.rs"],
    },
    Case {
        name: "somebody's file that is the same is taken over",
        before: &[("src/a.rs", "a")],
        owned: &[],
        artifacts: &[("rust src/a.rs", "a")],
        only: &[],
        plan: &["=src/a.rs"],
        after: Some(&[("src/a.rs", "a")]),
        owned_after: &["rust src/a.rs"],
    },
    Case {
        name: "only some products: the others keep their files and their entries",
        before: &[
            ("a.md", "old"),
            ("a.rs", "old"),
            ("b.md", "b"),
            ("b.rs", "b"),
        ],
        owned: &["markdown a.md", "markdown b.md", "rust a.rs", "rust b.rs"],
        artifacts: &[("rust a.rs", "new"), ("markdown a.md", "new")],
        only: &["rust"],
        plan: &["-b.rs", "~a.rs"],
        after: Some(&[("a.md", "old"), ("a.rs", "new"), ("b.md", "b")]),
        owned_after: &["markdown a.md", "markdown b.md", "rust a.rs"],
    },
    Case {
        name: "a product that this version does not know keeps its files while only some are made",
        before: &[("a.ts", "a"), ("a.rs", "a")],
        owned: &["typescript a.ts", "rust a.rs"],
        artifacts: &[("rust a.rs", "a")],
        only: &["rust"],
        plan: &["=a.rs"],
        after: Some(&[("a.rs", "a"), ("a.ts", "a")]),
        owned_after: &["rust a.rs", "typescript a.ts"],
    },
    Case {
        name: "a path that moves from one product to another stays owned once",
        before: &[("a.json", "old")],
        owned: &["vectors a.json"],
        artifacts: &[("schema a.json", "new")],
        only: &[],
        plan: &["~a.json"],
        after: Some(&[("a.json", "new")]),
        owned_after: &["schema a.json"],
    },
    Case {
        name: "an owned file that somebody deleted is written again, an orphan that is gone is no fault",
        before: &[],
        owned: &["rust a.rs", "rust b.rs"],
        artifacts: &[("rust a.rs", "a")],
        only: &[],
        plan: &["+a.rs"],
        after: Some(&[("a.rs", "a")]),
        owned_after: &["rust a.rs"],
    },
];

#[test]
fn cases() {
    for case in CASES {
        let root = folder(case.before);
        if !case.owned.is_empty() {
            fs::write(root.path().join(MANIFEST), manifest(case.owned)).unwrap();
        }
        let before = tree(root.path());

        let only: Vec<_> = case.only.iter().map(ToString::to_string).collect();
        let plan = plan(artifacts(case.artifacts), root.path(), &only).unwrap();
        assert_eq!(summary(&plan), case.plan, "{}", case.name);
        assert_eq!(
            tree(root.path()),
            before,
            "planning writes nothing: {}",
            case.name
        );

        match (plan.write(), case.after) {
            (Ok(()), Some(after)) => {
                let mut now = tree(root.path());
                now.remove(MANIFEST);
                let after: BTreeMap<String, String> = after
                    .iter()
                    .map(|(path, text)| ((*path).into(), (*text).into()))
                    .collect();
                assert_eq!(now, after, "{}", case.name);
                assert_eq!(owned(root.path()), case.owned_after, "{}", case.name);
                let again = self::plan(artifacts(case.artifacts), root.path(), &only).unwrap();
                assert!(
                    again.is_fresh(),
                    "a second run has nothing to do: {}",
                    case.name
                );
            }
            (Err(OutputError::Foreign { paths }), None) => {
                assert_eq!(paths, plan.foreign);
                assert_eq!(tree(root.path()), before, "{}", case.name);
            }
            (result, _) => panic!("{}: {result:?}", case.name),
        }
    }
}

#[test]
fn an_unchanged_file_keeps_its_time() {
    let root = folder(&[]);
    let make = || artifacts(&[("rust a.rs", "a"), ("rust b.rs", "b")]);
    plan(make(), root.path(), &[]).unwrap().write().unwrap();
    let long_ago = fs::FileTimes::new().set_modified(std::time::UNIX_EPOCH);
    let place = root.path().join("a.rs");
    fs::File::options()
        .write(true)
        .open(&place)
        .unwrap()
        .set_times(long_ago)
        .unwrap();

    fs::write(root.path().join("b.rs"), "changed").unwrap();
    plan(make(), root.path(), &[]).unwrap().write().unwrap();
    assert_eq!(
        fs::metadata(&place).unwrap().modified().unwrap(),
        std::time::UNIX_EPOCH
    );
    assert_eq!(fs::read_to_string(root.path().join("b.rs")).unwrap(), "b");
}

#[test]
fn paths_stay_below_the_root() {
    let root = folder(&[]);
    for path in ["../a", "/a", "a/../../b", "", "a//b"] {
        let artifact = artifact("rust", path, "x");
        let result = plan(vec![artifact], root.path(), &[]);
        assert!(
            matches!(result, Err(OutputError::BadPath { .. })),
            "{path:?}: {result:?}"
        );
    }
    fs::write(root.path().join(MANIFEST), manifest(&["rust ../a"])).unwrap();
    let result = plan(Vec::new(), root.path(), &[]);
    assert!(
        matches!(result, Err(OutputError::BadPath { .. })),
        "{result:?}"
    );
}

#[cfg(unix)]
#[test]
fn links_are_not_written_through() {
    let outside = folder(&[("a.rs", "mine")]);
    let root = folder(&[]);
    std::os::unix::fs::symlink(outside.path(), root.path().join("src")).unwrap();
    let result = plan(artifacts(&[("rust src/a.rs", "x")]), root.path(), &[]);
    assert!(
        matches!(&result, Err(OutputError::Symlink { path }) if path == "src"),
        "{result:?}"
    );
    assert_eq!(tree(outside.path()).len(), 1);
}

#[test]
fn two_artifacts_must_not_share_a_path() {
    let root = folder(&[]);
    for (first, second) in [("a.rs", "a.rs"), ("a.rs", "A.rs"), ("a.rs", MANIFEST)] {
        let artifacts = vec![artifact("rust", first, "x"), artifact("rust", second, "x")];
        let result = plan(artifacts, root.path(), &[]);
        assert!(
            matches!(result, Err(OutputError::Duplicate { .. })),
            "{second}: {result:?}"
        );
    }
}

#[test]
fn a_broken_manifest_stops_everything() {
    let root = folder(&[(MANIFEST, "<<<<<<< HEAD\n")]);
    let result = plan(artifacts(&[("rust a.rs", "x")]), root.path(), &[]);
    let Err(error @ OutputError::Manifest { .. }) = result else {
        panic!("{result:?}")
    };
    assert!(error.to_string().contains("version control"), "{error}");
}

#[test]
fn differences_are_shown_by_hunk() {
    let numbers = |marked: usize| {
        let line = |n| {
            if n == marked {
                "x\n".to_owned()
            } else {
                format!("{n}\n")
            }
        };
        (1..=20).map(line).collect::<Vec<_>>().concat()
    };
    let root = folder(&[]);
    let before = vec![
        artifact("rust", "a.rs", &numbers(10)),
        artifact("rust", "old.rs", "o\n"),
    ];
    plan(before, root.path(), &[]).unwrap().write().unwrap();
    let artifacts = vec![
        artifact("rust", "a.rs", &numbers(0)),
        artifact("rust", "new.rs", "n\n"),
    ];
    let diffs = plan(artifacts, root.path(), &[]).unwrap().diffs();
    let texts: Vec<&str> = diffs.iter().map(|diff| diff.text.as_str()).collect();
    let [a, manifest, new, old] = texts.as_slice() else {
        panic!("{diffs:?}")
    };
    assert_eq!(
        *a,
        "--- a/a.rs\n+++ b/a.rs\n@@ -7,7 +7,7 @@\n 7\n 8\n 9\n-x\n+10\n 11\n 12\n 13\n"
    );
    assert!(
        manifest.contains("-      \"old.rs\"\n+      \"new.rs\"\n"),
        "{manifest}"
    );
    assert_eq!(*new, "--- /dev/null\n+++ b/new.rs\n@@ -0,0 +1 @@\n+n\n");
    assert_eq!(*old, "--- a/old.rs\n+++ /dev/null\n@@ -1 +0,0 @@\n-o\n");
}

#[test]
fn a_long_difference_is_cut_off() {
    let root = folder(&[]);
    let long = "a line\n".repeat(500);
    let diffs = plan(vec![artifact("rust", "a.rs", &long)], root.path(), &[])
        .unwrap()
        .diffs();
    let last = diffs
        .first()
        .and_then(|diff| diff.text.lines().last())
        .unwrap();
    assert_eq!(last, "… 463 more lines");
}

#[test]
fn products_have_names() {
    for product in Product::ALL {
        assert_eq!(Product::named(product.name()), Some(product));
    }
    assert_eq!(Product::named("cobol"), None);
}

fn artifact(product: &str, path: &str, contents: &str) -> Artifact {
    Artifact {
        target: product.to_owned(),
        path: path.to_owned(),
        contents: contents.to_owned(),
    }
}

fn artifacts(tree: Tree<'_>) -> Vec<Artifact> {
    tree.iter()
        .map(|(name, contents)| {
            let (product, path) = name.split_once(' ').unwrap();
            artifact(product, path, contents)
        })
        .collect()
}

fn folder(files: Tree<'_>) -> TempDir {
    let root = tempfile::tempdir().unwrap();
    for (path, contents) in files {
        let place = root.path().join(path);
        fs::create_dir_all(place.parent().unwrap()).unwrap();
        fs::write(place, contents).unwrap();
    }
    root
}

fn manifest(owned: &[&str]) -> String {
    let mut products: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for entry in owned {
        let (product, path) = entry.split_once(' ').unwrap();
        products.entry(product).or_default().push(path);
    }
    serde_json::json!({ "format": 1, "about": "", "products": products }).to_string()
}

/// Returns the owned paths in the manifest on disk, as `product path`.
fn owned(root: &Path) -> Vec<String> {
    let text = fs::read_to_string(root.join(MANIFEST)).unwrap();
    let manifest: serde_json::Value = serde_json::from_str(&text).unwrap();
    let mut owned = Vec::new();
    for (product, paths) in manifest
        .get("products")
        .and_then(|p| p.as_object())
        .unwrap()
    {
        for path in paths.as_array().unwrap() {
            owned.push(format!("{product} {}", path.as_str().unwrap()));
        }
    }
    owned.sort();
    owned
}

/// Returns every file below a folder.
fn tree(root: &Path) -> BTreeMap<String, String> {
    fn walk(root: &Path, folder: &Path, out: &mut BTreeMap<String, String>) {
        let entries: Vec<_> = fs::read_dir(folder).unwrap().map(Result::unwrap).collect();
        assert!(
            folder == root || !entries.is_empty(),
            "an empty folder is left: {}",
            folder.display()
        );
        for entry in entries {
            let place = entry.path();
            if place.is_dir() {
                walk(root, &place, out);
            } else {
                let path = place
                    .strip_prefix(root)
                    .unwrap()
                    .to_string_lossy()
                    .replace('\\', "/");
                out.insert(path, fs::read_to_string(&place).unwrap());
            }
        }
    }
    let mut out = BTreeMap::new();
    walk(root, root, &mut out);
    out
}

fn summary(plan: &Plan) -> Vec<String> {
    let mut out: Vec<String> = Vec::new();
    out.extend(plan.created.iter().map(|file| format!("+{}", file.path)));
    out.extend(plan.updated.iter().map(|file| format!("~{}", file.path)));
    out.extend(plan.unchanged.iter().map(|path| format!("={path}")));
    out.extend(plan.orphaned.iter().map(|file| format!("-{}", file.path)));
    out.extend(plan.foreign.iter().map(|path| format!("!{path}")));
    out.retain(|line| !line.ends_with(MANIFEST));
    out.sort();
    out
}
