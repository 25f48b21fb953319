"""Depth and values are counted in one pass that stops at the limit, with the result of a reader of single letters."""

from __future__ import annotations

import random
import unittest

import fc_runtime as rt
from fc_runtime.document import parse_body, parse_text
from support import PROTOCOL

# Longer than one chunk of the survey.
LONG = 70_000


class Reader:
    """A reader that counts like the one of Rust, letter by letter."""

    def __init__(self, text: str, depth: int, values: int) -> None:
        self.text, self.depth, self.values = text, depth, values
        self.at = 0

    def peek(self) -> str:
        while self.at < len(self.text) and self.text[self.at] in " \t\n\r":
            self.at += 1
        return self.text[self.at] if self.at < len(self.text) else ""

    def count(self) -> None:
        self.values -= 1
        if self.values < 0:
            raise ValueError("too_many_values")

    def enter(self) -> None:
        self.depth -= 1
        if self.depth < 0:
            raise ValueError("too_deep")
        self.at += 1

    def leave(self) -> None:
        self.depth += 1
        self.at += 1

    def value(self) -> None:
        letter = self.peek()
        if letter in ("[", "{"):
            self.enter()
            close = "]" if letter == "[" else "}"
            while self.peek() != close:
                if letter == "{":
                    self.string()
                    self.peek()
                    self.at += 1
                self.count()
                self.value()
                if self.peek() == ",":
                    self.at += 1
            self.leave()
        elif letter == '"':
            self.string()
        else:
            while self.at < len(self.text) and self.text[self.at] not in ",]} \t\n\r":
                self.at += 1

    def string(self) -> None:
        self.peek()
        self.at += 1
        while self.text[self.at] != '"':
            self.at += 2 if self.text[self.at] == "\\" else 1
        self.at += 1


def read(text: str, depth: int, values: int) -> str:
    """Returns the error that a reader finds in a JSON text."""
    try:
        Reader(text, depth, values).value()
    except ValueError as error:
        return str(error)
    return ""


def surveyed(text: str, depth: int, values: int) -> str:
    try:
        parse_text(text, depth, values)
    except rt.BodyError as error:
        return error.name
    return ""


def some(chance: random.Random, levels: int) -> str:
    """Returns a JSON text with brackets in many places."""
    space = chance.choice(["", "", "", " ", "\n"])
    if levels == 0 or chance.random() < 0.2:
        texts = [
            "1",
            "null",
            '""',
            '"a"',
            '"[{"',
            '"]},"',
            '"\\"["',
            '"\\\\"',
            '"门{"',
            '"\\u005b"',
            "[]",
            "{ }",
            "[ ]",
        ]
        return space + chance.choice(texts)
    parts = [some(chance, levels - 1) for _ in range(chance.randrange(4))]
    if chance.random() < 0.5:
        return "[" + ",".join(parts) + space + "]"
    keys = ['"a"', '"{"', '"]["', '"\\",["']
    return "{" + space + ",".join(chance.choice(keys) + ":" + part for part in parts) + "}"


