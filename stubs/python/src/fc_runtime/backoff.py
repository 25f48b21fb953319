"""When to try to connect again."""

from __future__ import annotations

import random
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from .config import Backoff


class Tries:
    """Attempts to connect, and the waits between them."""

    def __init__(self, backoff: Backoff | None) -> None:
        """As configured; `None` gives up at the first failure or loss."""
        self._backoff: Final = backoff
        self._failed = self._waits = 0
        self._is_first = True

    def next(self) -> float | None:
        """How long to wait before the next attempt; `None` if there is to be none."""
        if self._is_first:
            self._is_first = False
            return 0.0
        backoff = self._backoff
        if backoff is None or (backoff.attempts is not None and self._failed >= backoff.attempts):
            return None
        wait = min(backoff.first * (1 << min(self._waits, 20)), backoff.longest)
        self._waits += 1
        return wait * (1 - 0.25 * random.random())  # noqa: S311 - only to part apps

    def failed(self) -> None:
        """The attempt has failed."""
        self._failed += 1

    def connected(self, *, is_used: bool) -> None:
        """There was a connection, and it is lost; waits begin again only if it was of use."""
        self._failed = 0
        self._is_first = False
        if is_used:
            self._waits = 0
