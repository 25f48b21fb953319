"""The penalty of a connection whose frames cost work and are useless: nothing is read from it for a while."""

from __future__ import annotations

from typing import Final

# Free decompression beyond the bytes received, in bytes per second.
_INFLATED: Final = 128 * 1024 * 1024
# Cost of a useless frame in seconds, and number of free ones: an app of another version does not notice.
_UNUSABLE: Final = 0.001
_FREE: Final = 256


class Pace:
    """The penalty of one connection."""

    def __init__(self) -> None:
        """Creates it without a penalty."""
        self._owed = 0.0
        self._at = 0.0

    def owe(self, unusable: int, surplus: int, now: float) -> float:
        """Returns the seconds that the connection rests after so many useless frames and decompressed bytes."""
        rest = surplus / _INFLATED if surplus > _INFLATED // 1000 else 0.0
        if unusable:
            self._owed = max(0.0, self._owed - (now - self._at)) + unusable * _UNUSABLE
            self._at = now
            rest = max(rest, self._owed - _FREE * _UNUSABLE)
        return rest
