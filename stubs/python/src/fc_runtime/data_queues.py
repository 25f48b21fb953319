"""Frames of streams waiting for the app."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, Generic, TypeVar

from .data_errors import DataError, DataLostError

if TYPE_CHECKING:
    from .calls import Loss
    from .message import Message

B = TypeVar("B", bound="Message | bytes")

# Frames waiting for one subscription.
_QUEUE: Final = 4


@dataclass(frozen=True, slots=True)
class StreamFrame:
    """A frame of raw bytes."""

    code: int
    """Code of the command that it belongs to."""
    id: int
    """Message id of the request that asked for it."""
    data: bytes
    """Its bytes, decompressed."""

    def __repr__(self) -> str:
        """Shows it without its bytes."""
        return f"StreamFrame(code=0x{self.code:04X}, id={self.id}, bytes={len(self.data)})"


@dataclass(frozen=True, slots=True)
class StreamItem(Generic[B]):
    """A decoded frame of a stream."""

    id: int
    """Message id of the request that asked for it."""
    content: B
    """The content."""


class Taker:
    """The queue of one subscription."""

    def __init__(self, code: int) -> None:
        """Creates a queue for the frames of a code."""
        self.code: Final = code
        """Code of the frames."""
        self.waiting: Final[deque[StreamFrame | DataError]] = deque()
        """Waiting frames and errors."""
        self.missed = 0
        """Number of frames replaced by later ones."""

    def push(self, arrived: StreamFrame | DataError) -> None:
        """Queues a frame or error. If the queue is full, it replaces the oldest frame."""
        if len(self.waiting) >= _QUEUE:
            oldest = next((index for index, one in enumerate(self.waiting) if isinstance(one, StreamFrame)), 0)
            del self.waiting[oldest]
            self.missed += 1
        self.waiting.append(arrived)

    def lost(self, why: Loss) -> None:
        """Notes that frames may be missing here."""
        if not self.waiting or not isinstance(self.waiting[-1], DataLostError):
            self.push(DataLostError(why))
