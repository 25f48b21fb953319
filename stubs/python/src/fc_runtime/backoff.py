"""Waits between attempts to connect."""

from __future__ import annotations

import random
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from .config import Backoff


class Tries:
    """Attempts to connect, and the waits between them."""

    def __init__(self, backoff: Backoff | None) -> None:
        """Creates the waits as configured; `None` gives up at the first failure or loss."""
        self._backoff: Final = backoff
        self._failed = self._waits = 0
        self._is_first = True

    def next(self) -> float | None:
        """Returns the seconds to wait before the next attempt; `None` to give up."""
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
        """Notes a failed attempt."""
        self._failed += 1

    def connected(self, *, is_used: bool) -> None:
        """Notes a connection that was made and lost. The waits start again only if it was used."""
        self._failed = 0
        self._is_first = False
        if is_used:
            self._waits = 0
