"""Bodies at the edges of JSON are read, refused and written again as `bodies.json` specifies."""

from __future__ import annotations

import unittest
from dataclasses import dataclass, field, make_dataclass
from typing import Annotated, Any

import fc_runtime as rt
from support import holds, load

TYPES: dict[str, Any] = {
    "i8": rt.I8,
    "i16": rt.I16,
    "i32": rt.I32,
    "i64": rt.I64,
    "timestamp_ms": rt.TimestampMs,
    "timestamp_s": rt.TimestampS,
    "u8": rt.U8,
    "u16": rt.U16,
    "u32": rt.U32,
    "u64": rt.U64,
    "f32": rt.F32,
    "f64": rt.F64,
    "string": str,
    "base64": bytes,
    "json": rt.Json,
}


@dataclass(slots=True, kw_only=True)
class OfI32(rt.Message):
    value: Annotated[rt.I32 | None, rt.Key("value")] = None
    extra: rt.Extra = field(default_factory=rt.Extra)


def of_one_key(ty: Any) -> type[rt.Message]:
    return make_dataclass(
        "OfOneKey",
        [
            ("value", Annotated[ty | None, rt.Key("value")], field(default=None)),
            ("extra", rt.Extra, field(default_factory=rt.Extra)),
        ],
        bases=(rt.Message,),
        kw_only=True,
        slots=True,
    )


class Bodies(unittest.TestCase):
    def test_every_body_is_read_as_the_rules_say(self) -> None:
        messages: dict[str, type[rt.Message]] = {name: of_one_key(ty) for name, ty in TYPES.items()}
        messages["object"] = of_one_key(OfI32)
        vectors = load("fc-generated/vectors/bodies.json")
        for wanted, key in (("accepted", "written"), ("rejected", "error")):
            for vector in vectors[wanted]:
                with self.subTest(vector["name"]):
                    try:
                        message = messages[vector["type"]].from_json(bytes.fromhex(vector["bytes"]))
                        found = ("accepted", message.to_json())
                    except rt.BodyError as error:
                        found = ("rejected", error.name)
                    self.assertEqual(found, (wanted, vector[key]))
                    holds("bodies")
        self.assertGreater(len(vectors["accepted"]) + len(vectors["rejected"]), 200)

    def test_depth_is_limited_before_the_stack_is(self) -> None:
        for text in (b'{"x":' + b"[" * 100_000, b'{"x":' + b'{"y":' * 100_000):
            with self.assertRaises(rt.BodyError) as caught:
                OfI32.from_json(text)
            self.assertEqual(caught.exception.name, "too_deep")

    def test_invalid_json_is_reported_before_depth(self) -> None:
        with self.assertRaises(rt.BodyError) as caught:
            OfI32.from_json(b'{"x":01,"y":' + b"[" * 100_000)
        self.assertEqual(caught.exception.name, "bad_json")

    def test_invalid_number_is_reported_before_depth(self) -> None:
        for start in (b"-", b"1", b"0"):
            with self.assertRaises(rt.BodyError) as caught:
                OfI32.from_json(b'{"x":' + b"[" * 63 + start + b"[" * 100)
            self.assertEqual(caught.exception.name, "bad_json", start)

    def test_an_unknown_value_keeps_keys_and_numbers(self) -> None:
        kept = '{"x":[1.0,1E+05,-0,12345678901234567890,{"a":1,"a":1.0}],"x":"\\"\\\\\\n/\\ud800"}'
        spaced = kept.replace(",", " ,\n").replace(":", " : ").replace("/", "\\/").replace('"a"', '"\\u0061"')
        for text in (kept, spaced):
            with self.subTest(text):
                self.assertEqual(OfI32.from_json(text).to_json(), kept)
                self.assertEqual(of_one_key(rt.Json).from_json(f'{{"value":{text}}}').to_json(), f'{{"value":{kept}}}')

    def test_sent_bodies_are_checked(self) -> None:
        for value in (1 << 31, True, "1"):
            message = OfI32(value=value)  # type: ignore[arg-type]
            with self.assertRaises(rt.BodyError):
                message.to_json()

    def test_a_float_is_the_nearest_of_its_type(self) -> None:
        # Half-way between two floats as a double, a little more as a text.
        text = b'{"value":1.00000005960464477540}'
        self.assertEqual(of_one_key(rt.F32).from_json(text).to_json(), '{"value":1.0000001}')


if __name__ == "__main__":
    unittest.main()
