"""All golden bodies against the codec, with message types that are made here from the spec as data."""

from __future__ import annotations

import json
import sys
import unittest
from dataclasses import field, make_dataclass
from enum import Enum
from typing import Annotated, Any, Union

import fc_runtime as rt
from fc_runtime.enveloped import read_with_envelope, write_with_envelope
from support import PROTOCOL, ROOT, load

SCALARS: dict[str, Any] = {
    "bool": bool, "string": str, "base64": bytes, "json": rt.Json, "f32": rt.F32, "f64": rt.F64,
    "i8": rt.I8, "i16": rt.I16, "i32": rt.I32, "i64": rt.I64, "u8": rt.U8, "u16": rt.U16, "u32": rt.U32, "u64": rt.U64,
}  # fmt: skip


def number(text: str | None) -> float | None:
    return None if text is None else float(text) if "." in text or "e" in text else int(text)


# The type checkers want the name of an enum as a literal.
functional: Any = Enum


class Types:
    """The types of the spec, each made when it is first asked for."""

    def __init__(self, spec: dict[str, Any]) -> None:
        self.spec = spec
        self.made: dict[str, Any] = {}
        self.enums: dict[str, type[Enum]] = {}

    def named(self, name: str) -> Any:
        if name not in self.made:
            shape = self.spec["types"][name]
            make = {"struct": self.struct, "enum": self.enum, "one_of": self.choice}[shape["is"]]
            self.made[name] = make(name, shape)
        return self.made[name]

    def struct(self, name: str, shape: dict[str, Any]) -> Any:
        members: list[Any] = []
        for index, one in enumerate(shape["fields"]):
            ty: Any = self.of(one["type"])
            if one["optional"]:
                members.append((f"f{index}", Annotated[ty | None, self.key(one)], field(default=None)))
            else:
                members.append((f"f{index}", Annotated[ty, self.key(one)]))
        members.append(("extra", rt.Extra, field(default_factory=rt.Extra)))
        return make_dataclass(name, members, bases=(rt.Message,), kw_only=True, slots=True)

    def key(self, one: dict[str, Any]) -> rt.Key:
        only: tuple[Enum, ...] = ()
        if one.get("only"):
            enum = self.enum_of(one["type"])
            only = tuple(member for member in enum if str(member.value) in one["only"])
        form = rt.Form.STRING if one["wireString"] else rt.Form.NUMBER if one.get("wireNumber") else rt.Form.PLAIN
        return rt.Key(
            one["key"], also=tuple(one["also"]), min=number(one["min"]), max=number(one["max"]),
            length=None if one["length"] is None else (one["length"][0], one["length"][1]), pattern=one["pattern"],
            only=only, form=form, lenient_number=one["lenientNumber"], lenient_bool=one["lenientBool"],
            empty_is_absent=one["emptyIsAbsent"],
        )  # fmt: skip

    def enum_of(self, ty: dict[str, Any]) -> type[Enum]:
        while ty["is"] == "array":
            ty = ty["of"]
        self.named(ty["name"])
        return self.enums[ty["name"]]

    def enum(self, name: str, shape: dict[str, Any]) -> Any:
        is_text = shape["repr"] == "string"
        values = [(one["name"].upper(), one["wire"] if is_text else int(one["wire"])) for one in shape["values"]]
        made: Any = functional(name, values)
        self.enums[name] = rt.wire_enum(shape["repr"], is_open=not shape["closed"])(made)
        return made if shape["closed"] else Union[made, rt.Unknown[str] if is_text else rt.Unknown[int]]

    def choice(self, _: str, shape: dict[str, Any]) -> Any:
        forms = tuple(self.named(one["type"]) for one in shape["variants"])
        return Annotated[Union[forms], rt.Variants(tuple(one["name"] for one in shape["variants"]))]

    def of(self, ty: dict[str, Any]) -> Any:
        if ty["is"] == "array":
            return list[self.of(ty["of"])]  # type: ignore[misc]
        return self.named(ty["name"]) if ty["is"] == "named" else SCALARS[ty["is"]]


def spec() -> dict[str, Any]:
    text = (ROOT / "stubs/typescript/generated/protocol.ts").read_text(encoding="utf-8")
    made: dict[str, Any] = json.loads(text[text.index("= {") + 2 :])
    return made


class Vectors(unittest.TestCase):
    def test_every_body(self) -> None:
        data = spec()
        types = Types(data)
        operations = {one["name"]: one for one in data["operations"]}
        accepted = rejected = 0
        for path in sorted((ROOT / "fc-generated/vectors").glob("*.json")):
            vectors = load(f"fc-generated/vectors/{path.name}")
            operation = operations.get(vectors["operation"])
            if operation is None or operation["kind"] == "stream":
                continue
            for vector in [*vectors["accepted"], *vectors["rejected"]]:
                cls = types.named(operation["response" if vector["direction"] == "response" else "request"])
                with self.subTest(path.name, name=vector["name"]):
                    if "error" in vector:
                        self.assertEqual(self.name_of(vector, cls), vector["error"])
                        rejected += 1
                    else:
                        written = json.loads(self.again(vector, cls))
                        self.assertEqual(written, vector.get("canonical", vector["body"]))
                        accepted += 1
        print(f"{accepted} accepted and {rejected} rejected messages", file=sys.stderr)
        self.assertGreater(accepted + rejected, 1500)

    def name_of(self, vector: dict[str, Any], cls: type[rt.Message]) -> str:
        try:
            self.again(vector, cls)
        except (rt.BodyError, rt.FrameError) as error:
            return error.name
        return "accepted"

    def again(self, vector: dict[str, Any], cls: type[rt.Message]) -> bytes:
        """Reads a message as its type, and writes it again."""
        if "frame" in vector:
            decoder = rt.Decoder(PROTOCOL)
            decoder.push(bytes.fromhex(vector["frame"]))
            frame = decoder.next()
            decoder.finish()
            assert frame is not None
            body = frame.data
        else:
            body = vector["text"].encode()
        is_response = vector["direction"] == "response"
        outer = PROTOCOL.response_envelope if is_response else PROTOCOL.request_envelope
        envelope, message = read_with_envelope(outer, cls, body, PROTOCOL.defaults.limits)
        if isinstance(message, rt.BodyError):
            raise message
        return write_with_envelope(envelope, message)


if __name__ == "__main__":
    unittest.main()
