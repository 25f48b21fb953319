"""The state of a connection, with tasks that wait for a change."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Final

from .calls import Loss, LossKind
from .states import Closed, Connecting

if TYPE_CHECKING:
    from collections.abc import AsyncIterator

    from .states import ConnectionState


class Life:
    """The state of a connection."""

    def __init__(self) -> None:
        """Creates the state before the first connection."""
        self.state: ConnectionState = Connecting(0, Loss(LossKind.NOT_YET))
        """The present state."""
        self._watchers: Final[set[asyncio.Future[None]]] = set()

    @property
    def is_closed(self) -> bool:
        """`True` if there will be no connection any more."""
        return isinstance(self.state, Closed)

    def turn(self, state: ConnectionState) -> None:
        """Changes to another state; `Closed` is the last."""
        if not self.is_closed:
            self.state = state
            for watcher in self._watchers:
                if not watcher.done():
                    watcher.set_result(None)

    async def states(self) -> AsyncIterator[ConnectionState]:
        """Yields the present state, then each change; `Closed` is the last. A slow reader gets the latest."""
        seen: ConnectionState | None = None
        while True:
            if self.state != seen:
                seen = self.state
                yield seen
            if isinstance(seen, Closed):
                return
            if self.state == seen:
                changed: asyncio.Future[None] = asyncio.get_running_loop().create_future()
                self._watchers.add(changed)
                try:
                    await changed
                finally:
                    self._watchers.discard(changed)

    async def closed(self) -> Loss:
        """Waits until the connection has ended for good. Returns the reason."""
        async for state in self.states():
            if isinstance(state, Closed):
                return state.why
        raise AssertionError("states end with `Closed`")
