"""All golden messages of the protocol, read and written with the generated types."""

from __future__ import annotations

import json
import unittest
from typing import Any

import fc
import fc_runtime as rt
from golden import again, check
from support import ROOT


class Vectors(unittest.TestCase):
    def test_every_message(self) -> None:
        accepted, rejected = check(self, fc.FC, ROOT / "fc-generated/vectors")
        self.assertGreater(accepted, 500)
        self.assertGreater(rejected, 1000)

    def test_a_vector_that_says_something_else_is_noticed(self) -> None:
        path = ROOT / "fc-generated/vectors/get_station.json"
        vector: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))["accepted"][0]
        self.assertEqual(again(fc.FC, fc.operations.GET_STATION, vector), vector["body"])
        # The same message under another type.
        with self.assertRaises(rt.BodyError):
            again(fc.FC, fc.operations.RENAME_STATION, vector)


if __name__ == "__main__":
    unittest.main()
