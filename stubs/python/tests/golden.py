"""Golden messages read and written with the types of a generated package."""

from __future__ import annotations

import json
import unittest
from typing import TYPE_CHECKING, Any

import fc_runtime as rt
from fc import FC
from fc_runtime.enveloped import read_with_envelope, write_with_envelope
from support import holds

if TYPE_CHECKING:
    from pathlib import Path


def check(test: unittest.TestCase, protocol: rt.Protocol, folder: Path) -> tuple[int, int]:
    """Checks every message of the vectors in a folder. Returns the numbers of accepted and rejected ones."""
    operations: dict[str, Any] = {one.name: one for one in (*protocol.commands, *protocol.reports, *protocol.streams)}
    counts = [0, 0]
    seen: set[str] = set()
    for path in sorted(folder.glob("*.json")):
        vectors = json.loads(path.read_text(encoding="utf-8"))
        # `bodies.json` and `frames.json` have no operation.
        if vectors["operation"] is None:
            continue
        operation = operations[vectors["operation"]]
        seen.add(operation.name)
        for vector in vectors["accepted"]:
            with test.subTest(path.name, name=vector["name"]):
                test.assertEqual(again(protocol, operation, vector), expected(vector))
                counts[0] += 1
                if protocol is FC:
                    holds("accepted")
        for vector in vectors["rejected"]:
            with test.subTest(path.name, name=vector["name"]):
                with test.assertRaises((rt.BodyError, rt.FrameError)) as caught:
                    again(protocol, operation, vector)
                test.assertEqual(getattr(caught.exception, "name", ""), vector["error"])
                counts[1] += 1
                if protocol is FC:
                    holds("rejected")
    test.assertEqual(seen, set(operations), "each operation has vectors")
    return counts[0], counts[1]


def expected(vector: dict[str, Any]) -> Any:
    """Returns the expected JSON of an accepted message that is written again."""
    return vector.get("canonical", vector["body"]) if "body" in vector else vector["data"]


def again(protocol: rt.Protocol, operation: Any, vector: dict[str, Any]) -> Any:
    """Reads a message with its type, and writes it again."""
    if "frame" in vector:
        decoder = rt.Decoder(protocol)
        decoder.push(bytes.fromhex(vector["frame"]))
        frame = decoder.next()
        decoder.finish()
        assert frame is not None
        body = frame.data
        if vector.get("case") == "plain":
            assert rt.Encoder(protocol).encode(frame.id, body).hex() == vector["frame"], vector["name"]
    else:
        body = vector["text"].encode()
    if isinstance(operation, rt.Stream):
        held: Any = operation.body
        return body.hex() if held is bytes else held.from_json(body).to_json().encode().hex()
    is_response = vector["direction"] == "response"
    cls: type[rt.Message] = operation.response if is_response else operation.request
    outer = protocol.response_envelope if is_response else protocol.request_envelope
    envelope, message = read_with_envelope(outer, cls, body, protocol.defaults.limits)
    if isinstance(message, rt.BodyError):
        raise message
    assert type(message) is cls
    return json.loads(write_with_envelope(envelope, cls, message))
