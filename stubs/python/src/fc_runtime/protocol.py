"""A generated protocol's data for the runtime: its header, envelopes, numbers and operations.

This package contains no number of a protocol. Every code, port, head byte and result code comes from there.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, Final

from .document import DEFAULT_VALUES
from .layout import Layout
from .operations import Effect
from .settings import check_all, integer

if TYPE_CHECKING:
    from collections.abc import Mapping

    from .layout import HeaderField
    from .message import Message
    from .operations import AckPolicy, Command, PassThrough, Report, Stream
    from .settings import Check

INFLATE_FREE: Final = 1 << 20
"""Up to this many plain bytes, any compression ratio is allowed."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Limits:
    """Limits on everything that grows with the bytes from a peer."""

    frame_bytes: int
    """Longest frame, header included."""
    inflated_bytes: int
    """Longest data after decompression."""
    json_depth: int
    """Deepest nesting of a body."""
    in_flight: int
    """Calls in flight on one connection."""
    queued_reports: int
    """Reports waiting for one connection."""
    connections: int
    """Connections at one port of a robot."""
    inflate_ratio: int = 256
    """Most plain bytes per byte of compressed JSON, for more than `INFLATE_FREE` plain bytes."""
    json_values: int = DEFAULT_VALUES
    """Most keys and items in a body, on all levels together."""

    def __post_init__(self) -> None:
        """Checks every limit. Raises `TypeError` and `ValueError`."""
        check_all(self, _LIMITS)


_LIMITS: Final[Mapping[str, Check]] = {
    "frame_bytes": integer(1),
    "inflated_bytes": integer(1),
    "json_depth": integer(1),
    "in_flight": integer(1),
    "queued_reports": integer(0),
    "connections": integer(1),
    "inflate_ratio": integer(1),
    "json_values": integer(1),
}


@dataclass(frozen=True, slots=True)
class ResultText:
    """A result code and its text."""

    code: int
    """The code."""
    text: str
    """The text, for people only."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Results:
    """Results that the runtime sends."""

    success: ResultText
    """Success."""
    protocol: ResultText
    """Unknown command, reserved kind, bad digest."""
    timeout: ResultText
    """No response from the handler in time."""
    invalid: ResultText
    """A body that does not parse or breaks a constraint."""
    expired: ResultText
    """A message older than the configured age."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Defaults:
    """Times (in seconds) and limits that apply unless the user sets others."""

    call_timeout: float
    """Time a call waits for its response."""
    handler_timeout: float
    """Time a handler may take before the peer gets the result for a timeout."""
    max_age: float | None
    """Oldest message that is still served; `None` for any age."""
    ack: AckPolicy
    """Acknowledgement of reports."""
    limits: Limits
    """Limits."""


@dataclass(frozen=True, kw_only=True)
class Protocol:
    """A protocol: its types and every number the runtime needs."""

    name: str
    """Short name, for logs."""
    host: str
    """Usual address of the robot."""
    command_port: int
    """TCP port of commands, responses and reports."""
    data_port: int
    """TCP port of streams."""
    byte_order: str
    """Byte order of all integers in the header: `big` or `little`."""
    header: tuple[HeaderField, ...]
    """Fields of the frame's header, in order."""
    request_head: bytes
    """First bytes of a request."""
    response_head: bytes
    """First bytes of a response."""
    stream: int
    """Kind of a frame of raw bytes."""
    command: int
    """Kind of a command and of its response."""
    report: int
    """Kind of a report and of its acknowledgement."""
    reserved_kinds: frozenset[int] = frozenset()
    """Kinds that are refused with a separate error."""
    plain: int = 0
    """Encoding of uncompressed data."""
    gzip: int | None = None
    """Encoding of data as one gzip member; `None` if the protocol has no compression."""
    request_envelope: type[Message]
    """The envelope of every request."""
    response_envelope: type[Message]
    """The envelope of every response."""
    request_roles: Mapping[str, str] = field(default_factory=dict[str, str])
    """Fields of the request's envelope by their roles: `time`."""
    response_roles: Mapping[str, str] = field(default_factory=dict[str, str])
    """Fields of the response's envelope by their roles: `time`, `result_code`, `result_text`."""
    results: Results
    """Results that the runtime sends."""
    defaults: Defaults
    """Times and limits that apply unless the user sets others."""
    commands: tuple[Command[Any, Any], ...] = ()
    """All commands."""
    reports: tuple[Report[Any], ...] = ()
    """All reports."""
    streams: tuple[Stream[Any], ...] = ()
    """All streams."""
    pass_through: tuple[PassThrough, ...] = ()
    """Code ranges that a robot may handle without types."""

    @cached_property
    def layout(self) -> Layout:
        """The header's layout."""
        return Layout(self.header, self.byte_order)

    @cached_property
    def commands_by_code(self) -> Mapping[int, Command[Any, Any]]:
        """The commands with a code, by code."""
        return {one.code: one for one in self.commands if one.code is not None}

    @cached_property
    def reports_by_code(self) -> Mapping[int, Report[Any]]:
        """The reports with a code, by code."""
        return {one.code: one for one in self.reports if one.code is not None}

    def operation(self, code: int) -> Command[Any, Any] | Report[Any] | None:
        """Returns the command or report with a code."""
        return self.commands_by_code.get(code) or self.reports_by_code.get(code)

    def effect(self, code: int) -> Effect:
        """Returns the effect of the command with a code; `UNKNOWN` for other codes."""
        command = self.commands_by_code.get(code)
        return Effect.UNKNOWN if command is None else command.effect

    @property
    def has_result(self) -> bool:
        """`True` if responses have a result code."""
        return "result_code" in self.response_roles
