"""Results by name: those of a protocol, and those besides success that a command declares."""

from __future__ import annotations

from enum import Enum
from typing import TypeVar

from .calls import Refusal

E = TypeVar("E", bound="Result")


class Result(Enum):
    """Results by name. Each value is a code and its text."""

    code: int
    """The code on the wire."""
    text: str
    """The text of the result, for people only."""

    def __init__(self, code: int, text: str) -> None:
        """Creates a result from its value."""
        self.code = code
        self.text = text

    def refusal(self, why: str = "") -> Refusal:
        """Returns the refusal that a handler raises for this result. `why` is appended to the text."""
        return Refusal(self.code, f"{self.text}: {why}" if why else self.text)

    @classmethod
    def of(cls: type[E], code: int) -> E | None:
        """Returns the result with this code."""
        return next((one for one in cls if one.code == code), None)
