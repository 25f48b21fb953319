"""Frames of streams on their way to the app."""

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
    """What it belongs to."""
    id: int
    """The message id of the request that asked for it."""
    data: bytes
    """Its bytes, decompressed."""

    def __repr__(self) -> str:
        """Without its bytes: pictures and maps are no reading."""
        return f"StreamFrame(code=0x{self.code:04X}, id={self.id}, bytes={len(self.data)})"


@dataclass(frozen=True, slots=True)
class StreamItem(Generic[B]):
    """A frame of a stream, read."""

    id: int
    """The message id of the request that asked for it."""
    content: B
    """What it carries."""


class Taker:
    """The queue of one subscription."""

    def __init__(self, code: int) -> None:
        """For the frames of a code."""
        self.code: Final = code
        """Of which code."""
        self.waiting: Final[deque[StreamFrame | DataError]] = deque()
        """What has come."""
        self.missed = 0
        """How many frames have made way."""

    def push(self, arrived: StreamFrame | DataError) -> None:
        """Queue what has come; the oldest frame makes way."""
        if len(self.waiting) >= _QUEUE:
            oldest = next((index for index, one in enumerate(self.waiting) if isinstance(one, StreamFrame)), 0)
            del self.waiting[oldest]
            self.missed += 1
        self.waiting.append(arrived)

    def lost(self, why: Loss) -> None:
        """Note that frames may be missing here."""
        if not self.waiting or not isinstance(self.waiting[-1], DataLostError):
            self.push(DataLostError(why))
