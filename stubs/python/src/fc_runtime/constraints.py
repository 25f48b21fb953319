"""What a field demands of its values beyond their type: asked when the whole object has been read."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any, Final, cast

from .errors import BodyError, BodyErrorKind
from .values import length_check, outside

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from .message import Key

_CONSTRAINTS: Final = {"min": None, "max": None, "length": None, "pattern": None, "only": ()}


def without_constraints() -> dict[str, Any]:
    """What to replace in a key for one that demands nothing but its type."""
    return dict(_CONSTRAINTS)


def constraint(key: Key) -> Callable[[Any], None] | None:
    """What raises `BodyError` for a value that the key does not take; `None` if the key takes all of its type."""
    if all(getattr(key, name) == nothing for name, nothing in _CONSTRAINTS.items()):
        return None
    low, high = key.min, key.max
    check_length = length_check(key, "characters, bytes or items")
    pattern = None if key.pattern is None else re.compile(key.pattern, re.ASCII)
    only = frozenset(member.value for member in key.only)

    def check(value: Any) -> None:
        if (low is not None and any(one < low for one in _each(value))) or (
            high is not None and any(one > high for one in _each(value))
        ):
            raise outside(low, high)
        if key.length is not None:
            check_length(len(value))
        if pattern is not None and not all(pattern.fullmatch(one) for one in _each(value)):
            raise BodyError(BodyErrorKind.BAD_PATTERN, f"the text must match `{key.pattern}` as a whole")
        if only and any(one.value not in only for one in _each(value)):
            taken = ", ".join(str(one) for one in sorted(only, key=str))
            raise BodyError(BodyErrorKind.OUT_OF_RANGE, f"the value must be one of: {taken}")

    return check


def _each(value: Any) -> Iterator[Any]:
    """A value, or the items of a list."""
    if isinstance(value, list):
        for item in cast("Sequence[Any]", value):
            yield from _each(item)
    else:
        yield value
