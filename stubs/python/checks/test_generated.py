"""The generator's output for other specs: an odd one, two small ones, and one that changes.

It needs the generator, built with `cargo build -p fc-cli` or named by `FC`. It also needs this Python's `ruff`, `mypy`
and `pyright`.
"""

from __future__ import annotations

import importlib
import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
import warnings
from pathlib import Path
from typing import Any, ClassVar
from unittest.mock import Mock

import fc_runtime as rt
from golden import check

PACKAGE = Path(__file__).resolve().parents[1]
ROOT = PACKAGE.parents[1]
FC = os.environ.get("FC", str(ROOT / "target/debug/fcproto"))
PATIENCE = 60.0

USER = """
import fc_runtime as rt
import meter


class Mine(meter.Robot):
    async def read_power(self, context: rt.Context, request: meter.ReadPowerRequest) -> meter.ReadPowerResponse:
        return meter.ReadPowerResponse(watts=1.5, phases=[], closed=True)

    async def set_tariff(self, context: rt.Context, request: meter.SetTariffRequest) -> meter.SetTariffResponse:
        if request.band is meter.Band.NIGHT:
            raise meter.SetTariffError.LOCKED.refusal()
        return meter.SetTariffResponse()

    async def close_switch(self, context: rt.Context, request: meter.CloseSwitchRequest) -> meter.CloseSwitchResponse:
        return meter.CloseSwitchResponse(job=7)

    async def watch_load(self, context: rt.Context, request: meter.WatchLoadRequest) -> meter.WatchLoadResponse:
        return meter.WatchLoadResponse()


async def use(client: meter.Client) -> float:
    await client.set_tariff(meter.SetTariffRequest(band=meter.Band.DAY, price=3, note="x"))
    async with client.close_switch().follow() as following:
        async for event in following:
            print(event)
    return (await client.read_power()).watts


robot = Mine()
"""


def run(*command: str, path: str = "", folder: Path | None = None) -> tuple[bool, str]:
    env = {**os.environ, "MYPYPATH": path, "PYTHONPATH": path}
    done = subprocess.run(command, capture_output=True, text=True, check=False, env=env, cwd=folder)
    return done.returncode == 0, done.stdout + done.stderr


class Project:
    """A spec in a separate folder, with the files generated from it."""

    def __init__(self, *specs: Path, options: str = "") -> None:
        self.folder = Path(tempfile.mkdtemp())
        self.out = self.folder / "out"
        self.source = self.out / "src"
        (self.folder / "fc.yaml").write_text(f"targets:\n  python: {{ out: out{options} }}\n", encoding="utf-8")
        for spec in specs:
            shutil.copytree(spec, self.folder / "spec", dirs_exist_ok=True)

    def generate(self) -> None:
        ok, text = run(FC, "generate", "--root", str(self.folder))
        assert ok, text

    def edit(self, file: str, before: str, after: str) -> None:
        path = self.folder / "spec" / file
        text = path.read_text(encoding="utf-8")
        assert before in text, before
        path.write_text(text.replace(before, after), encoding="utf-8")

    def mypy(self, *files: str) -> tuple[bool, str]:
        path = f"{PACKAGE / 'src'}:{self.source}"
        cache = Path(tempfile.gettempdir()) / "fc-python-checks-mypy"
        options = ("--strict", "--python-version", "3.10", "--cache-dir", str(cache), "--no-error-summary")
        return run(sys.executable, "-m", "mypy", *options, *files, path=path, folder=self.folder)

    def module(self, name: str) -> Any:
        sys.path.insert(0, str(self.source))
        try:
            return importlib.import_module(name)
        finally:
            sys.path.remove(str(self.source))

    def remove(self) -> None:
        shutil.rmtree(self.folder)


