"""Frames to typed messages and back, compared with `json.loads` and `json.dumps` with MD5 over the same bytes."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

from measure import measure

import fc
import fc_runtime as rt
from fc_runtime.enveloped import read_response, write_response
from fc_runtime.frame import Decoder, Encoder

if TYPE_CHECKING:
    from measure import Effort

FRAMES = Path(__file__).resolve().parents[3] / "bench" / "frames"

MESSAGES: dict[str, type[rt.Message]] = {
    "small": fc.GetStationResponse,
    "medium": fc.ListStationsResponse,
    "long": fc.ListStationsResponse,
}
"""Names of files, and their types."""

LAYOUT = fc.FC.layout
HEADER = LAYOUT.length
_BEFORE = sum(field.size for field in LAYOUT.fields[: LAYOUT.digest_at])
DIGEST = slice(_BEFORE, _BEFORE + LAYOUT.digest_size)


def least_decode(frame: bytes) -> Any:
    """The least work of reading: check the digest and parse all of the JSON."""
    body = frame[HEADER:]
    if hashlib.md5(body, usedforsecurity=False).digest() != frame[DIGEST]:
        raise ValueError("another digest")
    return json.loads(body)


def least_encode(header: bytes, message: Any) -> bytes:
    """The least work of writing: make all of the JSON, and put its digest after a prepared header."""
    body = _dumps(message).encode()
    return header + hashlib.md5(body, usedforsecurity=False).digest() + body


# Compact, as sent. One encoder is faster than `json.dumps` with these settings.
_dumps = json.JSONEncoder(ensure_ascii=False, separators=(",", ":")).encode


def codec(effort: Effort) -> list[dict[str, Any]]:
    """Returns the cost of each message, in microseconds."""
    return [_message(name, cls, effort) for name, cls in MESSAGES.items()]


def _message(name: str, cls: type[rt.Message], effort: Effort) -> dict[str, Any]:
    frame = (FRAMES / f"{name}.bin").read_bytes()
    limits = fc.FC.defaults.limits
    decoder, encoder = Decoder(fc.FC), Encoder(fc.FC)
    success = fc.FC.results.success

    def opened(data: bytes) -> Any:
        decoder.push(data)
        found = decoder.next()
        assert found is not None
        return found

    def decode(data: bytes = frame) -> Any:
        return read_response(fc.FC, cls, opened(data).data, limits)

    message, identity = decode(), opened(frame).id

    def encode() -> bytes:
        return encoder.encode(identity, write_response(fc.FC, success, type(message), message))

    plain = least_decode(frame)
    header = frame[: DIGEST.start]
    # Each side writes all that it reads. Only the time of the response is the present one.
    assert decode(encode()) == message
    assert len(encode()) == len(frame)
    assert least_encode(header, plain) == frame
    found = measure(
        {
            "decode least": lambda: least_decode(frame),
            "decode fc": decode,
            "encode least": lambda: least_encode(header, plain),
            "encode fc": encode,
        },
        effort,
    )
    return {
        "message": name,
        "bytes": len(frame),
        "decode": {"least": found["decode least"], "fc": found["decode fc"]},
        "encode": {"least": found["encode least"], "fc": found["encode fc"]},
    }
