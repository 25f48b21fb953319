"""Checks of settings and call options. A wrong value raises where it is given, before it takes effect.

A check raises `TypeError` for a value of another type, and `ValueError` for one that is out of range.
"""

from __future__ import annotations

import math
from dataclasses import fields
from typing import TYPE_CHECKING, Any, Final, TypeAlias

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

Check: TypeAlias = "Callable[[str, Any], None]"
"""Raises for a wrong value of the setting with this name."""

# Longest quotation of a wrong value.
_LONGEST: Final = 60


def check_all(settings: Any, checks: Mapping[str, Check]) -> None:
    """Checks every field of a dataclass. Raises `KeyError` for a field without a check."""
    for field in fields(settings):
        checks[field.name](f"{type(settings).__name__}.{field.name}", getattr(settings, field.name))


def wrong(name: str, value: object, expected: str) -> str:
    """Returns a message with the value found and the one expected."""
    shown = repr(value)
    shown = shown if len(shown) <= _LONGEST else shown[:_LONGEST] + "…"
    return f"`{name}` is {shown}, expected {expected}"


def duration(name: str, value: Any) -> None:
    """Checks a time in seconds: a finite number from 0."""
    _number(name, value, 0, None, "a finite number of seconds from 0")


def keepalive(name: str, value: Any) -> None:
    """Checks a time in seconds for TCP probes."""
    _number(name, value, 0, 32_767, "a number of seconds from 0 to 32767")


def _number(name: str, value: Any, least: float, most: float | None, expected: str) -> None:
    if not isinstance(value, (int, float)) or isinstance(value, bool):
        raise TypeError(wrong(name, value, expected))
    try:
        number = float(value)
    except OverflowError:
        number = math.inf
    if not math.isfinite(number) or number < least or (most is not None and number > most):
        raise ValueError(wrong(name, value, expected))


def integer(least: int, most: int | None = None) -> Check:
    """Makes a check of an integer in a range."""
    expected = f"an integer from {least}" if most is None else f"an integer from {least} to {most}"

    def check(name: str, value: Any) -> None:
        if not isinstance(value, int) or isinstance(value, bool):
            raise TypeError(wrong(name, value, expected))
        if value < least or (most is not None and value > most):
            raise ValueError(wrong(name, value, expected))

    return check


def of_type(kind: type | tuple[type, ...], expected: str) -> Check:
    """Makes a check of a value of a type."""

    def check(name: str, value: Any) -> None:
        if not isinstance(value, kind):
            raise TypeError(wrong(name, value, expected))

    return check


flag: Final[Check] = of_type(bool, "True or False")
"""Checks a bool."""


def function(name: str, value: Any) -> None:
    """Checks something that can be called."""
    if not callable(value):
        raise TypeError(wrong(name, value, "a function"))


def host(name: str, value: Any) -> None:
    """Checks a name or address. The system takes an empty one for any address."""
    expected = "a name or address"
    if not isinstance(value, str):
        raise TypeError(wrong(name, value, expected))
    if not value.strip() or "\0" in value:
        raise ValueError(wrong(name, value, expected))


def or_none(check: Check) -> Check:
    """Makes a check that `None` passes as well."""

    def check_unless_none(name: str, value: Any) -> None:
        if value is not None:
            check(name, value)

    return check_unless_none


def or_word(word: str, check: Check) -> Check:
    """Makes a check that this word and `None` pass as well."""

    def check_unless_word(name: str, value: Any) -> None:
        if value is not None and value != word:
            check(name, value)

    return check_unless_word
