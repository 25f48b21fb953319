"""Tests the packages of other specs: an odd one, two small ones, and one that changes.

It needs the generator, built with `cargo build -p fc-cli` or named by `FC`, and g++ and clang-format.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

CHECKS = Path(__file__).resolve().parent
PACKAGE = CHECKS.parent
ROOT = PACKAGE.parents[1]
FC = os.environ.get("FC", str(ROOT / "target/debug/fcproto"))
# Compilers and CMake default to GNU C++. Only there, `linux` is a macro.
STRICT = "-std=gnu++17 -O0 -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror".split()
ASIO = "-DASIO_STANDALONE -DASIO_NO_DEPRECATED -DASIO_DISABLE_STD_ALIGNED_ALLOC".split()


def run(*command: object, folder: Path | None = None) -> tuple[bool, str]:
    words = [str(word) for word in command]
    done = subprocess.run(words, capture_output=True, text=True, check=False, cwd=folder)
    return done.returncode == 0, done.stdout + done.stderr


class Project:
    """A spec in its own folder, with its generated package."""

    def __init__(self, name: str, options: str = "") -> None:
        self.folder = Path(tempfile.mkdtemp())
        self.generated = self.folder / "out/generated"
        config = f"targets: {{ cpp: {{ out: out{options} }} }}\n"
        (self.folder / "fc.yaml").write_text(config, encoding="utf-8")
        shutil.copytree(ROOT / f"fc-generated/tests/{name}/spec", self.folder / "spec")

    def generate(self) -> None:
        ok, text = run(FC, "generate", "--root", self.folder)
        assert ok, text

    def edit(self, file: str, *changes: tuple[str, str]) -> None:
        path = self.folder / "spec" / file
        text = path.read_text(encoding="utf-8")
        for before, after in changes:
            assert before in text, before
            text = text.replace(before, after)
        path.write_text(text, encoding="utf-8")

    def compile(self, *options: object) -> tuple[bool, str]:
        include = ("-I", self.generated / "include", "-I", PACKAGE / "include")
        return run("g++", *STRICT, *include, *options, folder=self.folder)

    def sources(self, least: int) -> Path:
        """Joins the generated sources into one file, which compiles much faster."""
        sources = sorted(self.generated.glob("src/**/*.cpp"))
        assert len(sources) >= least, sources
        path = self.folder / "sources.cpp"
        path.write_text("".join(f'#include "{source}"\n' for source in sources), encoding="utf-8")
        return path

    def remove(self) -> None:
        shutil.rmtree(self.folder)


class Package(unittest.TestCase):
    """The generated package, with the runtime of this package."""

    runtime: Path

    @classmethod
    def setUpClass(cls) -> None:
        folder = Path(tempfile.mkdtemp())
        cls.addClassCleanup(shutil.rmtree, folder)
        cls.runtime = folder / "runtime.o"
        every = [*sorted(PACKAGE.glob("src/*.cpp")), *sorted(PACKAGE.glob("src/net/*.cpp"))]
        source = folder / "runtime.cpp"
        source.write_text("".join(f'#include "{path}"\n' for path in every), encoding="utf-8")
        ok, text = run("g++", *STRICT, *ASIO, "-I", PACKAGE / "include", "-c", source, "-o", cls.runtime)
        assert ok, text

    def package(self, project: Project, least: int) -> tuple[object, ...]:
        """Compiles the generated package, and returns it with the runtime for linking."""
        package = project.folder / "package.o"
        ok, text = project.compile("-c", project.sources(least), "-o", package)
        self.assertTrue(ok, text)
        return package, self.runtime, "-lz", "-pthread"

    def runs(self, project: Project, package: tuple[object, ...], source: Path, *arguments: object) -> None:
        program = project.folder / source.stem
        ok, text = project.compile(source, *package, "-I", PACKAGE / "tests", "-o", program)
        self.assertTrue(ok, text)
        ok, text = run(program, *arguments)
        self.assertTrue(ok, text)

    def test_difficult_names_and_prose_compile(self) -> None:
        project = Project("odd")
        self.addCleanup(project.remove)
        shutil.copytree(CHECKS / "course", project.folder / "spec/commands", dirs_exist_ok=True)
        project.generate()
        headers = sorted(project.generated.glob("include/**/*.hpp"))
        style = f"--style=file:{PACKAGE / '.clang-format'}"
        ok, text = run("clang-format", style, "--dry-run", "-Werror", *headers)
        self.assertTrue(ok, text)
        self.runs(project, self.package(project, 12), CHECKS / "course.cpp")
        ok, text = project.compile("-fsyntax-only", project.folder / "out/tests/samples.cpp")
        self.assertTrue(ok, text)
        # The warning at a withdrawn command states the reason and the replacement.
        user = project.folder / "withdrawn.cpp"
        user.write_text('#include "odd_line/client.hpp"\nauto drive = &odd_line::Client::drive;\n', encoding="utf-8")
        ok, text = project.compile("-fsyntax-only", user)
        self.assertFalse(ok)
        self.assertIn('since 2021-01: Not "used" \\ any more. Use `float` instead.', text.replace('\\"', '"'))

    def test_other_protocols_pass_messages_and_samples(self) -> None:
        for name, least in (("meter", 300), ("beacon", 30)):
            with self.subTest(name):
                project = Project(name)
                self.addCleanup(project.remove)
                project.generate()
                package = self.package(project, 4)
                # The vector test includes the protocol by its name in this package.
                shim = project.generated / "include/fc/protocol.hpp"
                shim.parent.mkdir(parents=True)
                shim.write_text(f'#include "{name}/protocol.hpp"\nnamespace fc = {name};\n', encoding="utf-8")
                vectors = ROOT / f"fc-generated/tests/{name}/vectors"
                self.runs(project, package, PACKAGE / "tests/vectors.cpp", vectors, least)
                self.runs(project, package, project.folder / "out/tests/samples.cpp")


    def test_ids_travel_as_their_values_and_do_not_mix(self) -> None:
        project = Project("meter", ", newtypes: true")
        self.addCleanup(project.remove)
        project.generate()
        style = f"--style=file:{PACKAGE / '.clang-format'}"
        headers = sorted(project.generated.glob("include/**/*.hpp"))
        ok, text = run("clang-format", style, "--dry-run", "-Werror", *headers)
        self.assertTrue(ok, text)
        package = self.package(project, 4)
        shim = project.generated / "include/fc/protocol.hpp"
        shim.parent.mkdir(parents=True)
        shim.write_text('#include "meter/protocol.hpp"\nnamespace fc = meter;\n', encoding="utf-8")
        vectors = ROOT / "fc-generated/tests/meter/vectors"
        self.runs(project, package, PACKAGE / "tests/vectors.cpp", vectors, 300)
        self.runs(project, package, project.folder / "out/tests/samples.cpp")
        user = project.folder / "ids.cpp"
        program = """#include <unordered_set>
