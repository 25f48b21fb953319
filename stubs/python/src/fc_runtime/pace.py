"""What a connection pays for when its frames make work and cannot be used: for a while nothing is read from it."""

from __future__ import annotations

from typing import Final

# Bytes that a connection may have decompressed for it in a second, beyond those that it has sent.
_INFLATED: Final = 128 * 1024 * 1024
# Seconds that a frame costs which cannot be used, and how many of them are free: an app of another version notices
# nothing.
_UNUSABLE: Final = 0.001
_FREE: Final = 256


class Pace:
    """What one connection has to pay for."""

    def __init__(self) -> None:
        """Nothing is owed."""
        self._owed = 0.0
        self._at = 0.0

    def owe(self, unusable: int, surplus: int, now: float) -> float:
        """How long the connection rests after so many useless frames, and so many bytes decompressed for it."""
        rest = surplus / _INFLATED if surplus > _INFLATED // 1000 else 0.0
        if unusable:
            self._owed = max(0.0, self._owed - (now - self._at)) + unusable * _UNUSABLE
            self._at = now
            rest = max(rest, self._owed - _FREE * _UNUSABLE)
        return rest
