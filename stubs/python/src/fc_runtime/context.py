"""The request that a handler works on."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from .operations import Effect


class Context:
    """The request that a handler works on, with the state of waiting for its result."""

    __slots__ = ("_abandoned", "_waiting", "address", "code", "connection", "effect", "id", "time_ms")

    def __init__(
        self, connection: int, address: str, code: int, message_id: int, effect: Effect, time_ms: int | None = None
    ) -> None:
        """Creates the context of a request."""
        self.connection: Final = connection
        """The app's connection."""
        self.address: Final = address
        """The app's address."""
        self.code: Final = code
        """Command code."""
        self.id: Final = message_id
        """Message id."""
        self.effect: Final = effect
        """Effect of the command; `UNKNOWN` for undeclared codes."""
        self.time_ms: Final = time_ms
        """Time of the request in milliseconds since 1970-01-01T00:00:00Z, if its type is known and it has one."""
        self._abandoned = False
        self._waiting: list[asyncio.Future[None]] | None = None

    @property
    def is_abandoned(self) -> bool:
        """`True` if the result is no longer awaited."""
        return self._abandoned

    async def abandoned(self) -> None:
        """Waits until the result is no longer awaited."""
        if not self._abandoned:
            waiting: asyncio.Future[None] = asyncio.get_running_loop().create_future()
            self._waiting = [*(self._waiting or ()), waiting]
            await waiting

    def abandon(self) -> None:
        """Notes that the result is no longer awaited."""
        self._abandoned = True
        for waiting in self._waiting or ():
            if not waiting.done():
                waiting.set_result(None)
