"""Reading and writing single values: texts, numbers, bools and bytes, in the form of their field."""

from __future__ import annotations

import math
import re
from base64 import b64decode, b64encode
from binascii import Error as Base64Error
from typing import TYPE_CHECKING, Any, TypeAlias

from .constraints import length_check, outside
from .document import Number, has_lone_surrogate, write_text
from .errors import BodyError, BodyErrorKind
from .message import Form, Key, Scalar
from .numbers import hexadecimal, integral, is_number, nearest_double, nearest_float, single, spell_float

if TYPE_CHECKING:
    from collections.abc import Callable

    from .document import Tree

Read: TypeAlias = "Callable[[Tree], Any]"
"""Makes a value from a tree, or raises `BodyError`."""
Write: TypeAlias = "Callable[[Any, list[str]], None]"
"""Appends a value as JSON, or raises `BodyError`."""

_U64_MAX = (1 << 64) - 1
_FEW_DIGITS = 19
_INFINITY = float("inf")


def _wrong(wanted: str) -> BodyError:
    return BodyError(BodyErrorKind.WRONG_TYPE, f"{wanted} is wanted")


def _text(tree: Tree, wanted: str) -> str:
    """Returns the text of a string."""
    if type(tree) is not str:
        raise _wrong(wanted)
    if has_lone_surrogate(tree):
        raise BodyError(BodyErrorKind.LONE_SURROGATE, "half a surrogate pair is no text")
    return tree


def text_codec(key: Key) -> tuple[Read, Write]:
    """Returns reader and writer of texts."""
    check_length = length_check(key, "characters")
    pattern = None if key.pattern is None else re.compile(key.pattern, re.ASCII)
    is_plain = key.length is None and pattern is None

    def check(text: str) -> None:
        check_length(len(text))
        if pattern is not None and pattern.fullmatch(text) is None:
            raise BodyError(BodyErrorKind.BAD_PATTERN, f"the text must match `{key.pattern}` as a whole")

    def read(tree: Tree) -> str:
        if type(tree) is not str or (not tree.isascii() and has_lone_surrogate(tree)):
            return _text(tree, "a text")
        if not is_plain:
            check(tree)
        return tree

    def write(value: Any, out: list[str]) -> None:
        if is_plain and type(value) is str and value.isascii():
            out.append(write_text(value))
            return
        if not isinstance(value, str):
            raise _wrong(f"a text, not {type(value).__name__},")
        _text(str(value), "a text")
        if not is_plain:
            check(value)
        out.append(write_text(value))

    return read, write


def base64_codec(key: Key) -> tuple[Read, Write]:
    """Returns reader and writer of bytes: padded base64 with the standard alphabet."""
    check = length_check(key, "bytes")

    def read(tree: Tree) -> bytes:
        text = _text(tree, "base64")
        try:
            data = b64decode(text, validate=True)
        except (Base64Error, ValueError):
            data = None
        # Too much padding and non-zero spare bits are errors.
        if data is None or b64encode(data).decode("ascii") != text:
            raise BodyError(BodyErrorKind.BAD_BASE64, "send padded base64 of the standard alphabet")
        check(len(data))
        return data

    def write(value: Any, out: list[str]) -> None:
        if not isinstance(value, (bytes, bytearray)):
            raise _wrong(f"bytes, not {type(value).__name__},")
        check(len(value))
        out.append(f'"{b64encode(value).decode("ascii")}"')

    return read, write


def bool_codec(key: Key) -> tuple[Read, Write]:
    """Returns reader and writer of bools: plain, in a string, or as 1 and 0."""
    form, lenient = key.form, key.lenient_bool
    takes_bool = lenient or form is Form.PLAIN
    takes_text = lenient or form is Form.STRING
    takes_number = lenient or form is Form.NUMBER
    spelled = {Form.PLAIN: ("false", "true"), Form.STRING: ('"false"', '"true"'), Form.NUMBER: ("0", "1")}[form]

    def read(tree: Tree) -> bool:
        if isinstance(tree, bool) and takes_bool:
            return tree
        if isinstance(tree, Number):
            value = integral(tree) if takes_number else None
            if value in (0, 1):
                return value == 1
        elif isinstance(tree, str) and takes_text:
            text = _text(tree, "a bool")
            if text in ("true", "false"):
                return text == "true"
        raise _wrong(" or ".join(spelled))

    def write(value: Any, out: list[str]) -> None:
        if not isinstance(value, bool):
            raise _wrong(f"a bool, not {type(value).__name__},")
        out.append(spelled[value])

    return read, write


