"""Fields that are there only under certain values of the fields beside them.

Reading and writing know nothing of conditions: what a peer sends is taken as it is. Who makes a message asks
`checked()`.
"""

from __future__ import annotations

from enum import Enum
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from .message import Condition


class ConditionErrorKind(str, Enum):
    """How a field contradicts its condition."""

    MISSING = "missing"
    """It is not there although its condition holds."""
    UNASKED = "unasked"
    """It is there although its condition does not hold."""


class ConditionError(ValueError):
    """A message whose field contradicts its condition."""

    def __init__(self, key: str, kind: ConditionErrorKind, condition: Condition, *, is_when: bool) -> None:
        """Says which field, how, and what is asked."""
        words = "when" if is_when else "unless"
        asked = " and ".join(f"`{name}` is {' or '.join(map(_spelled, values))}" for name, values in condition.items())
        if kind is ConditionErrorKind.MISSING:
            text = f"`{key}` is missing: it is sent {words} {asked}"
        else:
            only = "only " if is_when else ""
            text = f"`{key}` is not asked for: it is sent {only}{words} {asked}"
        super().__init__(text)
        self.key: Final = key
        """The wire key of the field."""
        self.kind: Final = kind
        """Whether it is missing, or there without being asked for."""


def _spelled(value: object) -> str:
    if isinstance(value, Enum):
        return _spelled(value.value)
    if isinstance(value, bool):
        return "true" if value else "false"
    return f'"{value}"' if isinstance(value, str) else str(value)
