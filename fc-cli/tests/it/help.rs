//! Help and usage errors in both languages, and the reference page with the same texts.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Command;
use std::sync::{Arc, LazyLock, Mutex};

use crate::support::{Run, command};

/// Longest summary, in columns.
const SUMMARY: usize = 60;

/// Runs `fcproto` in a terminal of this width.
fn run_in(columns: usize, args: &[&str]) -> Run {
    let mut command: Command = command(args);
    command.env("COLUMNS", columns.to_string());
    Run::new(&command.output().expect("the command can be run"))
}

fn run(args: &[&str]) -> Run {
    run_in(100, args)
}

/// Appends `--lang` to the arguments.
fn in_language<'a>(args: &[&'a str], lang: &'a str) -> Vec<&'a str> {
    [args, &["--lang", lang]].concat()
}

fn is_chinese(text: &str) -> bool {
    text.contains(|it: char| ('\u{4e00}'..='\u{9fff}').contains(&it))
}

fn width(text: &str) -> usize {
    let wide = text.chars().filter(|it| *it >= '\u{2e80}').count();
    text.chars().count() + wide
}

/// The words of every command, and an empty list for the program itself.
static COMMANDS: LazyLock<Vec<Vec<String>>> = LazyLock::new(|| {
    let page = run(&["help-page"]).expect(0).stdout;
    let heads = page
        .lines()
        .filter_map(|line| line.strip_prefix("## fcproto "));
    let names = heads.filter_map(|head| head.split(" {#").next());
    let words = |name: &str| name.split(' ').map(str::to_owned).collect();
    let commands: Vec<_> = names.map(words).chain([Vec::new()]).collect();
    assert!(commands.len() > 20, "{commands:?}");
    commands
});

/// The help of every command by its name.
type Helps = Arc<Vec<(String, String)>>;

/// Flag, language and columns.
type Asked = (&'static str, &'static str, usize);

/// Help texts that the tests share, because each command takes a process.
static HELPS: Mutex<BTreeMap<Asked, Helps>> = Mutex::new(BTreeMap::new());

fn helps(flag: &'static str, lang: &'static str, columns: usize) -> Helps {
    let help = |words: &Vec<String>| {
        let args: Vec<&str> = words.iter().map(String::as_str).chain([flag]).collect();
        let run = run_in(columns, &in_language(&args, lang)).expect(0);
        (words.join(" "), run.stdout)
    };
    let mut helps = HELPS.lock().expect("no test has panicked here");
    let helps = helps.entry((flag, lang, columns));
    Arc::clone(helps.or_insert_with(|| Arc::new(COMMANDS.iter().map(help).collect())))
}

/// Returns the lines of a section.
fn section<'h>(help: &'h str, title: &str) -> Vec<&'h str> {
    let lines = help.lines().skip_while(|line| *line != title).skip(1);
    lines.take_while(|line| !line.is_empty()).collect()
}

#[test]
fn page_of_the_reference_is_up_to_date() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs-site");
    for (lang, path) in [("zh", "reference/cli.md"), ("en", "en/reference/cli.md")] {
        let page = run(&in_language(&["help-page"], lang)).expect(0).stdout;
        let path = root.join(path);
        if std::env::var_os("BLESS").is_some() {
            std::fs::write(&path, &page).expect("the page can be written");
        }
        let written = std::fs::read_to_string(&path).unwrap_or_default();
        let path = path.display();
        assert!(
            page == written,
            "{path} is stale; run this test with BLESS=1"
        );
    }
}

/// The pages of both languages have the same sections, tables, lists and code.
#[test]
fn pages_have_the_same_structure() {
    let shape = |lang: &str| {
        let page = run(&in_language(&["help-page"], lang)).expect(0).stdout;
        let mark = |line: &str| match line.as_bytes() {
            [b'|', ..] => format!("|{}", line.replace("\\|", "").matches('|').count()),
            [b'#', b'#', ..] => line.split_once(" {#").map_or("#", |(_, id)| id).to_owned(),
            [b'-', ..] | [b'`', b'`', ..] => line.chars().take(2).collect(),
            [] => String::new(),
            _ => "text".to_owned(),
        };
        page.lines().map(mark).collect::<Vec<_>>()
    };
    assert_eq!(shape("zh"), shape("en"));
}

#[test]
fn every_text_is_listed() {
    let help = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/help");
    let source = fs::read_to_string(help.join("mod.rs")).expect("it is a text");
    let files = fs::read_dir(help.join("texts")).expect("it is a directory");
    for file in files {
        let file = file.expect("it can be read").file_name();
        let name = file.to_str().expect("it is ASCII");
        let name = name.trim_end_matches(".md").trim_end_matches(".zh");
        assert!(source.contains(&format!("\"{name}\"")), "{name}");
    }
}

