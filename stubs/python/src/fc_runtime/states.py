"""The state of a connection, and its counters."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

if TYPE_CHECKING:
    from .calls import Loss


@dataclass(frozen=True, slots=True)
class Connected:
    """There is a connection."""

    connects: int
    """Number of connections made so far, including this one."""


@dataclass(frozen=True, slots=True)
class Connecting:
    """There is no connection, and one is being made."""

    connects: int
    """Number of connections made so far."""
    why: Loss
    """Reason for having no connection."""


@dataclass(frozen=True, slots=True)
class Closed:
    """There will be no connection any more."""

    connects: int
    """Number of connections made so far."""
    why: Loss
    """Reason for having no connection."""


ConnectionState: TypeAlias = "Connected | Connecting | Closed"
"""The state of a connection."""


@dataclass(slots=True)
class ClientCounters:
    """Counters since the client was made."""

    bytes_in: int = 0
    """Bytes received."""
    bytes_out: int = 0
    """Bytes handed to the connection to be sent."""
    answers: int = 0
    """Responses to calls in flight."""
    late_answers: int = 0
    """Responses that came after their call had ended."""
    timeouts: int = 0
    """Calls without a response in time."""
    reports: int = 0
    """Reports queued and acknowledged."""
    reports_missed: int = 0
    """Reports that one receiver missed while another one took them."""
    repeated_reports: int = 0
    """Repeated reports, which were only acknowledged."""
    reports_refused: int = 0
    """Reports left unacknowledged for lack of room or of a receiver."""
    reports_invalid: int = 0
    """Reports that do not fit the type of their code."""
    reports_late: int = 0
    """Reports that came later than their interval allows."""
    reports_out_of_order: int = 0
    """Followed reports with a state out of order."""
    bad_frames: int = 0
    """Frames that cannot be read."""

    def count_bytes(self, received: int, sent: int) -> None:
        """Count bytes received and sent."""
        self.bytes_in += received
        self.bytes_out += sent
