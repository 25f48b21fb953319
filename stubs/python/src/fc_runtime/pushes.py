"""Reports to apps, and their outcomes."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING, ClassVar, Final

if TYPE_CHECKING:
    import asyncio

    from .calls import Refusal
    from .errors import BodyError, FrameError
    from .frame import Prepared
    from .operations import AckPolicy


class Outcome(str, Enum):
    """Outcome of a report at one app."""

    ACKNOWLEDGED = "acknowledged"
    """The app acknowledged it."""
    REFUSED = "refused"
    """The app acknowledged it with a result other than success."""
    INVALID = "invalid"
    """The app sent something that is not an acknowledgement."""
    TIMED_OUT = "timed_out"
    """No acknowledgement came, and the repetitions are used up."""
    DROPPED = "dropped"
    """Newer reports replaced it before it was sent: the app is slow."""
    CLOSED = "closed"
    """The connection ended first."""


@dataclass(frozen=True, slots=True)
class Acknowledgement:
    """Outcome of a report at one app."""

    connection: int
    """The app's connection."""
    outcome: Outcome
    """The outcome."""
    why: Refusal | BodyError | None = None
    """The app's refusal for `REFUSED`, the error in its acknowledgement for `INVALID`."""


class PushError(Exception):
    """The error of a report or a stream's frame that was not queued."""

    name: ClassVar[str] = ""
    """Name of the error, the same in every language."""


class InvalidReportError(PushError):
    """The content to send breaks a constraint."""

    name: ClassVar[str] = "invalid_report"

    def __init__(self, error: BodyError) -> None:
        """Creates the error from the error in the content."""
        super().__init__(f"what is to be sent is invalid: {error}")
        self.error: Final = error
        """The error in the content."""


class FramePushError(PushError):
    """The content to send does not fit into a frame."""

    name: ClassVar[str] = "frame"

    def __init__(self, error: FrameError) -> None:
        """Creates the error from the frame's error."""
        super().__init__(str(error))
        self.error: Final = error
        """The error of the frame."""


class NoConnectionError(PushError, LookupError):
    """The connection does not exist any more. For a stream: that app has no data connection."""

    name: ClassVar[str] = "no_connection"

    def __init__(self, connection: int) -> None:
        """Creates the error for a connection."""
        super().__init__(f"there is no connection {connection} to send to")
        self.connection: Final = connection
        """The connection."""


class AmbiguousError(PushError):
    """Several apps share the address, so the app's data connection is unknown. The frame was not sent."""

    name: ClassVar[str] = "ambiguous"

    def __init__(self, connection: int) -> None:
        """Creates the error for an app."""
        super().__init__(f"several apps share the address of {connection}: whose data connection is it?")
        self.connection: Final = connection
        """The app's connection."""


@dataclass(slots=True, eq=False)
class Push:
    """A report to one app."""

    code: int
    policy: AckPolicy
    prepared: Prepared
    connection: int
    ended: asyncio.Future[Acknowledgement]

    @property
    def size(self) -> int:
        """Bytes of the report."""
        return len(self.prepared.data)

    def end(self, outcome: Outcome, why: Refusal | BodyError | None = None) -> None:
        """Sets the outcome."""
        if not self.ended.done():
            self.ended.set_result(Acknowledgement(self.connection, outcome, why))