#include "meter/client.hpp"
std::unordered_set<meter::TariffId> seen;
bool is_new(meter::SetTariffRequest& request) {{
  request.tariff = {};
  return seen.insert(request.tariff_or_default()).second && meter::OperatorId("a") < meter::OperatorId("b");
}}
"""
        for value, is_right in (("meter::TariffId(3)", True), ("3", False), ('meter::OperatorId("3")', False)):
            user.write_text(program.format(value), encoding="utf-8")
            ok, text = project.compile("-fsyntax-only", user)
            self.assertEqual(ok, is_right, text)


class Readme(unittest.TestCase):
    """The samples in the README of both languages."""

    def test_they_compile(self) -> None:
        include = ("-I", PACKAGE / "generated/include", "-I", PACKAGE / "include")
        for name in ("README.md", "README.zh-CN.md"):
            samples = re.findall(r"```cpp\n(.*?)```", (PACKAGE / name).read_text(encoding="utf-8"), re.DOTALL)
            self.assertEqual(len(samples), 3)
            with tempfile.TemporaryDirectory() as folder:
                source = Path(folder) / "samples.cpp"
                # The samples are separate programs and files, but one compilation is enough.
                source.write_text("".join(samples), encoding="utf-8")
                ok, text = run("g++", *STRICT, *include, "-fsyntax-only", source)
                self.assertTrue(ok, text)


class Lockstep(unittest.TestCase):
    """A program that does not follow a change of the spec does not compile."""

    def setUp(self) -> None:
        self.project = Project("meter")
        self.addCleanup(self.project.remove)

    def checked(self, user: str) -> tuple[bool, str]:
        self.project.generate()
        (self.project.folder / "user.cpp").write_text(user, encoding="utf-8")
        return self.project.compile("-fsyntax-only", "user.cpp")

    def user(self) -> str:
        return (CHECKS / "user.cpp").read_text(encoding="utf-8")

    def test_a_program_that_follows_the_spec(self) -> None:
        self.assertEqual(self.checked(self.user()), (True, ""))

    def test_a_change_that_it_does_not_follow(self) -> None:
        for said, *changes in (
            ("watts", ("W: { type: f64, name: watts", "W: { type: f64, name: kilo")),
            ("note", ('      note: { type: "string?"', '      memo: { type: "string?"')),
            ("closed", ("      closed: { type: bool, wire: number, zh: 已合闸, en: Whether the switch is closed }\n", "")),
            (
                "price",
                (', wire: string, min: 1, max: 99999, default: 100, example: "120"', ""),
                ('      price: { type: "u32?"', '      price: { type: "[u8]?"'),
            ),
            ("Day", ("1: { name: day, start", "1: { name: light, start"), ("then: [day]", "then: [light]")),
            ("watch_load", ("  watch_load:", "  see_load:"), ("by: watch_load", "by: see_load")),
        ):
            with self.subTest(said):
                project = self.project
                self.project = Project("meter")
                self.addCleanup(self.project.remove)
                self.project.edit("commands/power.yaml", *changes)
                ok, text = self.checked(self.user())
                self.assertFalse(ok)
                self.assertIn(said, text)
                self.project = project

    def test_added_command_exists_and_robot_must_implement_it(self) -> None:
        added = (
            "commands:\n  count_pulses:\n    code: 0x1009\n    zh: 数脉冲\n    en: Count the pulses\n"
            "    effect: read\n    source: { sections: [] }\n"
        )
        self.project.edit("commands/power.yaml", ("commands:\n", added))
        ok, text = self.checked(self.user())
        self.assertFalse(ok)
        self.assertIn("count_pulses", text)
        # Replacing one word is enough.
        user = self.user().replace("public meter::Robot", "public meter::PartialRobot") + (
            "\nmeter::CountPulsesResponse count(const meter::Client& client);\n"
            "meter::CountPulsesResponse count(const meter::Client& client) {\n"
            "  return client.count_pulses({}).value_or({});\n}\n"
        )
        self.assertEqual(self.checked(user), (True, ""))


if __name__ == "__main__":
    unittest.main()
