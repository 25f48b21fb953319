"""What a generated protocol tells the runtime: its header, envelopes, numbers and operations.

This package contains no number of a protocol. Every code, port, head byte and result code reaches it from here.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import Enum
from functools import cached_property
from typing import TYPE_CHECKING, Any, Final, Generic, TypeVar

from .document import DEFAULT_VALUES
from .layout import Layout

if TYPE_CHECKING:
    from collections.abc import Mapping

    from .layout import HeaderField
    from .message import Message

Q = TypeVar("Q", bound="Message", covariant=True)
R = TypeVar("R", bound="Message", covariant=True)
P = TypeVar("P", bound="Message", covariant=True)

INFLATE_FREE: Final = 1 << 20
"""Data of so many bytes or fewer may have been compressed by any ratio."""


@dataclass(frozen=True, slots=True, kw_only=True)
class AckPolicy:
    """How the acknowledgement of a report is awaited."""

    timeout: float
    """Seconds to wait before the report is sent again; up to an eighth longer, by connection."""
    retries: int
    """How often to send it again before giving up."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Limits:
    """Bounds of everything that grows with what a peer sends."""

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
    """Most bytes that one byte of compressed JSON may become, where more than `INFLATE_FREE` come out."""
    json_values: int = DEFAULT_VALUES
    """Most keys and items in a body, those of all levels together."""


@dataclass(frozen=True, slots=True)
class ResultText:
    """A result code and the text sent beside it."""

    code: int
    """The code."""
    text: str
    """The text, for people only."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Results:
    """Results that the runtime itself answers with."""

    success: ResultText
    """The call did what it should."""
    protocol: ResultText
    """Unknown command, reserved kind, bad digest."""
    timeout: ResultText
    """No answer from the handler in time."""
    invalid: ResultText
    """A body that does not parse or breaks a constraint."""
    expired: ResultText
    """A message older than the configured age."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Defaults:
    """Times (in seconds) and limits where the user sets none."""

    call_timeout: float
    """How long a call waits for its response."""
    handler_timeout: float
    """How long a handler may take before the peer is told."""
    max_age: float | None
    """Oldest message that is still served; `None` for any age."""
    ack: AckPolicy
    """Acknowledgement of reports."""
    limits: Limits
    """Bounds."""


class Effect(str, Enum):
    """What a command does to the peer."""

    READ = "read"
    """Only asks."""
    CONFIG = "config"
    """Changes what the peer knows or how it behaves."""
    MOTION = "motion"
    """Sets something in motion."""
    UNKNOWN = "unknown"
    """Nobody knows: never repeated by itself, like what sets something in motion."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Facts:
    """What is said of every operation."""

    name: str
    """Name in the spec."""
    code: int | None
    """Command code; `None` while the spec has not given one."""
    zh: str
    """Chinese title."""
    en: str
    """English title."""
    since: str | None = None
    """First version of the spec that has it, as `YYYY-MM` or `YYYY-MM-DD`."""
    deprecated: bool = False
    """Whether it has been withdrawn."""
    docs: str = ""
    """Path of its page below the documentation's root."""
    spec: str = ""
    """File of the spec that defines it."""


@dataclass(frozen=True, slots=True)
class States:
    """Some values of an enum."""

    of: type[Enum]
    """The enum."""
    values: frozenset[Enum]
    """Its values."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Preconditions:
    """What has to hold before a command is accepted."""

    any_state: bool = False
    """It is accepted in any state."""
    states: tuple[States, ...] = ()
    """It is accepted where each of these enums has one of these values; empty where nothing is said."""
    after: tuple[str, ...] = ()
    """Names of the commands that come first."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Cadence:
    """When a report is sent. A path is that of wire keys from the report's body on, joined by dots."""

    on_change: str | None = None
    """At each change of the field at this path."""
    step: tuple[str, float] | None = None
    """At each step of the number at this path, and how far it moves in between."""
    every: float | None = None
    """At intervals of so many seconds."""
    within: float | None = None
    """At the latest so many seconds after a command that sets it off."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Command(Facts, Generic[Q, R]):
    """A request with a code, tied to its response."""

    request: type[Q]
    """What is asked."""
    response: type[R]
    """What answers it."""
    effect: Effect
    """What it does to the peer."""
    preconditions: Preconditions | None = None
    """What has to hold before it is accepted; `None` where the spec says nothing of that."""

    def accepted_in(self, state: object) -> bool:
        """Whether it is accepted in this state, as far as it depends on states of this enum.

        One that the spec does not know is none of them.
        """
        states = self.preconditions.states if self.preconditions is not None else ()
        about = [one for one in states if isinstance(state, one.of) or not isinstance(state, Enum)]
        return all(state in one.values for one in about)


@dataclass(frozen=True, slots=True, kw_only=True)
class Report(Facts, Generic[Q]):
    """A message that is pushed and acknowledged."""

    request: type[Q]
    """What is reported."""
    response: type[Message]
    """The acknowledgement."""
    ack: AckPolicy | None = None
    """How its acknowledgement is awaited; `None` for the protocol's default."""
    cadence: Cadence | None = None
    """When it is sent; `None` where the spec says nothing of that."""
    state: str | None = None
    """Where it says how far a process has come, as names of fields joined by dots."""
    failures: tuple[str, ...] = ()
    """Where else it says that something failed."""

    def state_of(self, report: Message) -> Any:
        """How far the process has come; `None` if the report does not say."""
        return None if self.state is None else field_at(report, self.state)

    def is_failure(self, report: Message) -> bool:
        """Whether a report says that something failed."""
        paths = self.failures if self.state is None else (self.state, *self.failures)
        return any(_says_failed(field_at(report, path)) for path in paths)


