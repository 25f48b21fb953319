"""JSON text and the tree that it is read into.

The scanner is that of the standard library, in C; what it leaves open is decided here: numbers keep their spelling,
keys may come twice, nesting and the number of values have limits, and text that is not JSON (`NaN`, a byte order mark)
is refused.
"""

from __future__ import annotations

import json
import re
from json.encoder import encode_basestring
from typing import TYPE_CHECKING, Final, NoReturn, TypeAlias, Union, cast

from .errors import BodyError, BodyErrorKind, quoted

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping


class Number(str):
    """A number as it is spelled."""

    __slots__ = ()


class Entries(list[tuple[str, "Tree"]]):
    """The keys and values of an object, in their order; a key may come twice."""

    __slots__ = ()


Tree: TypeAlias = Union[str, Number, bool, None, "list[Tree]", Entries]
"""What a JSON text is read into."""

Plain: TypeAlias = Union[str, int, float, bool, None, "list[Plain]", "dict[str, Plain]"]
"""What `json.loads` makes of a JSON text."""

DEFAULT_DEPTH: Final = 64
"""Levels of nesting where nobody says otherwise."""
DEFAULT_VALUES: Final = 1 << 20
"""Keys and items where nobody says otherwise."""

_TOKENS: Final = re.compile(r'"[^"\\]*(?:\\.[^"\\]*)*"|[\[\]{}]', re.DOTALL)
_STRINGS: Final = re.compile(r'"[^"\\]*(?:\\.[^"\\]*)*"', re.DOTALL)
_SURROGATE: Final = re.compile("[\ud800-\udfff]")
_PAIRS: Final = re.compile(rb"\{\}|\[\]")
_WITHOUT_WEIGHT: Final = bytes(byte for byte in range(256) if byte not in b'"\\[]{}')
# Levels that are taken off one by one; what is deeper gets a closer look.
_FLAT: Final = 8
_CLOSING: Final = {"[": "]", "{": "}"}


def _refuse(word: str) -> NoReturn:
    raise BodyError(BodyErrorKind.BAD_JSON, f"`{word}` is no JSON")


_DECODER: Final = json.JSONDecoder(
    object_pairs_hook=Entries, parse_float=Number, parse_int=Number, parse_constant=_refuse
)


def _scan(text: str) -> Tree:
    try:
        tree: Tree = _DECODER.decode(text)
    except json.JSONDecodeError as error:
        raise BodyError(BodyErrorKind.BAD_JSON, f"{error.msg} at character {error.pos}") from None
    return tree


def _is_flat(text: str, limit: int) -> bool:
    """Whether brackets are in pairs, and not nested too deeply; false also where that takes a closer look to see."""
    rest = text.encode("utf-8", "surrogatepass").translate(None, _WITHOUT_WEIGHT)
    if b"\\" in rest:
        return False
    # Strings without brackets are pairs of quotes by now. If none is left, no bracket is inside a string.
    rest = rest.replace(b'""', b"")
    for _ in range(min(limit, _FLAT)):
        if not rest:
            return True
        # One level, the innermost of each.
        rest = _PAIRS.sub(b"", rest)
    return not rest


def _check_depth(text: str, limit: int) -> None:
    """Refuses what is nested too deeply, before the scanner uses up the stack for it."""
    if text.count("[") + text.count("{") <= limit or _is_flat(text, limit):
        return
    opened: list[str] = []
    for found in _TOKENS.finditer(text):
        token = found.group()
        if token in _CLOSING:
            if len(opened) >= limit:
                # What is wrong before this place is found first; no digit, which would go on with a number.
                closing = "".join(_CLOSING[one] for one in reversed(opened))
                _scan(text[: found.start()] + "null" + closing)
                raise BodyError(BodyErrorKind.TOO_DEEP, f"nested deeper than {limit} levels")
            opened.append(token)
        elif len(token) == 1 and (not opened or _CLOSING[opened.pop()] != token):
            # No JSON: the scanner stops here at the latest.
            return


def _check_values(text: str, limit: int) -> None:
    # A value takes two bytes at least: itself, and what parts it from the next one.
    if len(text) <= 2 * limit:
        return
    bare = _STRINGS.sub("", text)
    if bare.count(",") + bare.count("[") + bare.count("{") > limit:
        raise BodyError(BodyErrorKind.TOO_MANY_VALUES, f"more than {limit} keys and items")


def parse_text(text: str, depth: int = DEFAULT_DEPTH, values: int = DEFAULT_VALUES) -> Tree:
    """The tree of a JSON text. Raises `BodyError`."""
    _check_depth(text, depth)
    _check_values(text, values)
    return _scan(text)


def parse_body(data: bytes, depth: int = DEFAULT_DEPTH, values: int = DEFAULT_VALUES) -> Entries:
    """The object that a body holds; an empty body stands for one without keys. Raises `BodyError`."""
    if not data:
        return Entries()
    try:
        text = data.decode("utf-8")
    except UnicodeDecodeError as error:
        raise BodyError(BodyErrorKind.NOT_UTF8, f"no UTF-8 at byte {error.start}") from None
    tree = parse_text(text, depth, values)
    if not isinstance(tree, Entries):
        raise BodyError(BodyErrorKind.NOT_AN_OBJECT, "the body has to be an object")
    return tree


def has_lone_surrogate(text: str) -> bool:
    """Whether a text holds half of a surrogate pair, and so is not Unicode."""
    return not text.isascii() and _SURROGATE.search(text) is not None


