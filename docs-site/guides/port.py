"""The FC frame in another language: just enough Python to pass every golden frame.

Run it from anywhere: python3 docs-site/guides/port.py
"""
# #region frame
import gzip
import hashlib
import json
import struct
import zlib
from pathlib import Path

# head, type, cmdFunction, msgId, encryption, statusCode, dataLength, GZipDataLength, MD5
HEADER = struct.Struct(">2sBHIBBII16s")
REQUEST, RESPONSE = b"\xfc\xaa", b"\xee\xaa"
KINDS, RESERVED = {0, 1, 3}, {2}
PLAIN, GZIP = 0, 1
MAX_FRAME, MAX_INFLATED = 16 << 20, 64 << 20


class FrameError(Exception):
    """Its text is the error's fixed name."""


def decode(frame):
    """The header's fields and the data, decompressed. The order of the checks is part of the protocol."""
    if frame[:2] not in (REQUEST[: len(frame)], RESPONSE[: len(frame)]):
        raise FrameError("bad_head")
    if len(frame) < 15:
        raise FrameError("truncated")
    (total,) = struct.unpack_from(">I", frame, 11)
    if total < HEADER.size:
        raise FrameError("short_frame")
    if total > MAX_FRAME:
        raise FrameError("frame_too_long")
    if len(frame) < total:
        raise FrameError("truncated")
    head, kind, code, msg_id, encoding, _, _, plain_length, md5 = HEADER.unpack_from(frame)
    data = frame[HEADER.size : total]
    if kind in RESERVED:
        raise FrameError("reserved_kind")
    if kind not in KINDS:
        raise FrameError("unknown_kind")
    if encoding not in (PLAIN, GZIP):
        raise FrameError("unknown_encoding")
    if hashlib.md5(data).digest() != md5:
        raise FrameError("bad_digest")
    if encoding == GZIP:
        if plain_length > MAX_INFLATED:
            raise FrameError("inflated_too_long")
        data = inflate(data)
    # A 0 is what some senders write on an uncompressed frame.
    if plain_length != len(data) and not (encoding == PLAIN and plain_length == 0):
        raise FrameError("plain_length_mismatch")
    return head == RESPONSE, kind, code, msg_id, data


def inflate(data):
    """One gzip member, never more of it than the limit."""
    unpacker = zlib.decompressobj(wbits=31)
    try:
        plain = unpacker.decompress(data, MAX_INFLATED + 1)
    except zlib.error:
        raise FrameError("bad_gzip") from None
    if len(plain) > MAX_INFLATED:
        raise FrameError("inflated_too_long")
    if not unpacker.eof or unpacker.unused_data:
        raise FrameError("bad_gzip")
    return plain


def encode(response, kind, code, msg_id, plain, pack=False):
    """The frame around JSON text or stream bytes."""
    data = gzip.compress(plain, mtime=0) if pack else plain
    return (
        HEADER.pack(
            RESPONSE if response else REQUEST, kind, code, msg_id, GZIP if pack else PLAIN, 0,
            HEADER.size + len(data), len(plain), hashlib.md5(data).digest(),
        )
        + data
    )
# #endregion frame


# #region vectors
VECTORS = Path(__file__).resolve().parents[2] / "fc-generated" / "vectors"
FRAME_ERRORS = {
    "bad_head", "short_frame", "frame_too_long", "truncated", "unknown_kind", "reserved_kind",
    "unknown_encoding", "bad_digest", "bad_gzip", "plain_length_mismatch", "inflated_too_long",
}


def check():
    passed = later = 0
    for file in sorted(VECTORS.glob("*.json")):
        vectors = json.loads(file.read_text(encoding="utf-8"))
        for vector in vectors["accepted"]:
            if "frame" not in vector:
                later += 1  # no code yet, so no frame: the body alone
                continue
            frame = bytes.fromhex(vector["frame"])
            response, kind, code, msg_id, data = decode(frame)
            assert response == (vector["direction"] == "response"), vector["name"]
            if "body" in vector:
                assert json.loads(data or b"{}") == vector["body"], vector["name"]
            if vector["case"] == "plain":
                assert encode(response, kind, code, msg_id, data) == frame, vector["name"]
            again = encode(response, kind, code, msg_id, data, pack=True)
            assert decode(again) == (response, kind, code, msg_id, data), vector["name"]
            passed += 1
        for vector in vectors["rejected"]:
            if vector["error"] not in FRAME_ERRORS:
                later += 1  # the frame is sound, the body is not: needs the types
                continue
            try:
                decode(bytes.fromhex(vector["frame"]))
            except FrameError as error:
                assert str(error) == vector["error"], (file.name, vector["name"], str(error))
            else:
                raise AssertionError(f"{file.name} {vector['name']}: not refused")
            passed += 1
    return passed, later
# #endregion vectors


if __name__ == "__main__":
    passed, later = check()
    assert passed > 500 and later > 0
    print("every golden frame is decoded, refused and encoded as it should be")