#[test]
fn summaries_are_short_and_have_no_full_stop() {
    for lang in ["zh", "en"] {
        for (name, help) in helps("-h", lang, 100).iter() {
            let summary = help.lines().next().unwrap_or_default();
            let columns = width(summary);
            assert!(
                (1..=SUMMARY).contains(&columns),
                "{name}: {columns}: {summary}"
            );
            assert!(!summary.ends_with(['.', '。']), "{name}: {summary}");
            assert_eq!(is_chinese(summary), lang == "zh", "{name}: {summary}");
        }
    }
}

#[test]
fn every_command_and_argument_has_both_languages() {
    for (name, help) in helps("-h", "en", 100).iter() {
        assert!(!is_chinese(help), "{name}: {help}");
        // Finds an argument without a description.
        let bare = help.lines().find(|line| {
            line.starts_with("  ") && !line.trim().is_empty() && !line.trim().contains("  ")
        });
        let is_rest = |line: &str| line.starts_with("          ");
        assert!(bare.is_none_or(is_rest), "{name}: {bare:?}");
    }
    for (name, help) in helps("-h", "zh", 100).iter() {
        for line in help.lines().filter(|line| !line.is_empty()) {
            let is_names = |line: &str| line.starts_with("          ");
            assert!(is_chinese(line) || is_names(line), "{name}: {line}");
        }
    }
}

#[test]
fn details_follow_the_options_in_long_help_only() {
    for (lang, options, status, examples) in [
        ("en", "Global options:", "Exit status:", "Examples:"),
        ("zh", "全局选项：", "退出码：", "示例："),
    ] {
        let long = run(&in_language(&["check", "--help"], lang))
            .expect(0)
            .stdout;
        let places = [options, status, examples].map(|title| long.find(&format!("\n{title}\n")));
        assert!(
            places.is_sorted() && places.iter().all(Option::is_some),
            "{long}"
        );
        let short = run(&in_language(&["check", "-h"], lang)).expect(0).stdout;
        assert!(short.contains(options), "{short}");
        assert!(
            !short.contains(status) && !short.contains(examples),
            "{short}"
        );
        assert!(long.starts_with(short.trim_end()), "{short}");
        let same = run(&in_language(&["help", "check"], lang)).expect(0).stdout;
        assert_eq!(same, long);
    }
}

#[test]
fn each_global_option_has_one_line() {
    for (lang, title) in [("en", "Global options:"), ("zh", "全局选项：")] {
        for (name, help) in helps("--help", lang, 80).iter() {
            let lines = section(help, title);
            let expected = if name.is_empty() { 7 } else { 6 };
            assert_eq!(lines.len(), expected, "{name}: {lines:?}");
        }
    }
}

/// Every line except code fits the terminal, and no paragraph is wrapped twice.
#[test]
fn help_fits_the_terminal() {
    for lang in ["en", "zh"] {
        for columns in [60, 80] {
            for (name, help) in helps("--help", lang, columns).iter() {
                let is_code = |line: &str| {
                    let code = [
                        "Usage:",
                        "用法：",
                        "fcproto ",
                        "git ",
                        "cd ",
                        "lint:",
                        "levels:",
                    ];
                    code.iter().any(|it| line.trim_start().starts_with(it))
                };
                for line in help.lines().filter(|line| !is_code(line)) {
                    assert!(width(line) <= columns, "{name} in {columns}: {line}");
                }
            }
        }
    }
    let wide = run_in(200, &["check", "--help"]).expect(0).stdout;
    assert!(wide.lines().all(|line| width(line) <= 100), "{wide}");
    // A paragraph that is wrapped twice has a short line before its last one.
    let helps = helps("--help", "en", 80);
    let (_, help) = helps.last().expect("the program's own");
    let paragraph = help
        .split("\n\n")
        .find(|it| it.starts_with("The spec is"))
        .expect("it");
    let lines: Vec<_> = paragraph.lines().collect();
    let (_, full) = lines.split_last().expect("lines");
    assert!(full.iter().all(|line| width(line) > 60), "{paragraph}");
}

#[test]
fn help_follows_the_language() {
    let zh = run(&["--lang=zh", "check", "--help"]).expect(0);
    assert!(
        zh.stdout
            .starts_with("检查规范中的错误\n\n用法：fcproto check [选项]\n"),
        "{zh:#?}"
    );
    let mut command = command(&["check", "--help"]);
    let output = command
        .env("LANG", "zh_CN.UTF-8")
        .env("COLUMNS", "100")
        .output();
    let by_locale = Run::new(&output.expect("the command can be run")).expect(0);
    assert_eq!(by_locale.stdout, zh.stdout);
    let en = run(&["check", "--help"]).expect(0);
    assert!(
        en.stdout
            .starts_with("Check the spec for errors\n\nUsage: fcproto check"),
        "{en:#?}"
    );
}

