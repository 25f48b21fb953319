"""The layer below the messages."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Annotated, Final

import fc_runtime as rt

from .groups.battery import BATTERY_COMMANDS, BATTERY_REPORTS, BATTERY_STREAMS


class ResultCode(rt.Result):
    """结果码

    Result codes
    """

    SUCCESS = 1001, "ok"
    PROTOCOL_ERROR = 2001, "protocol"
    TIMEOUT = 2002, "timeout"
    INVALID_PARAMETER = 2003, "invalid"
    EXPIRED = 2004, "expired"


@dataclass(slots=True, kw_only=True)
class RequestEnvelope(rt.Message):
    """The keys of every request and report, in addition to those of its body."""

    cmd_time: Annotated[rt.TimestampMs | None, rt.Key("cmdTime")] = None
    extra: rt.Extra = field(default_factory=rt.Extra)


@dataclass(slots=True, kw_only=True)
class ResponseEnvelope(rt.Message):
    """The keys of every response and acknowledgement, in addition to those of its body."""

    cmd_time: Annotated[rt.TimestampMs | None, rt.Key("cmdTime")] = None
    result_code: Annotated[rt.I32, rt.Key("resultCode")]
    result_msg: Annotated[str | None, rt.Key("resultMsg")] = None
    extra: rt.Extra = field(default_factory=rt.Extra)


SAMPLE: Final = rt.Protocol(
    name="sample",
    host="192.168.1.3",
    command_port=5656,
    data_port=6868,
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
        handler_timeout=2.5,
        max_age=None,
        ack=rt.AckPolicy(timeout=2.0, retries=3),
        limits=rt.Limits(
            frame_bytes=16_777_216,
            inflated_bytes=67_108_864,
            json_depth=64,
            in_flight=256,
            queued_reports=256,
            connections=64,
        ),
    ),
    commands=(*BATTERY_COMMANDS,),
    reports=(*BATTERY_REPORTS,),
    streams=(*BATTERY_STREAMS,),
    pass_through=(rt.PassThrough(first=0x0500, last=0x05FF, method="pass_through"),),
)
"""协议。The protocol."""
