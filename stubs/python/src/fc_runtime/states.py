"""Whether there is a connection, and what has happened over it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

if TYPE_CHECKING:
    from .calls import Loss


@dataclass(frozen=True, slots=True)
class Connected:
    """There is a connection."""

    connects: int
    """The how manieth since the client was made."""


@dataclass(frozen=True, slots=True)
class Connecting:
    """There is no connection, and one is being made."""

    connects: int
    """How many there have been."""
    why: Loss
    """Why there is none."""


@dataclass(frozen=True, slots=True)
class Closed:
    """There will be no connection any more."""

    connects: int
    """How many there have been."""
    why: Loss
    """Why there is none."""


ConnectionState: TypeAlias = "Connected | Connecting | Closed"
"""Whether there is a connection."""


@dataclass(slots=True)
class ClientCounters:
    """What has happened since the client was made."""

    bytes_in: int = 0
    """Bytes received."""
    bytes_out: int = 0
    """Bytes handed to the connection to be sent."""
    answers: int = 0
    """Responses to calls in flight."""
    late_answers: int = 0
    """Responses that nobody waited for."""
    timeouts: int = 0
    """Calls without a response in time."""
    reports: int = 0
    """Reports queued and acknowledged."""
    reports_missed: int = 0
    """Reports that a receiver missed, and another one took."""
    repeated_reports: int = 0
    """Reports that came again and were acknowledged again."""
    reports_refused: int = 0
    """Reports without a receiver that has room."""
    reports_invalid: int = 0
    """Reports that cannot be read as the type of their code."""
    reports_late: int = 0
    """Reports that came later than their interval allows."""
    reports_out_of_order: int = 0
    """Reports followed whose state came out of order."""
    bad_frames: int = 0
    """Frames that cannot be read."""

    def count_bytes(self, received: int, sent: int) -> None:
        """Count bytes received and sent."""
        self.bytes_in += received
        self.bytes_out += sent
