"""The example of the README does what it says."""

from __future__ import annotations

import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import fc_runtime

README = Path(__file__).resolve().parents[1] / "README.md"


class Readme(unittest.TestCase):
    def test_the_example_prints_what_it_says(self) -> None:
        text = README.read_text(encoding="utf-8")
        found = re.search(r"```python\n(.*?)```\n\n```text output\n(.*?)```", text, re.DOTALL)
        assert found is not None
        with tempfile.TemporaryDirectory() as folder:
            program = Path(folder) / "example.py"
            program.write_text(found.group(1), encoding="utf-8")
            source = Path(fc_runtime.__file__).parents[1]
            done = subprocess.run(
                [sys.executable, program], env={"PYTHONPATH": str(source)}, capture_output=True, text=True, check=False
            )
        self.assertEqual((done.stdout, done.stderr), (found.group(2), ""))


if __name__ == "__main__":
    unittest.main()
