//! Tests the READMEs. Their figures, links and picture of a frame are right. The programs of this package's README talk
//! to each other.

use crate::support::programs::Running;
use crate::support::{self, nested};
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Each README, and the folder of the guides in its language.
const READMES: [(&str, &str); 2] = [
    ("README.md", "docs-site/en/guides"),
    ("README.zh-CN.md", "docs-site/guides"),
];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Returns the contents of a README's fences of one language.
fn fences<'t>(text: &'t str, language: &str) -> Vec<&'t str> {
    let open = format!("\n```{language}\n");
    let parts = text.split(&open).skip(1);
    parts
        .map(|rest| rest.split("\n```\n").next().expect("a fence that closes"))
        .collect()
}

/// Builds the robot and the app of this package's README outside the workspace, and lets them talk.
#[test]
#[ignore = "compiles projects of its own"]
fn the_app_of_the_readme_calls_its_robot() {
    let name = "fc-generated/README.md";
    let text = fs::read_to_string(root().join(name)).unwrap();
    assert!(!text.contains("```rust,"), "{name}: untested Rust");
    let [manifest] = fences(&text, "toml")[..] else {
        unreachable!("{name} has one manifest");
    };
    let [robot, app] = fences(&text, "rust")[..] else {
        unreachable!("{name} has a robot and an app");
    };
    let [talk] = fences(&text, "console")[..] else {
        unreachable!("{name} shows one run");
    };
    let address = ".address([127, 0, 0, 1])";
    let robot = replace(
        robot,
        address,
        &[address, ".command_port(0).data_port(0)"].concat(),
    );
    let run = "server.run().await;";
    let said = r#"println!("{}", server.command_addr().port());"#;
    let robot = replace(&robot, run, &[said, run].concat());
    let host = ".host(\"127.0.0.1\")";
    let port = ".command_port(std::env::args().nth(1).unwrap().parse()?)";
    let app = replace(app, host, &[host, port].concat());
    let [robot, app] = build(name, manifest, [("robot", robot), ("app", app)]);

    let mut robot = Running::start(&robot, &[]);
    let output = Command::new(app).arg(robot.line()).output().unwrap();
    let found = String::from_utf8(output.stdout).unwrap();
    let wanted = talk.lines().filter(|line| !line.starts_with('$'));
    assert!(
        output.status.success() && found.lines().eq(wanted),
        "{found}"
    );
}

/// Replaces a piece of a program, which must have it.
fn replace(program: &str, from: &str, to: &str) -> String {
    assert!(program.contains(from), "no {from} in\n{program}");
    program.replace(from, to)
}

/// The READMEs show only generated Rust, in an `rs` fence. `adding_a_command` compares it with the output.
#[test]
fn the_readmes_print_generated_rust_alone() {
    for (name, _) in READMES {
        let text = fs::read_to_string(root().join(name)).unwrap();
        assert!(!text.contains("```rust"), "{name}: Rust that is not tested");
    }
}

/// Builds programs in a package outside the workspace, with this manifest. Returns their paths.
fn build<const N: usize>(
    name: &str,
    manifest: &str,
    programs: [(&str, String); N],
) -> [PathBuf; N] {
    let project = tempfile::tempdir().unwrap();
    let here = root().join("fc-generated").canonicalize().unwrap();
    let path = format!("path = {:?}", here.to_string_lossy());
    let manifest = replace(manifest, "path = \"fc-generated\"", &path);
    let package = "[package]\nname = \"user\"\nedition = \"2024\"\n\n[workspace]\n\n[lints.rust]\nwarnings = \"deny\"\n";
    fs::write(
        project.path().join("Cargo.toml"),
        [package, "\n", &manifest, "\n"].concat(),
    )
    .unwrap();
    // The versions of the workspace, so that cargo downloads nothing.
    fs::copy(root().join("Cargo.lock"), project.path().join("Cargo.lock")).unwrap();
    let sources = project.path().join("src/bin");
    fs::create_dir_all(&sources).unwrap();
    for (program, source) in &programs {
        fs::write(sources.join(format!("{program}.rs")), source).unwrap();
    }

    let output = nested::command()
        .args(["build", "--offline"])
        .current_dir(project.path())
        .env("CARGO_TARGET_DIR", nested::target())
        .output()
        .unwrap();
    assert!(
        output.status.success(),
        "{name}: {}",
        String::from_utf8_lossy(&output.stderr)
    );
    programs.map(|(program, _)| {
        nested::target()
            .join("debug")
            .join(format!("{program}{}", std::env::consts::EXE_SUFFIX))
    })
}