class Survey(unittest.TestCase):
    def test_it_finds_what_a_reader_finds(self) -> None:
        chance = random.Random(6)
        found: dict[str, int] = {}
        for _ in range(3000):
            text = some(chance, chance.randrange(10))
            depth, values = chance.randrange(1, 9), chance.choice([1, 2, 5, 20, 1000])
            expected = read(text, depth, values)
            self.assertEqual(surveyed(text, depth, values), expected, text)
            found[expected] = found.get(expected, 0) + 1
        self.assertGreater(min(found["too_deep"], found["too_many_values"], found[""]), 300)

    def test_it_finds_the_same_beyond_the_first_chunk(self) -> None:
        chance = random.Random(7)
        for filler in ('"' + "x" * LONG + '"', '"' + '\\"' * LONG + '"', '"' + "\\\\" * LONG + '"', " " * LONG + "1"):
            for _ in range(10):
                text = "[" + filler + "," + some(chance, 6) + "," + some(chance, 6) + "]"
                for depth, values in ((4, 1000), (9, 12), (9, 3)):
                    self.assertEqual(surveyed(text, depth, values), read(text, depth, values))
        for count in (30_000, 32_767, 32_768):
            for unit in ("[]", "{}", "[ ]", '""', "1", '{"a":[]}', '"\\\\"', '"\\""'):
                text = "[" + ",".join([unit] * count) + "]"
                exact = next(values for values in (count, 2 * count, 3 * count) if not read(text, 9, values))
                self.assertEqual(surveyed(text, 9, exact), "", unit)
                self.assertEqual(surveyed(text, 9, exact - 1), "too_many_values", unit)

    def test_empty_lists_and_objects_hold_no_values(self) -> None:
        for text, values in (("{}", 0), ("[[],{}]", 2), ('{"a":[ ]}', 1), ('[""]', 1), ('{"":{"":[[[]]]}}', 4)):
            self.assertEqual(surveyed(text, 9, max(values, 1)), "")
            if values > 1:
                self.assertEqual(surveyed(text, 9, values - 1), "too_many_values")

    def test_the_first_fault_is_named(self) -> None:
        many, deep = "[" + "1," * 99 + "1]", "[" * 20 + "]" * 20
        for text, name in (
            (f'{{"a":01,"b":{many}}}', "bad_json"),
            (f'{{"a":01,"b":{deep}}}', "bad_json"),
            (f'{{"a":"\\q","b":{deep}}}', "bad_json"),
            (f'{{"a":"\\\\q","b":{deep}}}', "too_deep"),
            (f'{{"a":"\\","b":{deep}}}', "bad_json"),
            (f'{{"a":],"b":{many}}}', "bad_json"),
            (f'{{"b":{many},"a":01}}', "too_many_values"),
            (f'{{"b":{deep},"a":{many}}}', "too_deep"),
            (f'{{"b":{many},"a":{deep}}}', "too_many_values"),
            (f'{{"b":{many},"a', "too_many_values"),
            (f'{{"b":{deep}', "too_deep"),
            ('{"a":"' + "x" * LONG, "bad_json"),
        ):
            self.assertEqual(surveyed(text, 10, 50), name, text[:40])

    def test_no_text_takes_long(self) -> None:
        limits = PROTOCOL.defaults.limits
        most = limits.frame_bytes
        texts: dict[str, tuple[bytes, str]] = {
            "nested lists": (b"{" + b",".join([b'"a":' + b"[" * 60 + b"]" * 60] * 130_000) + b"}", "too_many_values"),
            "nested lists below the limit": (b"{" + b",".join([b'"a":' + b"[" * 60 + b"]" * 60] * 17_000) + b"}", ""),
            "brackets": (b'{"a":' + b"[" * most, "too_deep"),
            "empty objects": (b'{"a":[' + b",".join([b"{}"] * (most // 3)) + b"]}", "too_many_values"),
            "keys": (b"{" + b",".join([b'"":1'] * (most // 5)) + b"}", "too_many_values"),
            "a string without end": (b'{"a":"' + b"x" * most, "bad_json"),
            "escapes without end": (b'{"a":"' + b'\\"' * (most // 2), "bad_json"),
            "escapes and brackets without end": (b"[" * 60 + b'["\\"[{' + b'\\"[' * (most // 3), "bad_json"),
            "backslashes": (b'{"a":"' + b"\\" * most, "bad_json"),
            "backslashes outside": (b'{"a":' + b'\\"' * (most // 2) + b"[" * 99, "bad_json"),
            "quotes": (b'"' * most, "bad_json"),
            "one long string": (b'{"a":"' + b"x" * most + b'"}', ""),
            "space": (b'{"a":' + b" " * most + b"1}", ""),
            "one long number": (b'{"a":' + b"1" * most + b"}", ""),
        }
        for name, (text, expected) in texts.items():
            with self.subTest(name):
                # Some of them once took hours: the time limit of all tests guards against that.
                self.assertEqual(body(text), expected)

    def test_depth_has_a_bound_whatever_is_configured(self) -> None:
        for depth in (127, 128, 100_000):
            self.assertEqual(surveyed("[" * 127 + "]" * 127, depth, 1000), "")
            self.assertEqual(surveyed("[" * 128 + "]" * 128, depth, 1000), "too_deep")
            self.assertEqual(surveyed("[" * 100_000, depth, 1 << 20), "too_deep")
        deep: object = []
        for _ in range(100_000):
            deep = [deep]
        with self.assertRaises(rt.BodyError) as refused:
            rt.Json.of(deep)  # type: ignore[arg-type]
        self.assertEqual(refused.exception.name, "too_deep")
        with self.assertRaises(rt.BodyError):
            rt.Extra({"x": deep})  # type: ignore[dict-item]


def body(data: bytes) -> str:
    limits = PROTOCOL.defaults.limits
    try:
        parse_body(data, limits.json_depth, limits.json_values)
    except rt.BodyError as error:
        return error.name
    return ""


if __name__ == "__main__":
    unittest.main()
