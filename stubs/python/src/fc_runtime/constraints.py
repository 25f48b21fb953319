"""The constraints of a field on its values: declared with its `Key`, checked after reading the whole object."""

from __future__ import annotations

import re
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any, cast

from .errors import BodyError, BodyErrorKind

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence
    from enum import Enum


@dataclass(frozen=True, slots=True, kw_only=True)
class Constraints:
    """Constraints of a field on its values, in addition to the type."""

    min: float | None = None
    """Least value of a number."""
    max: float | None = None
    """Greatest value of a number."""
    length: tuple[int, int] | None = None
    """Fewest and most characters of a text, bytes of a base64, items of a list."""
    pattern: str | None = None
    """Regular expression that a text must match as a whole."""
    only: tuple[Enum, ...] = ()
    """Values of its enum that it takes; empty for all."""


_NONE = Constraints()


def without_constraints() -> dict[str, Any]:
    """Returns the fields that remove all constraints from a key."""
    return {field.name: getattr(_NONE, field.name) for field in fields(Constraints)}


def constraint(key: Constraints) -> Callable[[Any], None] | None:
    """Returns a function that raises `BodyError` for a value that breaks a constraint; `None` without constraints."""
    if all(getattr(key, name) == nothing for name, nothing in without_constraints().items()):
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


def length_check(key: Constraints, of: str) -> Callable[[int], None]:
    """Returns a check of a value's length."""
    if key.length is None:
        return lambda _: None
    least, most = key.length

    def check(found: int) -> None:
        if not least <= found <= most:
            wanted = str(least) if least == most else f"{least} … {most}"
            raise BodyError(BodyErrorKind.BAD_LENGTH, f"{found} {of}; {wanted} are wanted")

    return check


def outside(low: float | None, high: float | None) -> BodyError:
    """Returns the error of a number outside these bounds."""
    least, most = ("−∞" if low is None else low), ("∞" if high is None else high)
    return BodyError(BodyErrorKind.OUT_OF_RANGE, f"the number must be within {least} … {most}")


def _each(value: Any) -> Iterator[Any]:
    """Yields a value, or the items of a list."""
    if isinstance(value, list):
        for item in cast("Sequence[Any]", value):
            yield from _each(item)
    else:
        yield value
