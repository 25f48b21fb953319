"""The examples of the README print the output shown, and both languages have the same ones."""

from __future__ import annotations

import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import fc_runtime

HERE = Path(__file__).resolve().parents[1]
EXAMPLE = re.compile(r"```python\n(.*?)```\n\n```text output\n(.*?)```", re.DOTALL)
# Commands that are shown, but not run here.
SHELL = re.compile(r"```sh\n(.*?)```", re.DOTALL)


def read(name: str) -> str:
    return (HERE / name).read_text(encoding="utf-8")


class Readme(unittest.TestCase):
    def test_each_example_prints_what_it_says(self) -> None:
        text = read("README.md")
        found: list[tuple[str, str]] = EXAMPLE.findall(text)
        self.assertEqual(len(found), text.count("```python"))
        self.assertGreaterEqual(len(found), 3)
        source = Path(fc_runtime.__file__).parents[1]
        for number, (code, output) in enumerate(found, 1):
            with self.subTest(number), tempfile.TemporaryDirectory() as folder:
                program = Path(folder) / "example.py"
                program.write_text(code, encoding="utf-8")
                environment = {"PYTHONPATH": str(source), "PYTHONUTF8": "1"}
                done = subprocess.run(
                    [sys.executable, program], env=environment, capture_output=True, encoding="utf-8", check=False
                )
                self.assertEqual((done.stdout, done.stderr), (output, ""))

    def test_both_languages_show_the_same(self) -> None:
        english, chinese = read("README.md"), read("README.zh-CN.md")
        self.assertEqual(EXAMPLE.findall(english), EXAMPLE.findall(chinese))
        self.assertEqual(SHELL.findall(english), SHELL.findall(chinese))
        self.assertEqual(english.count("\n## "), chinese.count("\n## "))


if __name__ == "__main__":
    unittest.main()