class Course(unittest.IsolatedAsyncioTestCase):
    """Names that are keywords, types and words of the package, and prose that strings could misread."""

    project: ClassVar[Project]

    @classmethod
    def setUpClass(cls) -> None:
        cls.project = Project(ROOT / "fc-generated/tests/odd/spec")
        shutil.copytree(PACKAGE / "checks/course", cls.project.folder / "spec/commands", dirs_exist_ok=True)
        cls.project.generate()
        cls.addClassCleanup(cls.project.remove)

    def test_the_formatter_has_nothing_to_change(self) -> None:
        config = ("--config", str(PACKAGE / "pyproject.toml"), "--no-cache")
        ok, text = run(sys.executable, "-m", "ruff", "format", "--check", "--diff", *config, str(self.project.out))
        self.assertTrue(ok, text)

    def test_the_linter_has_nothing_to_say(self) -> None:
        # Rules that the settings of the package suspend for the words of the spec.
        left = "D210,D400,D415,E501,E741,F403"
        settings = ("--config", str(PACKAGE / "pyproject.toml"), "--no-cache", "--ignore", left)
        ok, text = run(sys.executable, "-m", "ruff", "check", *settings, str(self.project.source))
        self.assertTrue(ok, text)
        tests = ("--extend-ignore", "D,S,I001", str(self.project.out / "tests"))
        ok, text = run(sys.executable, "-m", "ruff", "check", *settings, *tests)
        self.assertTrue(ok, text)

    def test_the_other_type_checker_has_nothing_to_say(self) -> None:
        settings = {
            "include": ["src"],
            "typeCheckingMode": "strict",
            "pythonVersion": "3.10",
            "extraPaths": [str(PACKAGE / "src")],
        }
        path = self.project.out / "pyrightconfig.json"
        path.write_text(json.dumps(settings), encoding="utf-8")
        ok, text = run(sys.executable, "-m", "pyright", "-p", str(path))
        self.assertTrue(ok, text)

    def test_the_type_checker_has_nothing_to_say(self) -> None:
        for what in (["-p", "odd_line"], [str(self.project.out / "tests/test_samples.py")]):
            ok, text = self.project.mypy(*what)
            self.assertTrue(ok, text)

    def test_every_sample_runs(self) -> None:
        path = f"{PACKAGE / 'src'}:{self.project.source}"
        ok, text = run(sys.executable, str(self.project.out / "tests/test_samples.py"), path=path)
        self.assertTrue(ok, text)

    async def test_every_command_is_called(self) -> None:
        odd = self.project.module("odd_line")
        server = rt.Server(
            odd.ExampleRobot(pretend_motion=True),
            rt.ServerConfig(address="127.0.0.1", command_port=0, data_port=0, handler_timeout=PATIENCE),
        )
        await server.bind()
        host, port = server.command_address
        config = rt.ClientConfig(host=host, command_port=port, call_timeout=PATIENCE)
        commands = [command for command in odd.ODD_LINE.commands if command.code is not None]
        async with odd.Client.connect(config) as client:
            for command in commands:
                with self.subTest(command.name):
                    self.assertTrue(hasattr(odd.sync.Client, command.method_name))
                    self.assertTrue(hasattr(odd.Robot, command.method_name))
                    with warnings.catch_warnings():
                        # Warnings about deprecated commands.
                        warnings.simplefilter("ignore", DeprecationWarning)
                        call = getattr(client, command.method_name)(command.request.example())
                    self.assertEqual(await call, command.response.example())
        self.assertGreater(len(commands), 70)
        await server.shutdown(0)

    def test_generated_code_matches_the_spec(self) -> None:
        odd = self.project.module("odd_line")
        # The type of each reserved name, with its name in Python.
        names = {field: field for field in ("dataclass", "annotations", "going")}
        names |= {field: f"{field}_" for field in ("property", "field", "str", "validate", "to_json")}
        request = odd.DriveRequest.example()
        for name in names.values():
            self.assertTrue(hasattr(request, name), name)
        self.assertIs(odd.DriveRequest(mood=odd.Going.MRO, secret="").going_or_default, odd.Going.NAME)
        self.assertEqual(odd.DriveRequest.DEFAULT_FIELD, 7)
        self.assertNotIn("it's", repr(request))
        self.assertIn("it's", request.to_json())
        self.assertEqual(odd.DriveError.of(3), odd.DriveError.EXPIRED)
        # Character classes of patterns match only ASCII.
        for text, is_right in (("a-b-c", True), ("a-b-\u0661", False), ("a-b-\u7ad9", False), ("ab-c", False)):
            request.word = text
            if is_right:
                request.validate()
                continue
            with self.assertRaises(rt.BodyError) as caught:
                request.validate()
            self.assertEqual(caught.exception.name, "bad_pattern")
        # Groups that use each other.
        either = odd.Here.from_json('{"there":[{"either":{"far":1},"going":"z"}]}').there[0].either
        self.assertEqual(either, odd.Far(far=1))
        with self.assertRaises(rt.ConditionError):
            odd.DriveRequest(mood=odd.Going.MRO, secret="").checked()
        self.assertTrue(odd.operations.DRIVE.accepted_in(odd.Going.MRO))
        self.assertFalse(odd.operations.DRIVE.accepted_in(odd.Going.NAME))
        self.assertTrue(odd.Going.NAME.normally_follows(odd.Going.MRO))
        with self.assertWarnsRegex(DeprecationWarning, "Use `float` instead"):
            odd.sync.Client.drive(Mock(), request)