def write_text(text: str) -> str:
    """A text in quotes."""
    return encode_basestring(text)


def write_tree(tree: Tree, out: list[str]) -> None:
    """Appends the compact text of a tree; numbers keep their spelling."""
    if isinstance(tree, Number):
        out.append(str(tree))
    elif isinstance(tree, str):
        out.append(encode_basestring(tree))
    elif isinstance(tree, Entries):
        separator = "{"
        for key, value in tree:
            out.append(separator)
            out.append(encode_basestring(key))
            out.append(":")
            write_tree(value, out)
            separator = ","
        out.append("}" if separator == "," else "{}")
    elif isinstance(tree, list):
        separator = "["
        for item in cast("list[Tree]", tree):
            out.append(separator)
            write_tree(item, out)
            separator = ","
        out.append("]" if separator == "," else "[]")
    else:
        out.append("null" if tree is None else "true" if tree else "false")


def to_bytes(pieces: list[str]) -> bytes:
    """JSON text as it is sent. Half a surrogate pair that has been kept is escaped again."""
    text = "".join(pieces)
    try:
        return text.encode("utf-8")
    except UnicodeEncodeError:
        return _SURROGATE.sub(lambda found: f"\\u{ord(found.group()):04x}", text).encode("utf-8")


def _plain(tree: Tree) -> Plain:
    if isinstance(tree, Number):
        if tree.lstrip("-").isdigit() and len(tree) < 400:
            return int(tree)
        return float(tree)
    if isinstance(tree, Entries):
        return {key: _plain(value) for key, value in tree}
    if isinstance(tree, list):
        return [_plain(item) for item in cast("list[Tree]", tree)]
    return tree


class Json:
    """A JSON value, kept as it was written: with repeated keys, and numbers that no float can hold."""

    __slots__ = ("_tree",)

    def __init__(self, text: str = "null") -> None:
        """The value of a JSON text. Raises `BodyError` for what is none."""
        self._tree: Tree = parse_text(text)

    @classmethod
    def of(cls, value: Plain) -> Json:
        """A value made of what Python has: `Json.of({"x": [1, None]})`. NaN and infinities raise `ValueError`."""
        return cls(json.dumps(value, allow_nan=False))

    @classmethod
    def of_tree(cls, tree: Tree) -> Json:
        """A value that has been read already."""
        made = cls.__new__(cls)
        made._tree = tree
        return made

    @property
    def tree(self) -> Tree:
        """The value as it was read."""
        return self._tree

    @property
    def text(self) -> str:
        """Its compact text."""
        out: list[str] = []
        write_tree(self._tree, out)
        return "".join(out)

    @property
    def value(self) -> Plain:
        """As `json.loads` would make it: of a key that comes twice, the last one counts."""
        return _plain(self._tree)

    def __eq__(self, other: object) -> bool:
        """Whether the other is written in the same way."""
        return isinstance(other, Json) and self.text == other.text

    def __hash__(self) -> int:
        """By its text."""
        return hash(self.text)

    def __repr__(self) -> str:
        """As it can be made again."""
        return f"Json({quoted(self.text)!r})"


class Extra:
    """The keys of an object that its type does not know, kept in their order and sent again unchanged."""

    __slots__ = ("_entries",)

    def __init__(self, values: Mapping[str, Plain | Json] | None = None) -> None:
        """No keys, or those of a mapping: `Extra({"note": "…"})`."""
        self._entries = Entries()
        for key, value in (values or {}).items():
            self[key] = value

    @classmethod
    def of_entries(cls, entries: Entries) -> Extra:
        """Keys that have been read already."""
        made = cls.__new__(cls)
        made._entries = entries
        return made

    @property
    def entries(self) -> Entries:
        """All keys and values as they were read."""
        return self._entries

    def __getitem__(self, key: str) -> Plain:
        """The last value of a key."""
        for name, tree in reversed(self._entries):
            if name == key:
                return _plain(tree)
        raise KeyError(key)

    def get(self, key: str, default: Plain = None) -> Plain:
        """The last value of a key, or the default."""
        try:
            return self[key]
        except KeyError:
            return default

    def json(self, key: str) -> Json | None:
        """The last value of a key as it was written."""
        found = [tree for name, tree in self._entries if name == key]
        return Json.of_tree(found[-1]) if found else None

    def __setitem__(self, key: str, value: Plain | Json) -> None:
        """Gives a key a value."""
        tree = value.tree if isinstance(value, Json) else Json.of(value).tree
        self._entries = Entries([entry for entry in self._entries if entry[0] != key])
        self._entries.append((key, tree))

    def __contains__(self, key: object) -> bool:
        """Whether there is a value of this key."""
        return any(name == key for name, _ in self._entries)

    def __iter__(self) -> Iterator[str]:
        """The keys in their order; one that came twice comes twice."""
        return (name for name, _ in self._entries)

    def __len__(self) -> int:
        """How many keys there are."""
        return len(self._entries)

    def __bool__(self) -> bool:
        """Whether there are any keys."""
        return bool(self._entries)

    def __eq__(self, other: object) -> bool:
        """Whether the other has the same keys and values in the same order."""
        if not isinstance(other, Extra):
            return False
        ours: list[str] = []
        theirs: list[str] = []
        write_tree(self._entries, ours)
        write_tree(other.entries, theirs)
        return ours == theirs

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        """As it can be made again."""
        return f"Extra({quoted(repr({key: _plain(value) for key, value in self._entries}))})" if self else "Extra()"
