"""Frames to typed messages and back, beside `json.loads` and `json.dumps` with MD5 over the same bytes."""

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
"""Names of files, and what they hold."""

LAYOUT = fc.FC.layout
HEADER = LAYOUT.length
_BEFORE = sum(field.size for field in LAYOUT.fields[: LAYOUT.digest_at])
DIGEST = slice(_BEFORE, _BEFORE + LAYOUT.digest_size)


def least_decode(frame: bytes) -> Any:
    """The least that reading takes: the digest checked, and all of the JSON parsed."""
    body = frame[HEADER:]
    if hashlib.md5(body, usedforsecurity=False).digest() != frame[DIGEST]:
        raise ValueError("another digest")
    return json.loads(body)


def least_encode(header: bytes, message: Any) -> bytes:
    """The least that writing takes: all of the JSON made, and its digest behind a header that is ready but for that."""
    body = _dumps(message).encode()
    return header + hashlib.md5(body, usedforsecurity=False).digest() + body


# Compact, as it is sent; made once, which is faster than `json.dumps` with these settings.
_dumps = json.JSONEncoder(ensure_ascii=False, separators=(",", ":")).encode


def codec(effort: Effort) -> list[dict[str, Any]]:
    """What each message costs, in microseconds."""
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
    # Each side writes what it reads, all of it; only the time of the response is that of now.
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
