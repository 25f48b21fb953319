"""Patterns match as `conformance/patterns.json` specifies, in all languages."""

from __future__ import annotations

import unittest

from fc_runtime.constraints import constraint
from fc_runtime.errors import BodyError
from fc_runtime.message import Key
from support import holds, load


class Patterns(unittest.TestCase):
    def test_texts_match_or_are_refused(self) -> None:
        for pattern in load("conformance/patterns.json"):
            if pattern.get("refused"):
                continue
            check = constraint(Key("text", pattern=pattern["portable"]))
            assert check is not None
            for verdict in ("matches", "refuses"):
                for text in pattern[verdict]:
                    with self.subTest(pattern["pattern"], text=text):
                        if verdict == "matches":
                            check(text)
                        else:
                            self.assertRaises(BodyError, check, text)
                        holds("patterns")


if __name__ == "__main__":
    unittest.main()