#[test]
fn usage_errors_have_both_languages() {
    let cases: [(&[&str], &str, &str); 17] = [
        (
            &["chekc"],
            "没有命令 `chekc`",
            "there is no command `chekc`",
        ),
        (
            &["chekc"],
            "提示：是否想写 `check`、",
            "tip: did you mean `check`, ",
        ),
        (
            &["check", "--fromat", "json"],
            "没有参数 `--fromat`",
            "unexpected argument `--fromat`",
        ),
        (
            &["check", "--fromat", "json"],
            "是否想写 `--format`？",
            "did you mean `--format`?",
        ),
        (
            &["check", "spec"],
            "没有参数 `spec`",
            "unexpected argument `spec`",
        ),
        (
            &["check", "spec"],
            "\n用法：fcproto check [选项]\n",
            "\nUsage: fcproto check [OPTIONS]\n",
        ),
        (
            &["new"],
            "缺少参数 `--group <GROUP>`、`<NAME>`",
            "missing argument `--group <GROUP>`, `<NAME>`",
        ),
        (
            &["generate", "--for", "x"],
            "缺少参数 `--out <DIR>`",
            "missing argument `--out <DIR>`",
        ),
        (
            &["check", "--format", "xml"],
            "`--format <FORMAT>` 的值 `xml` 无效；可用的值：`text`、`json`、`sarif`、`github`",
            "invalid value `xml` for `--format <FORMAT>`; the values are `text`, `json`, `sarif`, `github`",
        ),
        (
            &["check", "--format"],
            "`--format <FORMAT>` 缺少值",
            "`--format <FORMAT>` needs a value",
        ),
        (
            &["lint", "--today", "x"],
            "日期的写法应如 2026-12-31",
            "a day is written like 2026-12-31",
        ),
        (
            &["codes", "0x12345"],
            "功能码应为 0x0000 至 0xFFFF 的数",
            "a code is a number",
        ),
        (
            &["settle", "C1", "--set", "x", "--by", "y"],
            "应写作 PATH=VALUE",
            "write it as PATH=VALUE",
        ),
        (
            &["release", "x"],
            "版本号应为",
            "a release has a number of up to",
        ),
        (
            &["new", "x", "--group", "y", "--stream", "--report"],
            "`--stream` 不能与 `--report` 同时使用",
            "`--stream` cannot be used with `--report`",
        ),
        (
            &["check", "--fix", "--fix"],
            "`--fix` 只能出现一次",
            "`--fix` can be used only once",
        ),
        (
            &[
                "git", "diff", "1", "2", "3", "4", "5", "6", "7", "8", "9", "10",
            ],
            "`[VERSIONS]...` 的值过多：`10`",
            "too many values for `[VERSIONS]...`: `10`",
        ),
    ];
    for (args, zh, en) in cases {
        for (lang, expected, start) in [("zh", zh, "错误："), ("en", en, "error: ")] {
            let run = run(&[&["--lang", lang], args].concat()).expect(2);
            assert!(run.stderr.contains(expected), "{args:?}: {run:#?}");
            assert!(run.stderr.starts_with(start), "{args:?}: {run:#?}");
            assert!(run.stderr.contains("--help"), "{args:?}: {run:#?}");
            assert_eq!(is_chinese(&run.stderr), lang == "zh", "{args:?}: {run:#?}");
            assert_eq!(run.stdout, "");
        }
    }
}

/// `--lang` applies at any position, even if the rest cannot be parsed.
#[test]
fn language_is_known_before_the_rest_is_parsed() {
    for args in [
        &["chekc", "--lang", "zh"][..],
        &["--lang=zh", "chekc"],
        &["check", "--nope", "--lang", "zh"],
    ] {
        let run = run(args).expect(2);
        assert!(run.stderr.starts_with("错误："), "{args:?}: {run:#?}");
    }
    let unknown = run(&["check", "--lang", "de"]).expect(2);
    assert!(unknown.stderr.contains("`zh`, `en`"), "{unknown:#?}");
    let literal = run(&["check", "--", "--lang", "zh"]).expect(2);
    assert!(literal.stderr.starts_with("error: "), "{literal:#?}");
}

#[test]
fn no_command_shows_help_as_an_error() {
    for (args, lang, start) in [
        (&[][..], "en", "Check a robot protocol spec"),
        (&[], "zh", "检查机器人协议规范"),
        (&["git"], "zh", "让 git 合并"),
    ] {
        let mut command = command(args);
        if lang == "zh" {
            command.env("LANG", "zh_CN.UTF-8");
        }
        let run = Run::new(&command.output().expect("the command can be run")).expect(2);
        assert!(run.stderr.starts_with(start), "{run:#?}");
        assert_eq!(run.stdout, "");
    }
}

#[test]
fn completions_and_manual_pages_follow_the_language() {
    let words = command(&["--", "fcproto", "ch"])
        .env("COMPLETE", "fish")
        .env("LC_ALL", "zh_CN.UTF-8")
        .output();
    let words = Run::new(&words.expect("the command can be run")).expect(0);
    assert!(words.stdout.contains("检查规范中的错误"), "{words:#?}");
    let project = crate::support::Project::empty();
    project.fc(&["man", "man1", "--lang", "zh"]).expect(0);
    let page = project.read("man1/fcproto-check.1");
    assert!(
        page.contains("检查规范中的错误") && page.contains("输出格式"),
        "{page}"
    );
    assert!(!page.contains('\u{1b}'), "{page}");
}
