//! The language of the output of `fcproto`.

use crate::support::{Project, Run, command};

/// Runs the command in a project with these environment variables.
fn check(project: &Project, variables: &[(&str, &str)], args: &[&str]) -> Run {
    let mut command = command(args);
    command.envs(variables.iter().copied());
    let output = command.current_dir(project.path("")).output();
    Run::new(&output.expect("the command can be run"))
}

/// Creates a project whose spec has a duplicate key.
fn faulty() -> Project {
    let project = Project::new();
    project.append("spec/types.yaml", "types: {}\n");
    project
}

const ZH: &str = "键 `types` 出现两次";
const EN: &str = "the key `types` occurs twice";

#[test]
fn the_environment_chooses_the_language() {
    let project = faulty();
    let cases: [(&[(&str, &str)], &str); 9] = [
        (&[], EN),
        (&[("LANG", "zh_CN.UTF-8")], ZH),
        (&[("LANG", "zh-Hans")], ZH),
        (&[("LANG", "C.UTF-8")], EN),
        (&[("LANG", "de_DE.UTF-8")], EN),
        (&[("LC_ALL", "en_US.UTF-8"), ("LANG", "zh_CN.UTF-8")], EN),
        (
            &[("LC_MESSAGES", "zh_CN.UTF-8"), ("LANG", "en_US.UTF-8")],
            ZH,
        ),
        (&[("LC_ALL", "C"), ("LC_MESSAGES", "zh_CN.UTF-8")], EN),
        // An empty variable counts as unset.
        (&[("LC_ALL", ""), ("LANG", "zh_CN.UTF-8")], ZH),
    ];
    for (variables, expected) in cases {
        let run = check(&project, variables, &["check"]).expect(1);
        let other = if expected == ZH { EN } else { ZH };
        assert!(run.stderr.contains(expected), "{variables:?}: {run:#?}");
        assert!(!run.stderr.contains(other), "{variables:?}: {run:#?}");
    }
}

#[test]
fn the_option_has_the_last_word() {
    let project = faulty();
    let chinese = [("LC_ALL", "zh_CN.UTF-8")];
    let run = check(&project, &chinese, &["check", "--lang", "en"]).expect(1);
    assert!(run.stderr.contains(EN), "{run:#?}");
    let run = check(&project, &[], &["--lang", "zh", "check"]).expect(1);
    assert!(run.stderr.contains(ZH), "{run:#?}");
    assert!(run.stderr.starts_with("错误[FC0012]: "), "{run:#?}");
    assert!(
        run.stderr.contains("\n错误：1 个文件中有 1 个错误；"),
        "{run:#?}"
    );
    check(&project, &[], &["--lang", "de", "check"]).expect(2);
}

/// Machine-readable formats have translated messages. Their keys and keywords stay the same.
#[test]
fn every_format_follows() {
    let project = faulty();
    for format in ["json", "sarif", "github"] {
        let args = ["check", "--format", format, "--lang", "zh"];
        let run = check(&project, &[], &args).expect(1);
        assert!(run.stdout.contains(ZH), "{run:#?}");
        assert!(run.stdout.contains("重复的键"), "{run:#?}");
        assert!(run.stdout.contains("error"), "{run:#?}");
    }
}

/// Every language uses the same colors at the same places.
#[test]
fn colors_are_the_same() {
    let project = faulty();
    let escapes = |lang: &str| {
        let args = ["check", "--color", "always", "--lang", lang];
        let run = check(&project, &[], &args).expect(1);
        let parts = run.stderr.split('\u{1b}').skip(1);
        let codes = parts.filter_map(|part| part.split('m').next().map(str::to_owned));
        codes.collect::<Vec<_>>()
    };
    let english = escapes("en");
    assert!(english.len() > 10, "{english:?}");
    assert_eq!(escapes("zh"), english);
}

#[test]
fn explanations_follow() {
    let project = Project::empty();
    let explain = |lang, code| {
        let run = check(&project, &[], &["explain", code, "--lang", lang]);
        run.expect(0).stdout
    };
    assert!(explain("zh", "FC0012").starts_with("FC0012：重复的键\n\n"));
    assert!(explain("en", "FC0012").starts_with("FC0012: duplicate key\n\n"));
    assert!(explain("zh", "FC0701").contains("\n- 报文："));
    assert!(explain("en", "FC0701").contains("\n- Wire: "));
    let list = check(&project, &[("LANG", "zh_CN")], &["explain"]).expect(0);
    assert!(list.stdout.contains("FC0012  重复的键\n"), "{list:#?}");
}

/// Other messages of commands follow the language too, for success and for errors.
#[test]
fn output_follows_the_language() {
    let project = Project::new();
    for (args, status, expected) in [
        (&["check"][..], 0, "检查完毕："),
        (
            &["new", "x", "--group", "nope"],
            2,
            "错误：没有分组 `nope`；",
        ),
        (&["where", "nope"], 2, "错误：规范中没有 `nope`"),
        (&["diff"], 2, "错误：没有可供比较的发布版本；"),
        (&["inspect", "--for", "nope"], 2, "错误：没有受众 `nope`；"),
        (
            &["retire", "nope", "--zh", "无", "--en", "none"],
            2,
            "错误：没有接口 `nope`",
        ),
        (&["codes", "0x0001"], 0, "0x0001"),
    ] {
        let run = check(&project, &[("LANG", "zh_CN.UTF-8")], args).expect(status);
        let said = run.stdout + &run.stderr;
        assert!(said.contains(expected), "{args:?}: {said}");
    }
}