class Names(unittest.TestCase):
    """Attributes of the runtime's classes."""

    def test_names_avoid_those_of_the_runtime(self) -> None:
        bases = (rt.Client, rt.SyncClient, rt.Robot, rt.ExampleRobot, rt.Reporter, rt.Streamer)
        methods = {name for base in bases for name in public(base)}
        # Their constructors set these, so the classes do not have them.
        methods |= {"connection", "server", "protocol"}
        fields = public(rt.Message) | {"extra"}
        self.assertLess({"close", "unknown", "handlers_by_code", "wait"}, methods)
        self.assertLess({"checked", "to_json"}, fields)
        commands = "".join(
            f"  {name}: {{ code: 0x{0x0080 + at:04X}, zh: 名称, en: Name, effect: read, source: {{ sections: [] }} }}\n"
            for at, name in enumerate(sorted(methods))
        )
        asked = "".join(
            f"      {name}: {{ type: bool, example: true, zh: 名称, en: Name }}\n" for name in sorted(fields)
        )
        text = (
            f"group: {{ id: taken, zh: 组, en: Group }}\n\ncommands:\n{commands}  ask:\n    code: 0x00F0\n    zh: 问\n"
            f"    en: Ask\n    effect: read\n    source: {{ sections: [] }}\n    request:\n{asked}"
        )
        project = Project(ROOT / "fc-generated/tests/beacon/spec")
        self.addCleanup(project.remove)
        (project.folder / "spec/commands/taken.yaml").write_text(text, encoding="utf-8")
        project.edit("protocol.yaml", "id: beacon", "id: taken_names")
        project.generate()
        taken = project.module("taken_names")
        called = {command.name: command.method_name for command in taken.TAKEN_NAMES.commands}
        for name in methods:
            self.assertEqual(called[name], f"{name}_")
        request = taken.AskRequest.example()
        for name in fields:
            self.assertTrue(hasattr(request, f"{name}_"), name)


def public(cls: type) -> set[str]:
    return {name for name in dir(cls) if not name.startswith("_")}


class Vectors(unittest.TestCase):
    """The golden messages of two protocols with features that ours lacks."""

    def test_they_are_read_and_written(self) -> None:
        for name, least in (("meter", 300), ("beacon", 30)):
            project = Project(ROOT / f"fc-generated/tests/{name}/spec")
            self.addCleanup(project.remove)
            project.generate()
            protocol = getattr(project.module(name), name.upper())
            with self.subTest(name):
                counts = check(self, protocol, ROOT / f"fc-generated/tests/{name}/vectors")
                self.assertGreater(sum(counts), least)