/// Links lead from the README to every guide, directly or through other guides.
#[test]
fn every_guide_is_linked() {
    for (name, guides) in READMES {
        let folder = root().join(guides);
        let text = fs::read_to_string(root().join(name)).unwrap();
        let mut reached = BTreeSet::new();
        let mut pages = linked(&text, &format!("]({guides}/"));
        while let Some(page) = pages.pop() {
            if reached.insert(page.clone()) {
                let text = fs::read_to_string(folder.join(&page));
                let text = text.unwrap_or_else(|error| panic!("{name}: {page}: {error}"));
                pages.extend(linked(&text, "]("));
            }
        }
        for guide in fs::read_dir(&folder).unwrap() {
            let guide = guide.unwrap().file_name().into_string().unwrap();
            if is_page(&guide) {
                assert!(reached.contains(&guide), "{name}: no link to {guide}");
            }
        }
    }
}

/// Returns the pages of one folder to which a text links. `open` begins each link.
fn linked(text: &str, open: &str) -> Vec<String> {
    let links = text.split(open).skip(1);
    let pages = links.filter_map(|rest| rest.split([')', '#']).next());
    pages
        .filter(|page| is_page(page) && !page.contains('/'))
        .map(str::to_owned)
        .collect()
}

fn is_page(name: &str) -> bool {
    Path::new(name).extension().is_some_and(|end| end == "md")
}

/// The figures are lower bounds, so that an addition does not make them wrong.
#[test]
fn the_figures_of_the_readmes_are_reached() {
    let operations = support::model(&root()).operations.len();
    let faults = fs::read_dir(root().join("fc-runtime/faults")).unwrap();
    let faults = faults.filter(|fault| {
        let path = fault.as_ref().unwrap().path();
        path.extension().is_some_and(|end| end == "patch")
    });
    let porting = fs::read_to_string(root().join("docs-site/en/guides/porting.md")).unwrap();
    let (_, table) = porting.split_once("{#table}").expect("a table of cases");
    let rows = table.lines().filter(|line| line.starts_with('|'));
    let cases = rows.filter_map(|row| {
        let number = row.split('|').nth(2)?.trim().replace([',', '+'], "");
        number.parse::<usize>().ok()
    });

    let figures = [
        (operations, 50, "50 "),
        (faults.count(), 140, "140 "),
        (cases.sum::<usize>(), 2900, "2,900 "),
    ];
    for (there, least, printed) in figures {
        assert!(there >= least, "{printed}: there are {there}");
        for (name, _) in READMES {
            let text = fs::read_to_string(root().join(name)).unwrap();
            assert!(text.contains(printed), "{name}: {printed}");
        }
    }
}

#[test]
fn the_picture_of_a_frame_is_the_golden_frame() {
    let vectors = root().join("fc-generated/vectors/get_robot_sn.json");
    let vectors = fs::read_to_string(vectors).unwrap();
    let vectors: serde_json::Value = serde_json::from_str(&vectors).unwrap();
    let mut cases = vectors["accepted"].as_array().unwrap().iter();
    let golden = cases.find(|case| case["name"] == "request_plain");
    let mut golden = golden.unwrap()["frame"].as_str().unwrap();

    let picture = fs::read_to_string(root().join("docs-site/public/frame.svg")).unwrap();
    for field in support::model(&root()).frame.header {
        let (bytes, rest) = golden.split_at(2 * field.ty.size());
        assert_eq!(drawn(&picture, &field.wire), bytes, "{}", field.wire);
        golden = rest;
    }
    assert_eq!(drawn(&picture, "Data"), golden);
}

/// Returns the bytes in hex of a field's group in a picture. The legend must name the field too.
fn drawn(picture: &str, field: &str) -> String {
    assert!(picture.contains(&format!(">{field}<")), "legend: {field}");
    let group = picture.split(&format!("<g id=\"{field}\"")).nth(1);
    let (group, _) = group.expect(field).split_once("</g>").expect("its end");
    let bytes = group.split("class=\"byte\"").skip(1);
    bytes
        .map(|byte| byte.split(['>', '<']).nth(1).expect("a byte"))
        .collect()
}
