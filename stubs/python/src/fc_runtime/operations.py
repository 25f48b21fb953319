"""Commands, reports and streams as values, with all that the protocol says of them."""

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
    """How the acknowledgement of a report is awaited."""

    timeout: float
    """Seconds to wait before the report is sent again; up to an eighth longer, by connection."""
    retries: int
    """How often to send it again before giving up."""

    def __post_init__(self) -> None:
        """Checks both. Raises `TypeError` and `ValueError`."""
        check_all(self, _ACK)


_ACK: Final[Mapping[str, Check]] = {"timeout": duration, "retries": integer(0)}


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
    method: str = ""
    """What its method is called, where that is not `name`."""

    @property
    def method_name(self) -> str:
        """What its method is called."""
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
class Report(Facts, Generic[Q]):
    """A message that is pushed and acknowledged."""

    request: type[Q]
    """What is reported."""
    response: type[Message]
    """The acknowledgement."""
    ack: AckPolicy | None = None
    """How its acknowledgement is awaited; `None` for the protocol's default."""
    cadence: Cadence | None = None
    """When it is sent; `None` if the spec does not define it."""
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
    """What is asked."""
    response: type[R]
    """What answers it."""
    effect: Effect
    """What it does to the peer."""
    preconditions: Preconditions | None = None
    """What has to hold before it is accepted; `None` where the spec says nothing of that."""
    errors: type[Result] | None = None
    """The results besides success that it declares; `None` where it declares none."""
    sets_off: tuple[SetsOff, ...] = ()
    """The reports that it sets off."""

    def accepted_in(self, state: object) -> bool:
        """Whether it is accepted in this state, as far as it depends on states of this enum.

        One that the spec does not know is none of them.
        """
        states = self.preconditions.states if self.preconditions is not None else ()
        about = [one for one in states if isinstance(state, one.of) or not isinstance(state, Enum)]
        return all(state in one.values for one in about)


@dataclass(frozen=True, slots=True, kw_only=True)
class Stream(Facts, Generic[B]):
    """Frames of raw bytes, or of JSON without an envelope."""

    body: type[B]
    """What its frames hold: a type of messages, or `bytes`."""
    from_robot: bool
    """Whether the robot sends it; otherwise the app does."""
    content: str | None = None
    """Media type of what its frames carry, `None` where none is stated."""
    started_by: str | None = None
    """Name of the command after which it is sent."""
    stopped_by: str | None = None
    """Name of the command after which it is no longer sent."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PassThrough:
    """Codes that a robot hands on as they come, where they have no command."""

    first: int
    """The first."""
    last: int
    """The last."""
    method: str
    """What the method of the robot is called."""


def field_at(message: Message, path: str) -> Any:
    """The value at a path of names of fields; `None` where one on the way is absent."""
    value: Any = message
    for name in path.split("."):
        value = None if value is None else getattr(value, name, None)
    return value


def _says_failed(value: Any) -> bool:
    return value is True or getattr(value, "is_error", False) is True
