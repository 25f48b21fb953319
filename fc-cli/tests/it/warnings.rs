//! Packages of specs that lack some parts compile without warnings.

use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;

use crate::support::Project;

const COMMANDS: &str = "
commands:
  get_light:
    code: 0x0101
    zh: 读取灯光
    en: Get the light
    effect: read
    source: { sections: [] }
    response:
      brightness: { type: u8, max: 100, unit: \"%\", example: 40, zh: 亮度, en: Brightness }
";

/// Commands without bodies, with errors, and deprecated ones.
const MORE_COMMANDS: &str = "
commands:
  ring:
    code: 0x0103
    zh: 响铃
    en: Ring
    effect: motion
    source: { sections: [] }

  set_light:
    code: 0x0102
    zh: 设置灯光
    en: Set the light
    effect: config
    source: { sections: [] }
    errors: [4]
    request:
      brightness: { type: u8, max: 100, example: 80, zh: 亮度, en: Brightness }

  set_lamp:
    code: 0x0104
    zh: 旧的设置
    en: The old setting
    effect: unknown
    source: { sections: [] }
    deprecated: { zh: 改用别的, en: Use the other, replaced_by: set_light }
    request:
      brightness: { type: \"u8?\", deprecated: { zh: 不再使用, en: No longer used }, zh: 亮度, en: Brightness }
";

const REPORTS: &str = "
reports:
  light_changed:
    code: 0x0201
    zh: 灯光已改变
    en: The light has changed
    source: { sections: [] }
    body:
      brightness: { type: u8, max: 100, example: 80, zh: 亮度, en: Brightness }
";

const EMPTY_REPORT: &str = "
reports:
  light_broke:
    code: 0x0202
    zh: 灯坏了
    en: The light broke
    source: { sections: [] }
";

const FROM_ROBOT: &str = "
streams:
  film:
    code: 0x0105
    zh: 影像
    en: Film
    from: robot
    source: { sections: [] }
    content: image/jpeg
";

const FROM_APP: &str = "
streams:
  sound:
    code: 0x0106
    zh: 声音
    en: Sound
    from: app
    source: { sections: [] }
    body:
      level: { type: u8, example: 1, zh: 音量, en: Level }
";

/// Strings and their replacements.
type Changes = &'static [(&'static str, &'static str)];

/// Names of packages, sections of the group, and changes of `protocol.yaml`.
const SPECS: [(&str, &[&str], Changes); 14] = [
    ("all", &[COMMANDS, REPORTS, FROM_ROBOT], &[]),
    ("more", &[MORE_COMMANDS, EMPTY_REPORT, FROM_APP], &[]),
    ("no_reports", &[COMMANDS], &[]),
    ("no_reports_streams", &[MORE_COMMANDS, FROM_APP], &[]),
    ("no_commands", &[REPORTS], &[]),
    ("only_streams_robot", &[FROM_ROBOT], &[]),
    ("only_streams_app", &[FROM_APP], &[]),
    ("only_empty_report", &[EMPTY_REPORT], &[]),
    ("nothing", &[], &[]),
    (
        "no_envelope",
        &[COMMANDS, REPORTS],
        &[(ENVELOPE, "envelope:\n  request: {}\n  response: {}\n")],
    ),
    (
        "no_envelope_nothing",
        &[],
        &[(ENVELOPE, "envelope:\n  request: {}\n  response: {}\n")],
    ),
    (
        "no_encodings",
        &[COMMANDS],
        &[
            (ENCODINGS, "  encodings: {}\n"),
            (
                "    encoding: { type: u8, role: encoding, zh: 压缩方式, en: Encoding }\n",
                "",
            ),
            (
                "    plainLength: { type: u32, role: plain_length, zh: 压缩前的长度, en: Length before compression }\n",
                "",
            ),
            (
                "    digest: { type: bytes(16), role: digest, zh: 数据区的 MD5, en: MD5 of the data area }\n",
                "",
            ),
        ],
    ),
    (
        "pass_through",
        &[],
        &[(
            RANGES,
            "  ranges:\n    - { from: 0x0300, to: 0x03FF, use: pass_through, zh: 透传, en: Passed through }\n",
        )],
    ),
    (
        "retired",
        &[COMMANDS],
        &[(
            RANGES,
            "  ranges:\n    - { from: 0x0100, to: 0x01FF, use: commands, zh: 指令, en: Commands }\n  retired:\n    - { code: 0x0109, zh: 旧的, en: Old }\n",
        )],
    ),
];

const ENVELOPE: &str = "envelope:
  request:
    sentAt: { type: \"timestamp_ms?\", role: time, example: 1767225600000, zh: 发送时间, en: Time of sending }
  response:
    sentAt: { type: \"timestamp_ms?\", role: time, example: 1767225600000, zh: 发送时间, en: Time of sending }
    result: { type: i32, role: result_code, example: 0, zh: 结果码, en: Result code }
    message: { type: \"string?\", role: result_text, example: 成功, zh: 结果说明, en: Result text }
";

const ENCODINGS: &str = "  encodings:
    0: { name: plain, role: plain, zh: 不压缩, en: Not compressed }
    1: { name: gzip, role: gzip, zh: gzip 压缩, en: Compressed with gzip }
";

const RANGES: &str = "  ranges:
    - { from: 0x0100, to: 0x01FF, use: commands, zh: 指令, en: Commands }
    - { from: 0x0200, to: 0x02FF, use: reports, zh: 主动上报, en: Reports }
";

/// Creates a workspace with a package for each spec.
fn workspace() -> Project {
    let place = Project::empty();
    let mut members = String::new();
    for (name, sections, changes) in SPECS {
        place.fc(&["init", name]).expect(0);
        let path = |path: &str| format!("{name}/{path}");
        for programs in ["examples", "tests/talk.rs"] {
            let programs = place.path(&path(programs));
            if programs.is_dir() {
                std::fs::remove_dir_all(programs).expect("removed");
            } else {
                std::fs::remove_file(programs).expect("removed");
            }
        }
        let group = "group: { id: light, zh: 灯光, en: Light }\n".to_owned();
        let group = group + &sections.concat();
        place.write(&path("spec/commands/light.yaml"), &group);
        let mut protocol = place.read(&path("spec/protocol.yaml"));
        for (old, new) in changes {
            assert!(protocol.contains(old), "{name}: {old}");
            protocol = protocol.replacen(old, new, 1);
        }
        place.write(&path("spec/protocol.yaml"), &protocol);
        let target = format!("targets: {{ rust: {{ out: ., crate: {name} }} }}\n");
        place.write(&path("fc.yaml"), &target);
        place.fc_in(name, &["generate"]).expect(0);
        let manifest = place.read(&path("Cargo.toml"));
        let manifest = manifest.replacen("[workspace]\n\n", "", 1).replacen(
            "\"lamp-protocol\"",
            &format!("{name:?}"),
            1,
        );
        place.write(&path("Cargo.toml"), &manifest);
        // Writing to a String cannot fail.
        let _ = write!(members, "{name:?}, ");
    }
    let workspace = format!("[workspace]\nresolver = \"3\"\nmembers = [{members}]\n");
    place.write("Cargo.toml", &workspace);
    let lock = Path::new(env!("CARGO_MANIFEST_DIR")).join("../Cargo.lock");
    std::fs::copy(lock, place.path("Cargo.lock")).expect("the versions");
    place
}

#[test]
#[ignore = "compiles projects of its own"]
fn specs_without_a_part_compile_without_warnings() {
    let place = workspace();
    for features in [
        &["--all-features", "--all-targets"][..],
        &["--no-default-features"],
        &["--no-default-features", "--features", "client"],
        &["--no-default-features", "--features", "server"],
        &["--no-default-features", "--features", "blocking"],
    ] {
        let output = Command::new(env!("CARGO"))
            .args(["check", "--workspace", "--offline"])
            .args(features)
            .current_dir(place.path(""))
            .env(
                "CARGO_TARGET_DIR",
                Path::new(env!("CARGO_TARGET_TMPDIR")).join("nested"),
            )
            .output()
            .expect("cargo");
        let said = String::from_utf8_lossy(&output.stderr);
        let is_clean = output.status.success() && !said.contains("warning");
        assert!(is_clean, "{features:?}\n{said}");
    }
}
