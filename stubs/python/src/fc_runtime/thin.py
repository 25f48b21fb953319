"""Limits the lines of a log, and logs errors by default."""

from __future__ import annotations

import logging
from typing import Final

_AT_MOST: Final = 5
_WITHIN: Final = 60.0


class Thin:
    """Allows five lines a minute for one cause."""

    def __init__(self) -> None:
        """Creates the count at zero."""
        self._since = float("-inf")
        self._lines = 0
        self._held = 0

    def line(self, now: float) -> str | None:
        """Returns the suffix of the next line, with the number of lines left out; `None` to leave this one out too."""
        if now - self._since >= _WITHIN:
            self._since, self._lines = now, 0
        if self._lines >= _AT_MOST:
            self._held += 1
            return None
        self._lines += 1
        held, self._held = self._held, 0
        return f" (held {held})" if held else ""


class ErrorsOnly(logging.Handler):
    """Writes errors to the standard error while the program has no log: they are bugs of the program."""

    def __init__(self) -> None:
        """Creates the handler for errors only."""
        super().__init__(logging.ERROR)

    def emit(self, record: logging.LogRecord) -> None:
        """Writes a line, unless another handler does."""
        own = logging.getLogger(__package__).handlers
        if logging.lastResort is not None and not logging.root.handlers and own == [self]:
            logging.lastResort.handle(record)
