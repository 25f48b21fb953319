"""Commands, reports and streams as values, with their facts from the protocol."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING, Any, Final, Generic, TypeVar

from .settings import check_all, duration, integer

if TYPE_CHECKING:
    from collections.abc import Mapping

    from .message import Message
    from .results import Result
    from .settings import Check

Q = TypeVar("Q", bound="Message", covariant=True)
R = TypeVar("R", bound="Message", covariant=True)
B = TypeVar("B", bound="Message | bytes", covariant=True)


@dataclass(frozen=True, slots=True, kw_only=True)
class AckPolicy:
    """Repetition of a report until its acknowledgement comes."""

    timeout: float
    """Seconds before the report is sent again; up to an eighth longer, by connection."""
    retries: int
    """Number of repetitions after the first try."""

    def __post_init__(self) -> None:
        """Checks both. Raises `TypeError` and `ValueError`."""
        check_all(self, _ACK)


_ACK: Final[Mapping[str, Check]] = {"timeout": duration, "retries": integer(0)}


class Effect(str, Enum):
    """Effect of a command on the peer."""

    READ = "read"
    """Only reads."""
    CONFIG = "config"
    """Changes the peer's settings or behaviour."""
    MOTION = "motion"
    """Sets something in motion."""
    UNKNOWN = "unknown"
    """Unknown: never repeated automatically, like a command that sets something in motion."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Facts:
    """Facts common to every operation."""

    name: str
    """Name in the spec."""
    code: int | None
    """Command code; `None` while the spec has assigned none."""
    zh: str
    """Chinese title."""
    en: str
    """English title."""
    since: str | None = None
    """First version of the spec that has it, as `YYYY-MM` or `YYYY-MM-DD`."""
    deprecated: bool = False
    """`True` if it is deprecated."""
    docs: str = ""
    """Path of its page below the documentation's root."""
    spec: str = ""
    """File of the spec that defines it."""
    method: str = ""
    """Name of its method, if it differs from `name`."""

    @property
    def method_name(self) -> str:
        """Name of its method."""
        return self.method or self.name


@dataclass(frozen=True, slots=True)
class States:
    """Some values of an enum."""

    of: type[Enum]
    """The enum."""
    values: frozenset[Enum]
    """Its values."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Preconditions:
    """Conditions under which a command is accepted."""

    any_state: bool = False
    """It is accepted in any state."""
    states: tuple[States, ...] = ()
    """The states that accept it: each of these enums must have one of these values. Empty if the spec does not specify
    them.
    """
    after: tuple[str, ...] = ()
    """Names of the commands that come first."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Cadence:
    """When a report is sent. A path has wire keys from the report's body on, joined by dots."""

    on_change: str | None = None
    """At each change of the field at this path."""
    step: tuple[str, float] | None = None
    """At each step of the number at this path, with the size of a step."""
    every: float | None = None
    """Every so many seconds."""
    within: float | None = None
    """Within so many seconds after a command that sets it off."""


@dataclass(frozen=True, slots=True)
class Tie:
    """Two fields that are equal if a report belongs to a call."""

    of_response: bool
    """`True` if the command's field is in its response, `False` for its request."""
    command: str
    """The command's field, as names joined by dots."""
    report: str
    """The report's field."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Report(Facts, Generic[Q]):
    """A message that is pushed and acknowledged."""

    request: type[Q]
    """Type of the report."""
    response: type[Message]
    """Type of the acknowledgement."""
    ack: AckPolicy | None = None
    """Policy for its acknowledgement; `None` for the protocol's default."""
    cadence: Cadence | None = None
    """When it is sent; `None` if the spec does not specify it."""
    state: str | None = None
    """The field with the state of the process, as names joined by dots."""
    failures: tuple[str, ...] = ()
    """Other fields that mean a failure."""

    def state_of(self, report: Message) -> Any:
        """Returns the state of the process, or `None` if the report does not contain it."""
        return None if self.state is None else field_at(report, self.state)

    def is_failure(self, report: Message) -> bool:
        """Returns `True` if a report means a failure."""
        paths = self.failures if self.state is None else (self.state, *self.failures)
        return any(_says_failed(field_at(report, path)) for path in paths)


@dataclass(frozen=True, slots=True, kw_only=True)
class SetsOff:
    """A report that a command sets off."""

    report: Report[Message]
    """The report."""
    ties: tuple[Tie, ...] = ()
    """The keys that tie a report to a call; empty if there are none."""

    def has_set_off(self, request: Message, answer: Message, report: Message) -> bool:
        """Returns `True` if the report belongs to this call: all tied keys are equal."""
        return all(
            field_at(answer if tie.of_response else request, tie.command) == field_at(report, tie.report)
            for tie in self.ties
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class Command(Facts, Generic[Q, R]):
    """A request with a code, tied to its response."""

    request: type[Q]
    """Type of the request."""
    response: type[R]
    """Type of the response."""
    effect: Effect
    """Effect on the peer."""
    preconditions: Preconditions | None = None
    """Conditions under which it is accepted; `None` if the spec specifies none."""
    errors: type[Result] | None = None
    """The declared results besides success; `None` for none."""
    sets_off: tuple[SetsOff, ...] = ()
    """The reports that it sets off."""

    def accepted_in(self, state: object) -> bool:
        """Returns `True` if it is accepted in this state, as far as states of this enum decide it.

        A value that the spec does not declare is none of them.
        """
        states = self.preconditions.states if self.preconditions is not None else ()
        about = [one for one in states if isinstance(state, one.of) or not isinstance(state, Enum)]
        return all(state in one.values for one in about)


@dataclass(frozen=True, slots=True, kw_only=True)
class Stream(Facts, Generic[B]):
    """Frames of raw bytes, or of JSON without an envelope."""

    body: type[B]
    """Content of its frames: a type of messages, or `bytes`."""
    from_robot: bool
    """`True` if the robot sends it, `False` for the app."""
    content: str | None = None
    """Media type of its content; `None` if not specified."""
    started_by: str | None = None
    """Name of the command after which it is sent."""
    stopped_by: str | None = None
    """Name of the command after which it is no longer sent."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PassThrough:
    """A range of codes that a robot handles without types, except codes with a command."""

    first: int
    """First code."""
    last: int
    """Last code."""
    method: str
    """Name of the robot's method."""


def field_at(message: Message, path: str) -> Any:
    """Returns the value at a path of field names; `None` if a field on the way is absent."""
    value: Any = message
    for name in path.split("."):
        value = None if value is None else getattr(value, name, None)
    return value


def _says_failed(value: Any) -> bool:
    return value is True or getattr(value, "is_error", False) is True
