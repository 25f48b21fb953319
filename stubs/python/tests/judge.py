"""Decodes each frame, one in hex on a line, and prints the result as a list in JSON on a line.

A test compares these lists between languages; `fc-reflect/tests/it/judges.rs` describes them.
"""

from __future__ import annotations

import json
import sys
from dataclasses import dataclass, field
from typing import Any

import fc_runtime as rt
from fc import FC
from fc_runtime.enveloped import read_with_envelope, write_with_envelope


@dataclass(slots=True, kw_only=True)
class Nothing(rt.Message):
    """A message without declared keys."""

    extra: rt.Extra = field(default_factory=rt.Extra)


KNOWN: dict[tuple[bool, int, int | None], type[rt.Message]] = {}
for operations, kind in ((FC.commands, FC.command), (FC.reports, FC.report)):
    for operation in operations:
        KNOWN[False, kind, operation.code] = operation.request
        KNOWN[True, kind, operation.code] = operation.response


def verdict(data: bytes) -> list[Any]:
    decoder = rt.Decoder(FC)
    decoder.push(data)
    frame = decoder.next()
    if frame is None:
        return ["refused", "truncated", ""]
    header = [int(frame.id.response), frame.id.kind, frame.id.code, frame.id.id]
    raw = ["bytes", *header, bytes(frame.data).hex()]
    if frame.id.kind == FC.stream:
        return raw
    cls = KNOWN.get((frame.id.response, frame.id.kind, frame.id.code))
    outer = FC.response_envelope if frame.id.response else FC.request_envelope
    envelope, message = read_with_envelope(outer, cls or Nothing, frame.data, FC.defaults.limits)
    if isinstance(message, rt.BodyError):
        raise message
    return ["message", *header, write_with_envelope(envelope, cls, message).decode()] if cls else raw


for line in sys.stdin:
    try:
        answer = verdict(bytes.fromhex(line))
    except rt.FrameError as error:
        answer = ["refused", error.name, ""]
    except rt.BodyError as error:
        answer = ["refused", error.name, error.path]
    print(json.dumps(answer))
