"""The FC frame in another language: just enough Python to pass every golden frame.

Run it from the root of the repository:

    cargo run -q -- inspect --format json > protocol.json
    python3 docs-site/guides/port.py protocol.json
"""
# region frame
import gzip
import hashlib
import json
import struct
import sys
import zlib
from pathlib import Path

# The output of `fcproto inspect` describes the layout of a frame, so this file has no copy of it.
PROTOCOL = json.loads(Path(sys.argv[1]).read_text(encoding="utf-8"))["protocol"]
FRAME, LIMITS = PROTOCOL["frame"], PROTOCOL["limits"]

INTEGERS = {1: "B", 2: "H", 4: "I", 8: "Q"}
BYTE_ORDER = {"big": ">", "little": "<"}[FRAME["byte_order"]]
FIELDS = FRAME["header"]
FORMATS = [f"{f['size']}s" if f["type"].startswith("bytes") else INTEGERS[f["size"]] for f in FIELDS]
HEADER = struct.Struct(BYTE_ORDER + "".join(FORMATS))
OFFSETS = {f["role"]: f["offset"] for f in FIELDS}
TOTAL = struct.Struct(BYTE_ORDER + next(INTEGERS[f["size"]] for f in FIELDS if f["role"] == "total_length"))

REQUEST, RESPONSE = bytes(FRAME["request_head"]), bytes(FRAME["response_head"])
KINDS = {kind["value"]: kind["role"] for kind in FRAME["kinds"]}
ENCODINGS = {encoding["role"]: encoding["value"] for encoding in FRAME["encodings"]}
PLAIN, GZIP = ENCODINGS["plain"], ENCODINGS["gzip"]


class FrameError(Exception):
    """Its text is the error's fixed name."""


def decode(frame):
    """The header's fields and the data, decompressed. The order of the checks is part of the protocol."""
    if not any(frame.startswith(head[: len(frame)]) for head in (REQUEST, RESPONSE)):
        raise FrameError("bad_head")
    if len(frame) < OFFSETS["total_length"] + TOTAL.size:
        raise FrameError("truncated")
    (total,) = TOTAL.unpack_from(frame, OFFSETS["total_length"])
    if total < HEADER.size:
        raise FrameError("short_frame")
    if total > LIMITS["frame_bytes"]:
        raise FrameError("frame_too_long")
    if len(frame) < total:
        raise FrameError("truncated")
    header = {f["role"]: value for f, value in zip(FIELDS, HEADER.unpack_from(frame))}
    data = frame[HEADER.size : total]
    if header["kind"] not in KINDS:
        raise FrameError("unknown_kind")
    if KINDS[header["kind"]] == "reserved":
        raise FrameError("reserved_kind")
    if header["encoding"] not in (PLAIN, GZIP):
        raise FrameError("unknown_encoding")
    if hashlib.md5(data).digest() != header["digest"]:
        raise FrameError("bad_digest")
    plain_length, is_plain = header["plain_length"], header["encoding"] == PLAIN
    if not is_plain:
        if plain_length > LIMITS["inflated_bytes"]:
            raise FrameError("inflated_too_long")
        data = inflate(data)
    # Some senders write 0 on an uncompressed frame.
    if plain_length != len(data) and not (is_plain and plain_length == 0):
        raise FrameError("plain_length_mismatch")
    return header["head"] == RESPONSE, header["kind"], header["code"], header["id"], data


def inflate(data):
    """One gzip member, never more of it than the limit."""
    unpacker = zlib.decompressobj(wbits=31)
    try:
        plain = unpacker.decompress(data, LIMITS["inflated_bytes"] + 1)
    except zlib.error:
        raise FrameError("bad_gzip") from None
    if len(plain) > LIMITS["inflated_bytes"]:
        raise FrameError("inflated_too_long")
    if not unpacker.eof or unpacker.unused_data:
        raise FrameError("bad_gzip")
    return plain


def encode(response, kind, code, msg_id, plain, pack=False):
    """The frame around JSON text or stream bytes."""
    data = gzip.compress(plain, mtime=0) if pack else plain
    values = {
        "head": RESPONSE if response else REQUEST,
        "kind": kind,
        "code": code,
        "id": msg_id,
        "encoding": GZIP if pack else PLAIN,
        "total_length": HEADER.size + len(data),
        "plain_length": len(plain),
        "digest": hashlib.md5(data).digest(),
    }
    return HEADER.pack(*(values.get(f["role"], f["value"]) for f in FIELDS)) + data
# endregion frame


# region vectors
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
# endregion vectors


if __name__ == "__main__":
    passed, later = check()
    assert passed > 500 and later > 0
    print("every golden frame is decoded, refused and encoded as it should be")
