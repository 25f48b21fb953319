"""Reports on their way to apps, and what becomes of them."""

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
    """What has become of a report on its way to one app."""

    ACKNOWLEDGED = "acknowledged"
    """The app has it."""
    REFUSED = "refused"
    """The app has refused it."""
    INVALID = "invalid"
    """The app's answer is no acknowledgement."""
    TIMED_OUT = "timed_out"
    """No acknowledgement came, for all repetitions."""
    DROPPED = "dropped"
    """It made way before it was sent: the app is slow."""
    CLOSED = "closed"
    """The connection ended first."""


@dataclass(frozen=True, slots=True)
class Acknowledgement:
    """What has become of a report on its way to one app."""

    connection: int
    """The app's connection."""
    outcome: Outcome
    """What has become of it."""
    why: Refusal | BodyError | None = None
    """What the app has answered with `REFUSED`, and what is wrong with its answer for `INVALID`."""


class PushError(Exception):
    """A report or a frame of a stream that was not even queued."""

    name: ClassVar[str] = ""
    """Its name, the same in every language."""


class InvalidReportError(PushError):
    """What is to be sent breaks one of its own constraints."""

    name: ClassVar[str] = "invalid_report"

    def __init__(self, error: BodyError) -> None:
        """With what is wrong."""
        super().__init__(f"what is to be sent is invalid: {error}")
        self.error: Final = error
        """What is wrong."""


class FramePushError(PushError):
    """What is to be sent does not fit into a frame."""

    name: ClassVar[str] = "frame"

    def __init__(self, error: FrameError) -> None:
        """With what is wrong."""
        super().__init__(str(error))
        self.error: Final = error
        """What is wrong."""


class NoConnectionError(PushError, LookupError):
    """There is no such connection any more; for a stream: no data connection of that app."""

    name: ClassVar[str] = "no_connection"

    def __init__(self, connection: int) -> None:
        """Says which."""
        super().__init__(f"there is no connection {connection} to send to")
        self.connection: Final = connection
        """Which."""


class AmbiguousError(PushError):
    """Several apps share the address, and nothing tells whose data connection is whose. Nothing was sent."""

    name: ClassVar[str] = "ambiguous"

    def __init__(self, connection: int) -> None:
        """Says whose."""
        super().__init__(f"several apps share the address of {connection}: whose data connection is it?")
        self.connection: Final = connection
        """Whose."""


@dataclass(slots=True, eq=False)
class Push:
    """A report on its way to one app."""

    code: int
    policy: AckPolicy
    prepared: Prepared
    connection: int
    ended: asyncio.Future[Acknowledgement]

    @property
    def size(self) -> int:
        """Bytes that it holds."""
        return len(self.prepared.data)

    def end(self, outcome: Outcome, why: Refusal | BodyError | None = None) -> None:
        """Tell what has become of it."""
        if not self.ended.done():
            self.ended.set_result(Acknowledgement(self.connection, outcome, why))
