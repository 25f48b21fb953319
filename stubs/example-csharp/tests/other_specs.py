#!/usr/bin/env python3
"""The plugin's output for other specs. The golden frames must also notice errors in the runtime.

It needs the generator, built with `cargo build -p fc-cli` or named by `FC`, and mono.
"""

import json
import os
import re
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

HERE = Path(__file__).resolve().parents[1]
ROOT = HERE.parents[1]
FC = os.environ.get("FC", str(ROOT / "target/debug/fcproto"))
ODD = [ROOT / "fc-generated/tests/odd/spec"]

# Faults to inject: a file of the runtime, a text in it, and its replacement.
BREAKS = [
    ("Numbers.cs", "isFar ? Far :", "isFar ? 7 :"),
    (
        "Numbers.cs",
        "bits % 2 == 1 && AgainstMiddle(exact, power, bits, ",
        "bits % 2 == 0 && AgainstMiddle(exact, power, bits, ",
    ),
    ("Json.cs", "++depth > most", "++depth > most + 1"),
    ("Json.cs", "unit < ' ' || IsHalf(text, at)", "unit < ' '"),
    ("Codecs.cs", "Convert.ToBase64String(bytes) == text", "true"),
    ("Message.cs", "if (seen[index])", "if (seen[index] && json.IsEmpty)"),
    ("Message.cs", "message.Extra.Add(", "new List<KeyValuePair<string, Json>>().Add("),
    ("Bodies.cs", "if (first == null)", "if (true)"),
    ("Frames.cs", "plainLength == 0 && layout.IsZeroWhenPlain", "plainLength == 1"),
    ("GzipMember.cs", "Number(member, member.Length - 8) == Crc(data)", "true"),
]


def run(*command, **env):
    done = subprocess.run(command, capture_output=True, text=True, check=False, env={**os.environ, "FC": FC, **env})
    return done.returncode, done.stdout + done.stderr


class Project:
    """A spec in a separate directory, with its C# and its golden frames."""

    def __init__(self, *specs, here=HERE):
        self.folder = Path(tempfile.mkdtemp())
        self.here = here
        for spec in specs:
            shutil.copytree(spec, self.folder / "spec", dirs_exist_ok=True)
        csharp = f"csharp: {{ plugin: {HERE / 'plugin.py'}, out: generated, options: {{ namespace: Fc }} }}"
        (self.folder / "fc.yaml").write_text(f"targets:\n  vectors: {{ out: vectors }}\n  {csharp}\n", encoding="utf-8")

    def test(self):
        return run(str(self.here / "run"), "test", PROJECT=str(self.folder))

    def program(self, source):
        """Compiles a program with the package. Returns its path, or the compiler's output."""
        (self.folder / "Program.cs").write_text(source, encoding="utf-8")
        program = self.folder / "program.exe"
        status, said = run(
            "mcs",
            "-langversion:7",
            f"-out:{program}",
            "-r:System.Numerics",
            f"-recurse:{HERE}/runtime/*.cs",
            f"-recurse:{self.folder}/generated/*.cs",
            str(self.folder / "Program.cs"),
        )
        return status, said, program

    def __enter__(self):
        return self

    def __exit__(self, *_):
        shutil.rmtree(self.folder)


