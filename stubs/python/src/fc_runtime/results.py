"""Result codes by name: those of a protocol, and those besides success that a command declares."""

from __future__ import annotations

from enum import Enum
from typing import TypeVar

from .calls import Refusal

E = TypeVar("E", bound="Result")


class Result(Enum):
    """Results by name. Each value is a code and the text that is sent beside it."""

    code: int
    """The code on the wire."""
    text: str
    """The text sent beside it, for people only."""

    def __init__(self, code: int, text: str) -> None:
        """As the values say."""
        self.code = code
        self.text = text

    def refusal(self, why: str = "") -> Refusal:
        """What a handler raises to answer with this result; `why` goes behind the text."""
        return Refusal(self.code, f"{self.text}: {why}" if why else self.text)

    @classmethod
    def of(cls: type[E], code: int) -> E | None:
        """The one with this code."""
        return next((one for one in cls if one.code == code), None)
