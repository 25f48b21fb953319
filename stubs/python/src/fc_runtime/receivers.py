"""Reports waiting for the app, in a queue for each receiver, with events between them."""

from __future__ import annotations

import asyncio
from collections import deque
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from .calls import Loss


@dataclass(frozen=True, slots=True)
class RawReport:
    """A report as received, without types."""

    code: int
    """Its code."""
    id: int
    """Its message id."""
    data: bytes
    """Its JSON text."""

    def __repr__(self) -> str:
        """Shows it without its text, which may contain anything."""
        return f"RawReport(code=0x{self.code:04X}, id={self.id}, bytes={len(self.data)})"


@dataclass(frozen=True, slots=True)
class Missed:
    """The queue was full, so these reports went only to other receivers."""

    count: int
    """Number of reports."""


@dataclass(frozen=True, slots=True)
class Interrupted:
    """The connection was lost. Reports sent meanwhile may not be repeated."""

    why: Loss
    """Reason."""


@dataclass(frozen=True, slots=True)
class Resumed:
    """There is a connection again."""


class Receiver:
    """The queue of one receiver."""

    def __init__(self, limit: int, bytes_limit: int, codes: frozenset[int] | None) -> None:
        """Creates a queue for the reports of these codes; `None` for all."""
        self._limit: Final = limit
        self._bytes_limit: Final = bytes_limit
        self._codes: Final = codes
        self._events: Final[deque[RawReport | Missed | Interrupted | Resumed]] = deque()
        self._reports = 0
        self._bytes = 0
        self._waiting: asyncio.Future[None] | None = None
        self._is_over = False
        self.missed = 0
        """Number of reports missed because its queue was full."""

    def is_for(self, code: int) -> bool:
        """Returns `True` if it takes reports of a code."""
        return not self._is_over and (self._codes is None or code in self._codes)

    def has_room(self, size: int) -> bool:
        """Returns `True` if a report of this size fits."""
        return self._reports < self._limit and self._bytes + size <= self._bytes_limit

    def put(self, report: RawReport) -> None:
        """Queues a report."""
        self._reports += 1
        self._bytes += len(report.data)
        self._put(report)

    def miss(self) -> None:
        """Counts a report without room."""
        self.missed += 1
        if self._events and isinstance(last := self._events[-1], Missed):
            self._events[-1] = Missed(last.count + 1)
        else:
            self._put(Missed(1))

    def lost(self, why: Loss) -> None:
        """Notes a loss. Losses without a report in between count as one."""
        while self._events and isinstance(self._events[-1], (Interrupted, Resumed)):
            self._events.pop()
        self._put(Interrupted(why))

    def connected(self) -> None:
        """Notes a new connection."""
        self._put(Resumed())

    def _put(self, event: RawReport | Missed | Interrupted | Resumed) -> None:
        self._events.append(event)
        self._wake()

    def _wake(self) -> None:
        if self._waiting is not None and not self._waiting.done():
            self._waiting.set_result(None)

    def end(self) -> None:
        """Ends the queue."""
        self._is_over = True
        self._wake()

    def take(self) -> RawReport | Missed | Interrupted | Resumed | None:
        """Returns the next event, if there is one."""
        if not self._events:
            return None
        event = self._events.popleft()
        if isinstance(event, RawReport):
            self._reports -= 1
            self._bytes -= len(event.data)
        return event

    async def next(self) -> RawReport | Missed | Interrupted | Resumed | None:
        """Returns the next event; `None` once the connection is over and the queue is empty."""
        while (event := self.take()) is None:
            if self._is_over:
                return None
            self._waiting = asyncio.get_running_loop().create_future()
            try:
                await self._waiting
            finally:
                self._waiting = None
        return event
