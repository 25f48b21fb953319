//! `fcproto questions` and `fcproto settle`.

use crate::support::Project;

/// A separate group, so that the tests do not depend on the open questions of the spec.
const GROUP: &str = "\
group: { id: asked, zh: 待问, en: Asked }
commands:
  switch_lamp:
    code: unassigned
    zh: 开关灯
    en: Switch the lamp
    effect: unknown
    source: { sections: [] }
    request:
      delay: { type: u32, example: 1, zh: 延时, en: Delay }
    answers:
      - ids: [C901]
        as: question
        about: { request.delay.unit: absent }
        zh: 延时的单位是什么？
        en: Which unit has the delay?
      - ids: [C902]
        as: question
        zh: 断电后灯会怎样？
        en: What happens to the lamp without power?
      - ids: [C903]
        as: decision
        zh: 灯默认关闭。
        en: The lamp is off at first.
conflicts:
  C901: { category: fields, severity: high, zh: 没写单位, en: No unit is given }
  C902: { category: fields, severity: low, zh: 没写断电后的行为, en: Nothing is said of power }
  C903: { category: fields, severity: low, zh: 没写初始状态, en: Nothing is said of the beginning }
";

const LAMP: &str = "spec/commands/asked.yaml";

fn project() -> Project {
    let project = Project::new();
    project.write(LAMP, GROUP);
    project
}

#[test]
fn questions_are_grouped_by_their_consequence() {
    let run = project().fc(&["questions", "--group", "asked"]).expect(0);
    let expected = "\
No code: cannot be called (1)

  switch_lamp.code · Switch the lamp · spec/commands/asked.yaml:3
    The source gives no code. Which is it?
    [code: open]

Unknown effect (1)

  switch_lamp.effect · Switch the lamp · spec/commands/asked.yaml:3
    The source does not say what it does to the robot. Which effect is it?
    [effect: open]

Values that may be misread (1)

  C901 · Switch the lamp · spec/commands/asked.yaml:12
    Which unit has the delay?
    [request.delay.unit: absent]

Behaviour that is not described (1)

  C902 · Switch the lamp · spec/commands/asked.yaml:17
    What happens to the lamp without power?

";
    assert_eq!(run.stdout, expected);
    assert_eq!(run.stderr, "");
}

#[test]
fn questions_list_decisions_and_show_lines() {
    let project = project();
    let args = [
        "questions",
        "--group",
        "asked",
        "--decisions",
        "--format",
        "markdown",
        "--lang",
        "zh",
    ];
    let run = project.fc(&args).expect(0);
    assert!(run.stdout.contains("## 已按决定执行"), "{run:#?}");
    let line = "- **C903** · 开关灯：灯默认关闭。\n";
    assert!(run.stdout.contains(line), "{run:#?}");
    let run = project.fc(&["questions", "C901"]).expect(0);
    let line = "+      delay: { type: u32, unit: …, example: 1, zh: 延时, en: Delay }\n";
    assert!(run.stdout.contains(line), "{run:#?}");
}

#[test]
fn settled_answer_is_written_and_confirmed() {
    let project = project();
    let args = [
        "settle",
        "C901",
        "--unit",
        "ms",
        "--by",
        "张伟",
        "--date",
        "2026-11-23",
    ];
    let run = project.fc(&args).expect(0);
    assert!(run.stdout.contains("settled C901"), "{run:#?}");
    let expected = GROUP
        .replace("type: u32,", "type: u32, unit: ms,")
        .replace(
            "        about: { request.delay.unit: absent }\n",
            "        about: { request.delay.unit: absent }\n        confirmed: { by: 张伟, date: 2026-11-23 }\n",
        );
    assert_eq!(project.read(LAMP), expected);
    project.fc(&["generate"]).expect(0);
    for (page, word) in [
        (
            "docs-site/reference/open-questions.md",
            "张伟 于 2026-11-23 确认",
        ),
        (
            "docs-site/en/reference/open-questions.md",
            "confirmed by 张伟 on 2026-11-23",
        ),
        (
            "docs-site/en/reference/commands/switch_lamp.md",
            "confirmed by 张伟 on 2026-11-23",
        ),
    ] {
        assert!(project.read(page).contains(word), "{page}");
    }
    let run = project.fc(&["questions", "--state", "confirmed"]).expect(0);
    assert!(
        run.stdout.contains("confirmed by 张伟 on 2026-11-23"),
        "{run:#?}"
    );
}

