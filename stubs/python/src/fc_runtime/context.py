"""Which request a handler is working on."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from .operations import Effect


class Context:
    """Which request a handler is working on, and whether anybody waits for its result."""

    __slots__ = ("_abandoned", "address", "code", "connection", "effect", "id")

    def __init__(self, connection: int, address: str, code: int, message_id: int, effect: Effect) -> None:
        """Of one request."""
        self.connection: Final = connection
        """The app's connection."""
        self.address: Final = address
        """The app's address."""
        self.code: Final = code
        """Command code."""
        self.id: Final = message_id
        """Message id."""
        self.effect: Final = effect
        """What the command does, for all that is known."""
        self._abandoned = asyncio.Event()

    @property
    def is_abandoned(self) -> bool:
        """Whether nobody waits for the result any more."""
        return self._abandoned.is_set()

    async def abandoned(self) -> None:
        """Wait until nobody waits for the result any more."""
        await self._abandoned.wait()

    def abandon(self) -> None:
        """Nobody waits for the result any more."""
        self._abandoned.set()