class Ids(unittest.TestCase):
    """Ids of entities as separate types."""

    def test_id_types_travel_as_values_and_stay_distinct(self) -> None:
        project = Project(options=", newtypes: true")
        self.addCleanup(project.remove)
        shutil.copytree(ROOT / "fc-generated/tests/meter/spec", project.folder / "spec")
        project.edit("protocol.yaml", "id: meter", "id: meter_with_ids")
        project.generate()
        meter = project.module("meter_with_ids")
        counts = check(self, meter.METER_WITH_IDS, ROOT / "fc-generated/tests/meter/vectors")
        self.assertGreater(sum(counts), 300)
        user = "import meter_with_ids as m\n\nm.SetTariffRequest(band=m.Band.DAY, tariff={})\n"
        for value, is_right in (("m.TariffId(3)", True), ("3", False)):
            (project.folder / "user.py").write_text(user.format(value), encoding="utf-8")
            ok, text = project.mypy("user.py")
            self.assertEqual(ok, is_right, text)
        ok, text = project.mypy("-p", "meter_with_ids")
        self.assertTrue(ok, text)
        config = ("--config", str(PACKAGE / "pyproject.toml"), "--no-cache", str(project.out))
        ok, text = run(sys.executable, "-m", "ruff", "format", "--check", "--diff", *config)
        self.assertTrue(ok, text)


class Lockstep(unittest.TestCase):
    """A changed spec is an error in a program that has not followed."""

    def setUp(self) -> None:
        self.project = Project(ROOT / "fc-generated/tests/meter/spec")
        self.addCleanup(self.project.remove)
        (self.project.folder / "user.py").write_text(USER, encoding="utf-8")

    def checked(self) -> tuple[bool, str]:
        self.project.generate()
        return self.project.mypy("user.py")

    def test_a_program_that_follows_the_spec(self) -> None:
        self.assertEqual(self.checked(), (True, ""))

    def test_a_change_that_it_does_not_follow(self) -> None:
        power = "commands/power.yaml"
        for before, after, said in (
            ("W: { type: f64, name: watts, unit: W, example", "W: { type: f64, name: kilo, unit: W, example", "watts"),
            ("      note: { type: \"string?\"", "      memo: { type: \"string?\"", "note"),
            ("      closed: { type: bool", "      shut: { type: bool", "closed"),
            ("      price: { type: \"u32?\"", "      price: { type: \"string?\"", "price"),
            ("1: { name: day, start", "1: { name: light, start", "DAY"),
        ):  # fmt: skip
            with self.subTest(said):
                project = self.project
                self.project = Project(project.folder / "spec")
                self.addCleanup(self.project.remove)
                (self.project.folder / "user.py").write_text(USER, encoding="utf-8")
                if said == "price":
                    after = after.replace('"string?"', '"bool?"')
                    self.project.edit(power, ', wire: string, min: 1, max: 99999, default: 100, example: "120"', "")
                if said == "DAY":
                    self.project.edit(power, "then: [day]", "then: [light]")
                self.project.edit(power, before, after)
                ok, text = self.checked()
                self.assertFalse(ok)
                self.assertIn(said, text)
                self.project = project

    def test_added_command_exists_and_robot_must_implement_it(self) -> None:
        path = self.project.folder / "spec/commands/power.yaml"
        added = (
            "commands:\n  count_pulses:\n    code: 0x1009\n    zh: 数脉冲\n    en: Count the pulses\n"
            "    effect: read\n    source: { sections: [] }\n"
        )
        path.write_text(path.read_text(encoding="utf-8").replace("commands:\n", added, 1), encoding="utf-8")
        ok, text = self.checked()
        self.assertFalse(ok)
        self.assertIn('abstract attribute "count_pulses"', text)
        # One other word is all it takes.
        user = USER.replace("meter.Robot", "meter.PartialRobot") + (
            "\n\nasync def count(client: meter.Client, there: meter.sync.Client) -> None:\n"
            "    a: meter.CountPulsesResponse = await client.count_pulses()\n"
            "    b: meter.CountPulsesResponse = there.count_pulses(meter.CountPulsesRequest(), timeout=1.0)\n"
            "    print(a, b, meter.operations.COUNT_PULSES.effect)\n"
        )
        (self.project.folder / "user.py").write_text(user, encoding="utf-8")
        self.assertEqual(self.checked(), (True, ""))


if __name__ == "__main__":
    unittest.main()
