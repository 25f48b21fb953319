"""A log that a flood does not flood."""

from __future__ import annotations

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
