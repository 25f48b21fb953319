"""Numbers of JSON, exactly: an integer stays one whatever its spelling, a float is the nearest of its type."""

from __future__ import annotations

import re
import struct
from decimal import Decimal, localcontext
from typing import Final

_NUMBER: Final = re.compile(r"(-?)([0-9]+)(?:\.([0-9]+))?(?:[eE]([+-]?[0-9]+))?", re.ASCII)
_SPELLED: Final = re.compile(r"-?(?:0|[1-9][0-9]*)(?:\.[0-9]+)?(?:[eE][+-]?[0-9]+)?", re.ASCII)
_HEX: Final = re.compile(r"0[xX][0-9a-fA-F]+", re.ASCII)

# Digits that no integer type has, by far. What is beyond comes out as some number that is, too.
_MANY_DIGITS: Final = 40
_FAR: Final = 10**_MANY_DIGITS
# Python refuses to make an int of more digits than this, and nobody sends such an exponent in earnest.
_LONG_EXPONENT: Final = 1000

# Half-way between the largest float of 32 bits and the one that would come next.
_PAST_THE_LARGEST: Final = 2.0**128 - 2.0**103


def is_number(text: str) -> bool:
    """Whether a text is spelled as a number of JSON."""
    return _SPELLED.fullmatch(text) is not None


def hexadecimal(text: str) -> int | None:
    """The number that `0x…` stands for; `None` for any other text."""
    if _HEX.fullmatch(text) is None:
        return None
    digits = text[2:].lstrip("0")
    return int(digits or "0", 16) if len(digits) <= _MANY_DIGITS else _FAR


def integral(text: str) -> int | None:
    """The integer that a number amounts to: `1.0` and `1e2` are integers. `None` for a fraction."""
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
    """The nearest double; `None` where none is large enough."""
    value = float(text)
    return None if value in (float("inf"), float("-inf")) else value


def nearest_float(text: str) -> float | None:
    """The nearest float of 32 bits; `None` where none is large enough.

    To round to a double first may round twice: half-way between two floats the text itself decides.
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
    """Whether a double is exactly half-way between two floats of 32 bits."""
    nearest = single(value)
    if nearest is None:
        return abs(value) == _PAST_THE_LARGEST
    # As far on the other side as the nearest is on this one: closer than half-way, no float is there.
    other = 2 * value - nearest
    return nearest != value and single(other) == other


def single(value: float) -> float | None:
    """A double as the nearest float of 32 bits; `None` where none is large enough."""
    try:
        (rounded,) = struct.unpack("<f", struct.pack("<f", value))
    except OverflowError:
        return None
    return None if rounded in (float("inf"), float("-inf")) else float(rounded)


def spell_float(value: float, *, is_single: bool) -> str:
    """The shortest text that is read as this number again."""
    if is_single:
        for digits in range(6, 10):
            text = f"{value:.{digits}g}"
            if single(float(text)) == value:
                return repr(float(text))
    return repr(value)
