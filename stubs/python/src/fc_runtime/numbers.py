"""Exact numbers of JSON: an integer in any spelling, and the nearest float of a type."""

from __future__ import annotations

import re
import struct
from decimal import Decimal, localcontext
from typing import Final

_NUMBER: Final = re.compile(r"(-?)([0-9]+)(?:\.([0-9]+))?(?:[eE]([+-]?[0-9]+))?", re.ASCII)
_SPELLED: Final = re.compile(r"-?(?:0|[1-9][0-9]*)(?:\.[0-9]+)?(?:[eE][+-]?[0-9]+)?", re.ASCII)
_HEX: Final = re.compile(r"0[xX][0-9a-fA-F]+", re.ASCII)

# Far more digits than any integer type needs. A number beyond yields another number that is also outside.
_MANY_DIGITS: Final = 40
_FAR: Final = 10**_MANY_DIGITS
# Python refuses to make an int of more digits, and no sensible peer sends such an exponent.
_LONG_EXPONENT: Final = 1000

# Half-way between the largest 32-bit float and the next power of two.
_PAST_THE_LARGEST: Final = 2.0**128 - 2.0**103


def is_number(text: str) -> bool:
    """Returns `True` if a text is a JSON number."""
    return _SPELLED.fullmatch(text) is not None


def hexadecimal(text: str) -> int | None:
    """Returns the number of a text `0x…`; `None` for any other text."""
    if _HEX.fullmatch(text) is None:
        return None
    digits = text[2:].lstrip("0")
    return int(digits or "0", 16) if len(digits) <= _MANY_DIGITS else _FAR


def integral(text: str) -> int | None:
    """Returns the integer value of a number: `1.0` and `1e2` are integers. `None` for a fraction."""
    if len(text) <= _MANY_DIGITS and (text.isdigit() or text[1:].isdigit()):
        return int(text)
    found = _NUMBER.fullmatch(text)
    if found is None:
        return None
    minus, whole, part, exponent = found.group(1), found.group(2), found.group(3) or "", found.group(4) or "0"
    digits = (whole + part).lstrip("0")
    if not digits:
        return 0
    end = len(digits)
    digits = digits.rstrip("0")
    if len(exponent.lstrip("+-0")) > _LONG_EXPONENT:
        return None if exponent.startswith("-") else -_FAR if minus else _FAR
    power = int(exponent) - len(part) + end - len(digits)
    if power < 0:
        return None
    exact = _FAR if len(digits) + power > _MANY_DIGITS else int(digits) * 10**power
    return -exact if minus else exact


def nearest_double(text: str) -> float | None:
    """Returns the nearest double; `None` if the number is too large."""
    value = float(text)
    return None if value in (float("inf"), float("-inf")) else value


def nearest_float(text: str) -> float | None:
    """Returns the nearest 32-bit float; `None` if the number is too large.

    Rounding to a double first would round twice. Half-way between two floats the text decides.
    """
    value = float(text)
    if _is_half_way(value):
        (bits,) = struct.unpack("<Q", struct.pack("<d", value))
        with localcontext() as context:
            context.prec = max(context.prec, len(text) + 2)
            exact, half = abs(Decimal(text)), abs(Decimal(value))
        if exact != half:
            step = 1 if exact > half else -1
            (value,) = struct.unpack("<d", struct.pack("<Q", bits + step))
    return single(value)


def _is_half_way(value: float) -> bool:
    """Returns `True` if a double is exactly half-way between two 32-bit floats."""
    nearest = single(value)
    if nearest is None:
        return abs(value) == _PAST_THE_LARGEST
    # `other` is as far away as `nearest`, on the other side. If it is not a float, the value is not half-way.
    other = 2 * value - nearest
    return nearest != value and single(other) == other


def single(value: float) -> float | None:
    """Returns a double as the nearest 32-bit float; `None` if it is too large."""
    try:
        (rounded,) = struct.unpack("<f", struct.pack("<f", value))
    except OverflowError:
        return None
    return None if rounded in (float("inf"), float("-inf")) else float(rounded)


def spell_float(value: float, *, is_single: bool) -> str:
    """Returns the shortest text that reads as this number."""
    if is_single:
        for digits in range(6, 10):
            text = f"{value:.{digits}g}"
            if single(float(text)) == value:
                return repr(float(text))
    return repr(value)
