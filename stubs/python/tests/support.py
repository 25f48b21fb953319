"""Files of the project, and a protocol made of what the golden frames demand."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Any

import fc_runtime as rt

ROOT = Path(__file__).resolve().parents[3]


def load(path: str) -> Any:
    return json.loads((ROOT / path).read_text(encoding="utf-8"))


@dataclass(slots=True, kw_only=True)
class RequestEnvelope(rt.Message):
    cmd_time: Annotated[rt.TimestampMs | None, rt.Key("cmdTime")] = None
    extra: rt.Extra = field(default_factory=rt.Extra)


@dataclass(slots=True, kw_only=True)
class ResponseEnvelope(rt.Message):
    cmd_time: Annotated[rt.TimestampMs | None, rt.Key("cmdTime")] = None
    result_code: Annotated[rt.I32, rt.Key("resultCode")]
    result_msg: Annotated[str | None, rt.Key("resultMsg")] = None
    extra: rt.Extra = field(default_factory=rt.Extra)


LIMITS = rt.Limits(
    frame_bytes=16_777_216,
    inflated_bytes=67_108_864,
    json_depth=64,
    in_flight=256,
    queued_reports=256,
    connections=64,
)

PROTOCOL = rt.Protocol(
    name="test",
    host="127.0.0.1",
    command_port=0,
    data_port=0,
    byte_order="big",
    header=(
        rt.HeaderField("frame_head", 2, rt.HeaderRole.HEAD, is_bytes=True),
        rt.HeaderField("kind", 1, rt.HeaderRole.KIND),
        rt.HeaderField("cmd_function", 2, rt.HeaderRole.CODE),
        rt.HeaderField("msg_id", 4, rt.HeaderRole.ID),
        rt.HeaderField("encryption", 1, rt.HeaderRole.ENCODING),
        rt.HeaderField("status_code", 1, rt.HeaderRole.STATUS),
        rt.HeaderField("data_length", 4, rt.HeaderRole.TOTAL_LENGTH),
        rt.HeaderField("plain_length", 4, rt.HeaderRole.PLAIN_LENGTH, zero_when_plain=True),
        rt.HeaderField("md5", 16, rt.HeaderRole.DIGEST, is_bytes=True, digest=rt.Digest.MD5),
    ),
    request_head=b"\xfc\xaa",
    response_head=b"\xee\xaa",
    stream=0,
    command=1,
    report=3,
    reserved_kinds=frozenset({2}),
    plain=0,
    gzip=1,
    request_envelope=RequestEnvelope,
    response_envelope=ResponseEnvelope,
    request_roles={"time": "cmd_time"},
    response_roles={"time": "cmd_time", "result_code": "result_code", "result_text": "result_msg"},
    results=rt.Results(
        success=rt.ResultText(1001, "ok"),
        protocol=rt.ResultText(2001, "protocol"),
        timeout=rt.ResultText(2002, "timeout"),
        invalid=rt.ResultText(2003, "invalid"),
        expired=rt.ResultText(2004, "expired"),
    ),
    defaults=rt.Defaults(
        call_timeout=3.0,
        handler_timeout=2.0,
        max_age=None,
        ack=rt.AckPolicy(timeout=2.0, retries=3),
        limits=LIMITS,
    ),
)
