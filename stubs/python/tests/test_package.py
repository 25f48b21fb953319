"""The generated package as a whole: its examples, tables, names, and the places that its comments point to."""

from __future__ import annotations

import importlib
import inspect
import pkgutil
import unittest

import fc
import fc_runtime as rt
from support import ROOT

MESSAGES = [value for value in vars(fc.messages).values() if isinstance(value, type) and issubclass(value, rt.Message)]
OPERATIONS: list[rt.Command[rt.Message, rt.Message] | rt.Report[rt.Message] | rt.Stream[rt.Message | bytes]] = [
    *fc.FC.commands,
    *fc.FC.reports,
    *fc.FC.streams,
]


class Package(unittest.TestCase):
    def test_every_example_is_what_its_type_demands(self) -> None:
        self.assertGreater(len(MESSAGES), 100)
        for cls in MESSAGES:
            with self.subTest(cls.__name__):
                example = cls.example()
                example.validate()
                self.assertEqual(cls.from_json(example.to_json()), example)
                self.assertEqual(example.extra, rt.Extra())

    def test_every_row_of_a_table_is_what_its_type_demands(self) -> None:
        tables = [table for name, table in inspect.getmembers(fc.tables, inspect.isfunction)]
        self.assertTrue(tables)
        for table in tables:
            rows = table()
            self.assertTrue(rows)
            for row in rows:
                row.validate()
            # Each call returns a new list, so changing one does not change another.
            self.assertIsNot(table()[0], rows[0])

    def test_exported_names_exist(self) -> None:
        for package in (fc, fc.messages):
            names = package.__all__
            self.assertEqual(len(names), len(set(names)))
            for name in names:
                self.assertTrue(hasattr(package, name), name)
        for info in pkgutil.walk_packages(fc.__path__, "fc."):
            module = importlib.import_module(info.name)
            self.assertTrue(module.__doc__, info.name)
            for name, value in vars(module).items():
                if inspect.isclass(value) and value.__module__ == info.name:
                    self.assertTrue(value.__doc__, f"{info.name}.{name}")

    def test_targets_of_comment_links_exist(self) -> None:
        for operation in OPERATIONS:
            with self.subTest(operation.name):
                self.assertTrue((ROOT / operation.spec).is_file())
                self.assertTrue((ROOT / "docs-site" / operation.docs).is_file())
        said = inspect.getdoc(fc.Client.start_recharge) or ""
        self.assertIn("- Docs: `docs-site/en/reference/commands/start_recharge.md`", said)
        self.assertIn("Moves the robot.", said)

    def test_each_command_has_its_methods(self) -> None:
        for command in fc.FC.commands:
            with self.subTest(command.name):
                stubs = (fc.Client, fc.sync.Client, fc.Robot, fc.PartialRobot)
                has = {hasattr(stub, command.method_name) for stub in stubs}
                self.assertEqual(has, {command.code is not None})
        for report in fc.FC.reports:
            self.assertEqual(hasattr(fc.Reporter, report.method_name), report.code is not None)

    def test_blocking_client_has_docstrings(self) -> None:
        for command in fc.FC.commands:
            name = command.method_name
            if command.code is None:
                continue
            for method in (name, *(it for it in dir(fc.sync.Client) if it.startswith(f"follow_{name}"))):
                with self.subTest(method):
                    said = inspect.getdoc(getattr(fc.sync.Client, method)) or ""
                    title, *_ = (inspect.getdoc(getattr(fc.Client, name)) or "").splitlines()
                    self.assertTrue(said.startswith(title), said)
                    self.assertIn(f"- Docs: `docs-site/en/{command.docs}`", said)
                    self.assertIn(f"- 文档：`docs-site/{command.docs}`", said)
        said = inspect.getdoc(fc.sync.Client.start_recharge) or ""
        self.assertIn("Moves the robot.", said)
        self.assertNotIn(".follow()", said)

    def test_a_robot_that_lacks_a_method_cannot_be_made(self) -> None:
        class Lacking(fc.Robot):
            pass

        with self.assertRaisesRegex(TypeError, "get_robot_sn"):
            Lacking()  # type: ignore[abstract]
        fc.PartialRobot()

    def test_absent_fields_have_their_meaning(self) -> None:
        request = fc.SaveMapRequest.example()
        request.tower = None
        self.assertEqual(request.tower_or_default, fc.SaveMapRequest.DEFAULT_TOWER)
        self.assertNotIn("tower", request.to_json())
        request.tower = "A1"
        self.assertEqual(request.tower_or_default, "A1")

    def test_a_value_has_a_name_if_the_protocol_knows_it(self) -> None:
        def said(status: fc.RechargeStatus | rt.Unknown[int]) -> str | int:
            return status.name or status.value

        self.assertEqual(said(fc.RechargeStatus.IDLE), "IDLE")
        self.assertEqual(said(rt.Unknown(200)), 200)

    def test_states_know_their_successors(self) -> None:
        state = fc.RechargeStatus
        self.assertTrue(state.NAVIGATING.normally_follows(state.IDLE))
        self.assertFalse(state.CHARGING.normally_follows(state.IDLE))
        self.assertTrue(fc.RechargeError.FAILED.is_error)


if __name__ == "__main__":
    unittest.main()
