"""Depth is counted in a hurry where brackets are plain to see, and it comes out as if each had been looked at."""

from __future__ import annotations

import random
import unittest

import fc_runtime as rt
from fc_runtime.document import parse_text


def depth_of(text: str) -> int:
    """How deeply a text is nested that is JSON."""
    deepest = opened = 0
    quoted = escaped = False
    for letter in text:
        if quoted:
            quoted = escaped or letter != '"'
            escaped = letter == "\\" and not escaped
        elif letter == '"':
            quoted = True
        elif letter in "[{":
            opened += 1
            deepest = max(deepest, opened)
        elif letter in "]}":
            opened -= 1
    return deepest


def some(chance: random.Random, levels: int) -> str:
    """A JSON text with brackets in many places."""
    if levels == 0 or chance.random() < 0.2:
        return chance.choice(["1", "null", '""', '"a"', '"[{"', '"]}"', '"\\"["', '"\\\\"', '"门{"', '"\\u005b"'])
    parts = [some(chance, levels - 1) for _ in range(chance.randrange(4))]
    if chance.random() < 0.5:
        return "[" + ",".join(parts) + "]"
    keys = ['"a"', '"{"', '"]["']
    return "{" + ",".join(chance.choice(keys) + ":" + part for part in parts) + "}"


class Depth(unittest.TestCase):
    def test_what_is_too_deep_is_refused_and_nothing_else(self) -> None:
        chance = random.Random(7)
        refused = 0
        for _ in range(3000):
            text = some(chance, chance.randrange(12))
            deep = depth_of(text)
            parse_text(text, depth=max(1, deep))
            for limit in range(1, deep):
                with self.assertRaises(rt.BodyError) as raised:
                    parse_text(text, depth=limit)
                self.assertIs(raised.exception.kind, rt.BodyErrorKind.TOO_DEEP)
                refused += 1
        self.assertGreater(refused, 1000)

    def test_many_brackets_side_by_side_are_not_deep(self) -> None:
        parse_text("[" + ",".join(['{"a":[],"b":{}}'] * 1000) + "]", depth=3)
        with self.assertRaises(rt.BodyError):
            parse_text("[" + ",".join(['{"a":[[]]}'] * 1000) + "]", depth=3)


if __name__ == "__main__":
    unittest.main()