#[test]
fn answer_that_breaks_the_spec_writes_nothing() {
    let project = project();
    for (args, why) in [
        // This code is in no range.
        (vec!["switch_lamp.code", "--code", "0xFFFF"], "FC0303"),
        (vec!["C901", "--unit", "parsec"], "FC"),
        (
            vec!["C901", "--code", "0x0001"],
            "C901 is about request.delay.unit, not about `code`",
        ),
        (
            vec!["C901", "--confirm"],
            "C901 needs a value for request.delay.unit",
        ),
        (vec!["C901"], "there is no answer"),
        (vec!["C999", "--confirm"], "there is no question C999"),
    ] {
        let args: Vec<&str> = ["settle"]
            .into_iter()
            .chain(args)
            .chain(["--by", "x"])
            .collect();
        let run = project.fc(&args).expect(2);
        assert!(run.stderr.contains(why), "{run:#?}");
        assert_eq!(project.read(LAMP), GROUP, "{args:?}");
    }
    let args = ["settle", "C902", "--confirm", "--by", "x", "--dry-run"];
    let run = project.fc(&args).expect(0);
    assert!(run.stdout.contains("would settle C902"), "{run:#?}");
    assert_eq!(project.read(LAMP), GROUP);
}

/// Fills a sheet with these answers, by ID.
fn filled(sheet: &str, answers: &[(&str, &str)]) -> String {
    let lines = sheet.lines().map(|line| {
        let id = line.split(',').next().unwrap_or_default();
        let answer = answers.iter().find(|(of, _)| *of == id);
        answer.map_or(line.to_owned(), |(_, answer)| {
            // The answer, its author, its date and its reference are the last columns.
            let (rest, _) = line.rsplit_once(",,,,").expect("empty columns");
            format!("{rest},{answer},李娜,2026-11-22,邮件")
        })
    });
    lines.collect::<Vec<_>>().join("\r\n")
}

#[test]
fn a_sheet_goes_out_and_comes_back() {
    for lang in ["zh", "en"] {
        let project = project();
        let args = [
            "questions",
            "--group",
            "asked",
            "--format",
            "csv",
            "--lang",
            lang,
            "--decisions",
        ];
        let sheet = project.fc(&args).expect(0).stdout;
        let answers = [
            ("C901", "ms"),
            ("C902", "灯会熄灭"),
            ("C903", "ok"),
            ("switch_lamp.effect", "config"),
        ];
        project.write("answers.csv", &filled(&sheet, &answers));
        project.fc(&["settle", "--from", "answers.csv"]).expect(0);
        let lamp = project.read(LAMP);
        for line in [
            "    effect: config\n",
            "unit: ms",
            "confirmed: { by: 李娜, date: 2026-11-22, reference: 邮件, reply: 灯会熄灭 }\n",
        ] {
            assert!(lamp.contains(line), "{lamp}");
        }
        assert_eq!(lamp.matches("confirmed:").count(), 4, "{lamp}");
        // The second run skips settled questions.
        let run = project.fc(&["settle", "--from", "answers.csv"]).expect(2);
        assert!(run.stderr.contains("answers no open question"), "{run:#?}");
    }
}

#[test]
fn sheet_with_an_invalid_line_settles_nothing() {
    let project = project();
    let sheet = project
        .fc(&["questions", "--group", "asked", "--format", "csv"])
        .expect(0)
        .stdout;
    let good = filled(&sheet, &[("C901", "ms"), ("C902", "it goes out")]);
    for (sheet, why) in [
        (
            good.replace("without power?", "without light?"),
            "has changed since the export",
        ),
        (good.replace("C902,", "C909,"), "there is no such question"),
        (good.replace("李娜", ""), "`by` is empty"),
        (good.replace("answer", "reply"), "no column `answer`"),
        (good.replace(",ms,", ",parsec,"), "FC"),
        ("\u{feff}".to_owned(), "no column `id`"),
    ] {
        project.write("answers.csv", &sheet);
        let run = project.fc(&["settle", "--from", "answers.csv"]).expect(2);
        assert!(run.stderr.contains(why), "{why}: {run:#?}");
        assert_eq!(project.read(LAMP), GROUP, "{why}");
    }
    project.write("answers.csv", &good.replace("C902,", "C909,"));
    let arguments = ["--lang", "zh", "settle", "--from", "answers.csv"];
    let run = project.fc(&arguments).expect(2);
    assert!(run.stderr.contains("行（C909）：没有这个问题"), "{run:#?}");
}
