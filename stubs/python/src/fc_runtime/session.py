"""The session: matches responses to requests, tracks due times, and detects repeated reports.

It has no sockets and no clock. The caller passes in each event with its time in seconds, and the session returns its
meaning. App and robot use the same class: the app opens commands and receives reports, the robot the reverse.
"""

from __future__ import annotations

import heapq
from collections import deque
from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING, Final, Generic, NamedTuple, TypeVar

from .frame import FrameId

if TYPE_CHECKING:
    from collections.abc import Callable

    from .operations import AckPolicy
    from .protocol import Limits, Protocol

T = TypeVar("T")


class BusyFault(Exception):
    """The error of a request at the limit of requests in flight."""


class Incoming(Enum):
    """Meaning of a received frame."""

    ANSWER = "answer"
    """The response to a request in flight, which ends with it."""
    LATE = "late"
    """A response without a waiting request."""
    COMMAND = "command"
    """A command to handle."""
    REPORT = "report"
    """A report to deliver."""
    REPEATED = "repeated"
    """A report already delivered: only to acknowledge."""
    STREAM = "stream"
    """Raw bytes."""


@dataclass(frozen=True, slots=True)
class Due(Generic[T]):
    """A request that is due."""

    frame: FrameId
    """Its frame."""
    token: T
    """The token given with it."""
    again: bool
    """`True` to send it again, `False` if it ended without a response."""


class _Entry(Generic[T]):
    __slots__ = ("due", "frame", "left", "timeout", "token")

    def __init__(self, frame: FrameId, due: float, policy: AckPolicy, token: T) -> None:
        self.frame: Final = frame
        self.due = due
        self.timeout: Final = policy.timeout
        self.left = policy.retries
        self.token: Final = token


class _Seen(NamedTuple):
    frame: FrameId
    digest: bytes | None
    connection: int
    at: float


class Session(Generic[T]):
    """Requests in flight, and recently delivered reports."""

    def __init__(self, protocol: Protocol, limits: Limits, ack: AckPolicy, first_id: int) -> None:
        """Creates a session without requests."""
        self._protocol: Final = protocol
        self._id_max: Final = protocol.layout.id_max
        half_of_ids = self._id_max // 2 + 1
        self._limit: Final = min(limits.in_flight, half_of_ids)
        self._next_id = first_id & self._id_max
        self._open: Final[dict[int, _Entry[T]]] = {}
        self._deadlines: list[tuple[float, int]] = []
        # A peer repeats its requests in flight, as many as its limit allows.
        most = max(limits.queued_reports, limits.in_flight, protocol.defaults.limits.in_flight)
        self._remembers: Final = min(most, half_of_ids)
        self._remembered_for: Final = 2 * ack.timeout * (ack.retries + 1)
        self._seen: Final[deque[_Seen]] = deque()
        self._ids: Final[dict[int, int]] = {}
        self._connection = 0

    @property
    def in_flight(self) -> int:
        """Number of requests in flight."""
        return len(self._open)

    @property
    def is_full(self) -> bool:
        """`True` at the limit of requests in flight."""
        return len(self._open) >= self._limit

    def open(self, kind: int, code: int, policy: AckPolicy, now: float, token: T) -> FrameId:
        """Opens a request. Raises `BusyFault` if too many are in flight."""
        if self.is_full:
            raise BusyFault
        while self._next_id in self._open:
            self._next_id = (self._next_id + 1) & self._id_max
        frame = FrameId(False, kind, code, self._next_id)
        self._next_id = (self._next_id + 1) & self._id_max
        entry = _Entry(frame, now + policy.timeout, policy, token)
        self._open[frame.id] = entry
        self._schedule(entry)
        return frame

    def _schedule(self, entry: _Entry[T]) -> None:
        # Most requests end before they are due. Their deadlines are removed once there are as many of them as live
        # ones.
        if len(self._deadlines) > 2 * len(self._open) + 16:
            self._deadlines = [(one.due, one.frame.id) for one in self._open.values()]
            heapq.heapify(self._deadlines)
        else:
            heapq.heappush(self._deadlines, (entry.due, entry.frame.id))

    def cancel(self, frame: FrameId) -> bool:
        """Ends a request. Returns `False` if it is not in flight."""
        return self._end(frame) is not None

    def _end(self, frame: FrameId) -> _Entry[T] | None:
        entry = self._open.get(frame.id)
        if entry is None or entry.frame[1:] != frame[1:]:
            return None
        del self._open[frame.id]
        return entry

    def receive(self, frame: FrameId, digest: bytes | None, now: float) -> tuple[Incoming, T | None]:
        """Returns the meaning of a frame and, for a response, the token of its request."""
        if frame.response:
            entry = self._end(frame)
            return (Incoming.LATE, None) if entry is None else (Incoming.ANSWER, entry.token)
        if frame.kind == self._protocol.report:
            return (Incoming.REPEATED if self._has_seen(frame, digest, now) else Incoming.REPORT), None
        return (Incoming.STREAM if frame.kind == self._protocol.stream else Incoming.COMMAND), None

    def _has_seen(self, frame: FrameId, digest: bytes | None, now: float) -> bool:
        if frame.id not in self._ids:
            return False
        for entry in reversed(self._seen):
            if entry.frame != frame:
                continue
            is_recent = now - entry.at <= self._remembered_for
            if digest is None or entry.digest is None:
                is_same = is_recent
            else:
                is_same = entry.digest == digest or (is_recent and entry.connection == self._connection)
            if is_same:
                self._seen.remove(entry)
                self._seen.append(entry._replace(connection=self._connection, at=now))
                return True
        return False

    def handed_on(self, report: FrameId, digest: bytes | None, now: float) -> None:
        """Remembers a delivered report."""
        if self._remembers == 0:
            return
        if len(self._seen) == self._remembers:
            oldest = self._seen.popleft().frame.id
            self._ids[oldest] -= 1
            if self._ids[oldest] == 0:
                del self._ids[oldest]
        self._ids[report.id] = self._ids.get(report.id, 0) + 1
        self._seen.append(_Seen(report, digest, self._connection, now))

    def reconnected(self) -> None:
        """Notes a new connection."""
        self._connection += 1

    def due(self, now: float) -> Due[T] | None:
        """Returns the next request that is due; `None` if there is none."""
        while self._deadlines and self._deadlines[0][0] <= now:
            due, message_id = heapq.heappop(self._deadlines)
            entry = self._open.get(message_id)
            if entry is None or entry.due != due:
                continue
            if entry.left == 0:
                del self._open[message_id]
                return Due(entry.frame, entry.token, again=False)
            entry.left -= 1
            entry.due = now + entry.timeout
            self._schedule(entry)
            return Due(entry.frame, entry.token, again=True)
        return None

    @property
    def next_due(self) -> float | None:
        """Returns the time to call `due`; it may be too early, but never too late."""
        while self._deadlines:
            due, message_id = self._deadlines[0]
            entry = self._open.get(message_id)
            if entry is not None and entry.due == due:
                return due
            heapq.heappop(self._deadlines)
        return None

    def requests(self) -> list[tuple[FrameId, T]]:
        """Returns all requests in flight, in their order of opening."""
        return [(entry.frame, entry.token) for entry in self._open.values()]

    def end_if(self, ends: Callable[[FrameId, T], bool]) -> list[tuple[FrameId, T]]:
        """Ends and returns the requests for which `ends` returns true."""
        ended = [entry for entry in self._open.values() if ends(entry.frame, entry.token)]
        for entry in ended:
            del self._open[entry.frame.id]
        return [(entry.frame, entry.token) for entry in ended]