def _number_text(key: Key, wanted: str) -> Callable[[Tree], str]:
    """Returns the spelling of a number in the form of its field."""
    takes_number = key.form is not Form.STRING or key.lenient_number
    takes_text = key.form is Form.STRING or key.lenient_number

    def spelling(tree: Tree) -> str:
        if isinstance(tree, Number):
            if takes_number:
                return str(tree)
        elif isinstance(tree, str) and takes_text:
            text = _text(tree, wanted)
            if key.lenient_number:
                value = hexadecimal(text)
                if value is not None:
                    if value > _U64_MAX:
                        raise BodyError(BodyErrorKind.OUT_OF_RANGE, "the number is too large")
                    return str(value)
            if is_number(text):
                return text
        raise _wrong(wanted)

    return spelling


def _range(key: Key, low: float | None, high: float | None) -> tuple[float | None, float | None]:
    lows = [bound for bound in (key.min, low) if bound is not None]
    highs = [bound for bound in (key.max, high) if bound is not None]
    return max(lows, default=None), min(highs, default=None)


def integer_codec(scalar: Scalar, key: Key) -> tuple[Read, Write]:
    """Returns reader and writer of integers of a type, within the bounds of their field."""
    low, high = _range(key, scalar.low, scalar.high)
    assert low is not None  # noqa: S101
    assert high is not None  # noqa: S101
    spelling = _number_text(key, f"{scalar.name} as a text" if key.form is Form.STRING else scalar.name)
    quote = '"' if key.form is Form.STRING else ""

    takes_number = key.form is not Form.STRING or key.lenient_number

    def read(tree: Tree) -> int:
        # The usual case: a few digits.
        if type(tree) is Number and takes_number and len(tree) < _FEW_DIGITS and tree.isdigit():
            value = int(tree)
            if not low <= value <= high:
                raise outside(low, high)
            return value
        text = spelling(tree)
        exact = integral(text)
        if exact is None:
            raise _wrong(scalar.name)
        if not low <= exact <= high:
            raise outside(low, high)
        return exact

    def write(value: Any, out: list[str]) -> None:
        if not isinstance(value, int) or isinstance(value, bool):
            raise _wrong(f"{scalar.name}, not {type(value).__name__},")
        if not low <= value <= high:
            raise outside(low, high)
        out.append(f"{quote}{int(value)}{quote}")

    return read, write


def float_codec(scalar: Scalar, key: Key) -> tuple[Read, Write]:
    """Returns reader and writer of floats of a type, within the bounds of their field."""
    low, high = _range(key, None, None)
    is_single = scalar.name == "f32"
    nearest = nearest_float if is_single else nearest_double
    spelling = _number_text(key, f"{scalar.name} as a text" if key.form is Form.STRING else scalar.name)
    quote = '"' if key.form is Form.STRING else ""

    def check(value: float | None, said: object) -> float:
        if value is None or (low is not None and value < low) or (high is not None and value > high):
            raise outside(low, high)
        return value

    takes_number = key.form is not Form.STRING or key.lenient_number
    takes_text = key.form is Form.STRING or key.lenient_number
    is_any = low is None and high is None and not is_single

    def read(tree: Tree) -> float:
        # The usual case: decimal and without bounds.
        kind = type(tree)
        if is_any and ((kind is Number and takes_number) or (kind is str and takes_text and is_number(str(tree)))):
            value = float(str(tree))
            if -_INFINITY < value < _INFINITY:
                return value
        text = spelling(tree)
        return check(nearest(text), text)

    def write(value: Any, out: list[str]) -> None:
        if is_any and type(value) is float and -_INFINITY < value < _INFINITY:
            out.append(f'"{value!r}"' if quote else repr(value))
            return
        if not isinstance(value, (int, float)) or isinstance(value, bool):
            raise _wrong(f"{scalar.name}, not {type(value).__name__},")
        try:
            number = float(value)
        except OverflowError:
            raise outside(low, high) from None
        if not math.isfinite(number):
            raise outside(low, high)
        rounded = check(single(number) if is_single else number, value)
        out.append(quote + spell_float(rounded, is_single=is_single) + quote)

    return read, write
