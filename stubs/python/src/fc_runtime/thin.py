"""A log that a flood does not flood, and that a program has without asking for it."""

from __future__ import annotations

import logging
from typing import Final

_AT_MOST: Final = 5
_WITHIN: Final = 60.0


class Thin:
    """At most five lines a minute for one cause."""

    def __init__(self) -> None:
        """None has been written."""
        self._since = float("-inf")
        self._lines = 0
        self._held = 0

    def line(self, now: float) -> str | None:
        """What to write behind the next line: how many were left out; `None` if this one is left out too."""
        if now - self._since >= _WITHIN:
            self._since, self._lines = now, 0
        if self._lines >= _AT_MOST:
            self._held += 1
            return None
        self._lines += 1
        held, self._held = self._held, 0
        return f" (held {held})" if held else ""


class ErrorsOnly(logging.Handler):
    """Writes errors to the standard error while the program has no log of its own: they are faults of the program."""

    def __init__(self) -> None:
        """Nothing below an error."""
        super().__init__(logging.ERROR)

    def emit(self, record: logging.LogRecord) -> None:
        """Write a line, unless somebody else does."""
        own = logging.getLogger(__package__).handlers
        if logging.lastResort is not None and not logging.root.handlers and own == [self]:
            logging.lastResort.handle(record)