class OtherSpecs(unittest.TestCase):
    def holds(self, project):
        status, said = project.test()
        self.assertEqual(status, 0, said[-4000:])
        self.assertIn(" 0 do not", said)

    def test_a_command_that_is_added_to_the_spec(self):
        with Project(ROOT / "spec") as project:
            added = project.folder / "spec/commands/added.yaml"
            shutil.copy(HERE / "tests/added.yaml", added)
            self.holds(project)
            user = (HERE / "tests/sample/Added.cs").read_text(encoding="utf-8")
            status, said, program = project.program(user)
            self.assertEqual(status, 0, said)
            status, said = run("mono", str(program))
            wanted = 'measure_added {"mode":"slow","level":3,"word":"abc","secret":"AQ=="} {"mode":"slow","level":3,"word":"abc","secret":"…"}'
            self.assertEqual((status, said.strip()), (0, wanted))
            # A renamed field is an error in a program that uses it.
            added.write_text(
                added.read_text(encoding="utf-8").replace("      level: {", "      height: {"), encoding="utf-8"
            )
            self.holds(project)
            status, said, _ = project.program(user)
            self.assertNotEqual(status, 0)
            self.assertIn("`level'", said)

    def test_protocols_that_share_nothing_with_this_one(self):
        for name in ("meter", "beacon"):
            with self.subTest(name), Project(ROOT / f"fc-generated/tests/{name}/spec") as project:
                self.holds(project)

    def test_names_that_mean_something_elsewhere(self):
        with Project(*ODD) as project:
            self.holds(project)

    def test_names_impossible_in_csharp_change_nothing(self):
        with Project(*ODD) as project:
            added = project.folder / "spec/commands/added.yaml"
            text = (HERE / "tests/added.yaml").read_text(encoding="utf-8")
            for before, after, said in (
                ('"[a-z]+"', '"[[:lower:]]+"', "the pattern `[[:lower:]]+`: .NET has no `[[:`"),
                (
                    "      at: {",
                    "      door1: { type: u8, example: 1, zh: 门, en: Door }\n      door_1: { type: u8, example: 1, zh: 门, en: Door }\n      at: {",
                    "`door1` and `door_1` are both `Door1` in C#",
                ),
            ):
                with self.subTest(said):
                    added.write_text(text.replace(before, after), encoding="utf-8")
                    status, answer = run(FC, "generate", "--root", str(project.folder), "--only", "csharp")
                    self.assertNotEqual(status, 0)
                    self.assertIn(said, answer)
                    self.assertFalse((project.folder / "generated").exists())


class Judge(unittest.TestCase):
    def test_golden_frames_are_judged_as_recorded(self):
        asked = []
        for path in sorted((ROOT / "fc-generated/vectors").glob("*.json")):
            vectors = json.loads(path.read_text(encoding="utf-8"))
            if vectors["operation"] is not None:
                # The others have no operation, and their bodies have no envelope.
                asked += [(one["frame"], "") for one in vectors["accepted"] if "frame" in one]
            asked += [(one["frame"], one["error"]) for one in vectors["rejected"] if "frame" in one]
        with Project(ROOT / "spec") as project:
            self.assertEqual(project.test()[0], 0)
            frames = "".join(f"{frame}\n" for frame, _ in asked)
            judge = subprocess.run(
                [str(HERE / "run"), "judge"],
                input=frames,
                capture_output=True,
                text=True,
                check=True,
                env={**os.environ, "PROJECT": str(project.folder)},
            )
        answers = [json.loads(line) for line in judge.stdout.splitlines()]
        self.assertGreater(len(answers), 2000)
        found = [answer[1] if answer[0] == "refused" else "" for answer in answers]
        self.assertEqual(found, [error for _, error in asked])


class Readme(unittest.TestCase):
    def test_its_program_is_the_one_that_is_run(self):
        program = (HERE / "tests/sample/Sample.cs").read_text(encoding="utf-8")
        for name in ("README.md", "README.zh-CN.md"):
            text = (HERE / name).read_text(encoding="utf-8")
            shown = text.split("```csharp\n")[1].split("```")[0]
            self.assertIn(shown, re.sub(r"(?m)^ {8}", "", program), name)
        with Project(ROOT / "spec") as project:
            status, said = run(FC, "generate", "--root", str(project.folder), "--only", "csharp")
            self.assertEqual(status, 0, said)
            status, said, compiled = project.program(program)
            self.assertEqual(status, 0, said)
            self.assertEqual(run("mono", str(compiled)), (0, "100132001234567\n"))


class Broken(unittest.TestCase):
    def test_golden_frames_notice_defects(self):
        with Project(ROOT / "spec") as project:
            here = project.folder / "stubs/example-csharp"
            shutil.copytree(HERE, here, ignore=shutil.ignore_patterns("build", "generated"))
            shutil.copytree(ROOT / "conformance", project.folder / "conformance")
            project.here = here
            status, said = project.test()
            self.assertEqual(status, 0, said[-4000:])
            for file, before, after in BREAKS:
                path = here / "runtime" / file
                text = path.read_text(encoding="utf-8")
                with self.subTest(file, before=before):
                    self.assertEqual(text.count(before), 1)
                    path.write_text(text.replace(before, after), encoding="utf-8")
                    status, said = project.test()
                    self.assertEqual(status, 1, said[-4000:])
                    self.assertIn("FAILED", said)
                path.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    unittest.main()