@dataclass(frozen=True, slots=True, kw_only=True)
class Stream(Facts):
    """Frames of raw bytes, or of JSON without an envelope."""

    from_robot: bool
    """Whether the robot sends it; otherwise the app does."""
    content: str | None = None
    """Media type of what its frames carry, `None` where none is stated."""
    body: type[Message] | None = None
    """What its frames hold, where that is JSON."""
    started_by: str | None = None
    """Name of the command after which it is sent."""
    stopped_by: str | None = None
    """Name of the command after which it is no longer sent."""


@dataclass(frozen=True, slots=True)
class Tie:
    """Two fields that are the same if a report belongs to a call."""

    of_response: bool
    """Whether the command's field is in its response; otherwise in its request."""
    command: str
    """The command's field, as names joined by dots."""
    report: str
    """The report's field."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SetsOff(Generic[Q, R, P]):
    """A report that a command sets off."""

    command: Command[Q, R]
    """The command."""
    report: Report[P]
    """The report."""
    ties: tuple[Tie, ...] = ()
    """What ties a report to a call; none where nothing in the messages does."""

    def has_set_off(self, request: Message, answer: Message, report: Message) -> bool:
        """Whether the report belongs to this call: what ties them differs in neither."""
        return all(
            field_at(answer if tie.of_response else request, tie.command) == field_at(report, tie.report)
            for tie in self.ties
        )


def field_at(message: Message, path: str) -> Any:
    """The value at a path of names of fields; `None` where one on the way is absent."""
    value: Any = message
    for name in path.split("."):
        value = None if value is None else getattr(value, name, None)
    return value


def _says_failed(value: Any) -> bool:
    return value is True or getattr(value, "is_error", False) is True


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
    """`big` or `little`, of all integers in the header."""
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
    """Kinds that are refused by name."""
    plain: int = 0
    """Encoding of data sent as it is."""
    gzip: int | None = None
    """Encoding of data sent as one gzip member; `None` if nothing is compressed."""
    request_envelope: type[Message]
    """The keys that every request carries."""
    response_envelope: type[Message]
    """The keys that every response carries."""
    request_roles: Mapping[str, str] = field(default_factory=dict[str, str])
    """Fields of the request's envelope by their roles: `time`."""
    response_roles: Mapping[str, str] = field(default_factory=dict[str, str])
    """Fields of the response's envelope by their roles: `time`, `result_code`, `result_text`."""
    results: Results
    """Results that the runtime itself answers with."""
    defaults: Defaults
    """Times and limits where the user sets none."""
    commands: tuple[Command[Any, Any], ...] = ()
    """All commands."""
    reports: tuple[Report[Any], ...] = ()
    """All reports."""
    streams: tuple[Stream, ...] = ()
    """All streams."""

    @cached_property
    def layout(self) -> Layout:
        """The header's layout."""
        return Layout(self.header, self.byte_order)

    @cached_property
    def commands_by_code(self) -> Mapping[int, Command[Any, Any]]:
        """The commands that have a code."""
        return {one.code: one for one in self.commands if one.code is not None}

    @cached_property
    def reports_by_code(self) -> Mapping[int, Report[Any]]:
        """The reports that have a code."""
        return {one.code: one for one in self.reports if one.code is not None}

    def operation(self, code: int) -> Command[Any, Any] | Report[Any] | None:
        """The command or report of a code."""
        return self.commands_by_code.get(code) or self.reports_by_code.get(code)

    def effect(self, code: int) -> Effect:
        """What the command of a code does, for all that is known."""
        command = self.commands_by_code.get(code)
        return Effect.UNKNOWN if command is None else command.effect

    @property
    def has_result(self) -> bool:
        """Whether responses carry a result code."""
        return "result_code" in self.response_roles
