"""Fields that are present only for certain values of neighbouring fields.

Reading and writing ignore conditions: messages from peers are accepted unchanged. `checked()` checks a message that the
program creates.
"""

from __future__ import annotations

from enum import Enum
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from .message import Condition


class ConditionErrorKind(str, Enum):
    """Ways for a field to contradict its condition."""

    MISSING = "missing"
    """The field is absent although its condition holds."""
    UNASKED = "unasked"
    """The field is present although its condition does not hold."""


class ConditionError(ValueError):
    """The error of a field that contradicts its condition."""

    def __init__(self, key: str, kind: ConditionErrorKind, condition: Condition, *, is_when: bool) -> None:
        """Creates the error for a field and its condition."""
        words = "when" if is_when else "unless"
        asked = " and ".join(f"`{name}` is {' or '.join(map(_spelled, values))}" for name, values in condition.items())
        if kind is ConditionErrorKind.MISSING:
            text = f"`{key}` is missing: it is sent {words} {asked}"
        else:
            only = "only " if is_when else ""
            text = f"`{key}` is not asked for: it is sent {only}{words} {asked}"
        super().__init__(text)
        self.key: Final = key
        """The key of the field."""
        self.kind: Final = kind
        """The way the field contradicts its condition."""


def _spelled(value: object) -> str:
    if isinstance(value, Enum):
        return _spelled(value.value)
    if isinstance(value, bool):
        return "true" if value else "false"
    return f'"{value}"' if isinstance(value, str) else str(value)
