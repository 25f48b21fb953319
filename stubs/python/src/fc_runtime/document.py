"""JSON text, and the tree that it is read into.

The scanner of the standard library, in C, reads the text. This module adds the rest. Numbers keep their spelling, and
keys may be repeated. Nesting and the number of values have limits. Invalid text (`NaN`, a byte order mark) is refused.
"""

from __future__ import annotations

import json
import re
from itertools import accumulate
from json.encoder import encode_basestring
from typing import TYPE_CHECKING, Final, NoReturn, TypeAlias, Union, cast

from .errors import BodyError, BodyErrorKind, quoted

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping


class Number(str):
    """A number with its spelling."""

    __slots__ = ()


class Entries(list[tuple[str, "Tree"]]):
    """The keys and values of an object, in their order; keys may be repeated."""

    __slots__ = ()


Tree: TypeAlias = Union[str, Number, bool, None, "list[Tree]", Entries]
"""The tree of a JSON text."""

Plain: TypeAlias = Union[str, int, float, bool, None, "list[Plain]", "dict[str, Plain]"]
"""A value as `json.loads` returns it."""

DEFAULT_DEPTH: Final = 64
"""Default limit of nesting levels."""
DEFAULT_VALUES: Final = 1 << 20
"""Default limit of keys and items."""

MAX_DEPTH: Final = 127
"""Greatest nesting that can be read, for any configuration."""

_SURROGATE: Final = re.compile("[\ud800-\udfff]")
# Size of a chunk of the survey, in bytes.
_CHUNK: Final = 1 << 16
_SPACES: Final = " \t\n\r"
_SPACE: Final = _SPACES.encode()
# Maps brackets, commas and quotes to themselves, and all other bytes to `0`.
_STRUCTURE: Final = bytes(byte if byte in b'[]{},"' else ord("0") for byte in range(256))
_STEPS: Final = {ord("["): 1, ord("{"): 1, ord("]"): -1, ord("}"): -1}
_TOKENS: Final = re.compile(rb'"[^"\\]*(?:\\.[^"\\]*)*"?|[\[\]{},]|[^"\[\]{}, \t\n\r]+', re.DOTALL)
_REST: Final = re.compile(rb'[^"\\]*(?:\\.[^"\\]*)*"?', re.DOTALL)


def _refuse(word: str) -> NoReturn:
    raise BodyError(BodyErrorKind.BAD_JSON, f"`{word}` is no JSON")


_DECODER: Final = json.JSONDecoder(
    object_pairs_hook=Entries, parse_float=Number, parse_int=Number, parse_constant=_refuse
)
# Finds invalid JSON, and keeps little of the text.
_CHECKER: Final = json.JSONDecoder(object_pairs_hook=len, parse_float=len, parse_int=len, parse_constant=_refuse)


def _scan(text: str) -> Tree:
    try:
        tree: Tree = _DECODER.decode(text)
    except json.JSONDecodeError as error:
        raise _bad_json(error) from None
    return tree


def _bad_json(error: json.JSONDecodeError) -> BodyError:
    return BodyError(BodyErrorKind.BAD_JSON, f"{error.msg} at character {error.pos}")


class _Survey:
    """Counts depth and values of a text as a reader does, and stops at the first place beyond a limit.

    It scans whole chunks, and single brackets only in the chunk with that place. The scanner finds invalid JSON.
    """

    def __init__(self, data: bytes, depth: int, values: int) -> None:
        self._data: Final = data
        self._depth: Final = depth
        self._values: Final = values
        # State before the chunk: level, count, and if it begins inside a string. `_open_at` is the place of a bracket
        # right before it, which may open an empty list or object. It is counted with the chunk.
        self._level = self._count = 0
        self._is_inside = False
        self._open_at: int | None = None

    def check(self) -> None:
        """Raises `BodyError`."""
        data, at = self._data, 0
        while at < len(data):
            end = min(at + _CHUNK, len(data))
            # An escape must not be split between chunks.
            run = end - len(data[at:end].rstrip(b"\\")) - at
            end += run % 2
            if not self._takes(at, end):
                self._find(at, end)
                return
            at = end

    def _takes(self, at: int, end: int) -> bool:
        """Counts a chunk. Returns `False` if a place in it is beyond a limit."""
        chunk = self._data[at:end]
        if b"\\" in chunk:
            chunk = chunk.replace(b"\\\\", b"").replace(b'\\"', b"")
        parts = chunk.split(b'"')
        # Reduces each string to one quote.
        bare = b'"'.join(parts[1 if self._is_inside else 0 :: 2])
        if self._is_inside:
            bare = b'"' + bare
        is_inside = self._is_inside ^ (len(parts) % 2 == 0)
        bare = bare.translate(_STRUCTURE, _SPACE) + (b'"' if is_inside else b"")
        if self._open_at is not None:
            bare = self._data[self._open_at : self._open_at + 1] + bare
        opened = bare.count(b"[") + bare.count(b"{")
        if self._level + opened > self._depth and not self._is_flat(bare.translate(None, b'0,"')):
            return False
        is_open = bare.endswith((b"[", b"{"))
        count = self._count + bare.count(b",") + opened - bare.count(b"[]") - bare.count(b"{}") - is_open
        if count > self._values:
            return False
        self._level += opened - is_open - bare.count(b"]") - bare.count(b"}")
        self._count, self._is_inside = count, is_inside
        self._open_at = max(self._data.rfind(one, 0, end) for one in (b"[", b"{")) if is_open else None
        return True

    def _is_flat(self, brackets: bytes) -> bool:
        """Returns `True` if no bracket exceeds the limit."""
        # Most texts have few levels: without the two innermost of each place, few brackets remain.
        rest = brackets.replace(b"[]", b"").replace(b"{}", b"")
        if self._level + 2 + len(rest) <= self._depth:
            return True
        return max(accumulate(map(_STEPS.__getitem__, brackets), initial=self._level)) <= self._depth

    def _find(self, at: int, end: int) -> None:
        """Raises `BodyError` for the first place in this chunk that is beyond a limit."""
        level, count, opened = self._level, self._count, self._open_at
        level += opened is not None
        if self._is_inside:
            rest = _REST.match(self._data, at, end)
            at = at if rest is None else rest.end()
        for found in _TOKENS.finditer(self._data, at, end):
            token = found.group()
            # The token after an open bracket is its first value, unless it is the closing one.
            count += token == b"," or (opened is not None and token not in b"]}")
            if count > self._values:
                place = found.end() if token == b"," else found.start()
                self._refuse(place, BodyErrorKind.TOO_MANY_VALUES, f"more than {self._values} keys and items")
            opened = found.start() if token in b"[{" else None
            level += _STEPS.get(token[0], 0)
            if level > self._depth:
                self._refuse(found.end(), BodyErrorKind.TOO_DEEP, f"nested deeper than {self._depth} levels")

    def _refuse(self, place: int, kind: BodyErrorKind, detail: str) -> NoReturn:
        """Raises `BodyError` of this kind. Invalid JSON before this place takes precedence."""
        text = self._data[:place].decode("utf-8", "replace")
        try:
            _CHECKER.decode(text)
        except json.JSONDecodeError as error:
            # The reader reports a truncated text.
            if error.pos < len(text.rstrip(_SPACES)):
                raise _bad_json(error) from None
        raise BodyError(kind, detail)


def _check_limits(data: bytes, depth: int, values: int) -> None:
    """Raises `BodyError` for a text that is nested too deeply, or holds too many values."""
    depth = min(depth, MAX_DEPTH)
    # A value takes at least two bytes: one for itself and one for its separator.
    if len(data) > 2 * values or data.count(b"[") + data.count(b"{") > depth:
        _Survey(data, depth, values).check()


def parse_text(text: str, depth: int = DEFAULT_DEPTH, values: int = DEFAULT_VALUES) -> Tree:
    """Returns the tree of a JSON text. Raises `BodyError`."""
    _check_limits(text.encode("utf-8", "surrogatepass"), depth, values)
    return _scan(text)


def parse_body(data: bytes, depth: int = DEFAULT_DEPTH, values: int = DEFAULT_VALUES) -> Entries:
    """Returns the object in a body. An empty body means one without keys. Raises `BodyError`."""
    if not data:
        return Entries()
    try:
        text = data.decode("utf-8")
    except UnicodeDecodeError as error:
        raise BodyError(BodyErrorKind.NOT_UTF8, f"no UTF-8 at byte {error.start}") from None
    _check_limits(data, depth, values)
    tree = _scan(text)
    if not isinstance(tree, Entries):
        raise BodyError(BodyErrorKind.NOT_AN_OBJECT, "the body has to be an object")
    return tree


def has_lone_surrogate(text: str) -> bool:
    """Returns `True` if a text has half of a surrogate pair, so it is not Unicode."""
    return not text.isascii() and _SURROGATE.search(text) is not None


def write_text(text: str) -> str:
    """Returns a text in quotes."""
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
    """Returns JSON text as bytes. A kept half of a surrogate pair is escaped again."""
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
    """A JSON value. It keeps repeated keys and the spelling of numbers, but not spaces and needless escapes."""

    __slots__ = ("_tree",)

    def __init__(self, text: str = "null") -> None:
        """Creates the value from a JSON text. Raises `BodyError` for invalid text."""
        self._tree: Tree = parse_text(text)

    @classmethod
    def of(cls, value: Plain) -> Json:
        """Creates a value from Python values: `Json.of({"x": [1, None]})`. NaN and infinities raise `ValueError`."""
        try:
            return cls(json.dumps(value, allow_nan=False, ensure_ascii=False, separators=(",", ":")))
        except RecursionError:
            raise BodyError(BodyErrorKind.TOO_DEEP, f"nested deeper than {DEFAULT_DEPTH} levels") from None

    @classmethod
    def of_tree(cls, tree: Tree) -> Json:
        """Creates a value from a tree."""
        made = cls.__new__(cls)
        made._tree = tree
        return made

    @property
    def tree(self) -> Tree:
        """The tree."""
        return self._tree

    @property
    def text(self) -> str:
        """The compact text."""
        out: list[str] = []
        write_tree(self._tree, out)
        return "".join(out)

    @property
    def value(self) -> Plain:
        """The value as `json.loads` returns it: for a repeated key, the last value."""
        return _plain(self._tree)

    def __eq__(self, other: object) -> bool:
        """Returns `True` if both have the same text."""
        return isinstance(other, Json) and self.text == other.text

    def __hash__(self) -> int:
        """Returns the hash of its text."""
        return hash(self.text)

    def __repr__(self) -> str:
        """Shows the expression that creates it."""
        return f"Json({quoted(self.text)!r})"


class Extra:
    """The unknown keys of an object, sent again in their order. `Json` describes the kept form of their values."""

    __slots__ = ("_entries",)

    def __init__(self, values: Mapping[str, Plain | Json] | None = None) -> None:
        """Creates an empty set of keys, or one from a mapping: `Extra({"note": "…"})`."""
        self._entries = Entries()
        for key, value in (values or {}).items():
            self[key] = value

    @classmethod
    def of_entries(cls, entries: Entries) -> Extra:
        """Creates it from entries already read."""
        made = cls.__new__(cls)
        made._entries = entries
        return made

    @property
    def entries(self) -> Entries:
        """All keys and values as read."""
        return self._entries

    def __getitem__(self, key: str) -> Plain:
        """Returns the last value of a key."""
        for name, tree in reversed(self._entries):
            if name == key:
                return _plain(tree)
        raise KeyError(key)

    def get(self, key: str, default: Plain = None) -> Plain:
        """Returns the last value of a key, or the default."""
        try:
            return self[key]
        except KeyError:
            return default

    def json(self, key: str) -> Json | None:
        """Returns the last value of a key, with its repeated keys and the spelling of its numbers."""
        found = [tree for name, tree in self._entries if name == key]
        return Json.of_tree(found[-1]) if found else None

    def __setitem__(self, key: str, value: Plain | Json) -> None:
        """Sets the value of a key."""
        tree = value.tree if isinstance(value, Json) else Json.of(value).tree
        self._entries = Entries([entry for entry in self._entries if entry[0] != key])
        self._entries.append((key, tree))

    def __contains__(self, key: object) -> bool:
        """Returns `True` if this key has a value."""
        return any(name == key for name, _ in self._entries)

    def __iter__(self) -> Iterator[str]:
        """Yields the keys in their order; a repeated key is yielded again."""
        return (name for name, _ in self._entries)

    def __len__(self) -> int:
        """Returns the number of keys."""
        return len(self._entries)

    def __bool__(self) -> bool:
        """Returns `True` if there are any keys."""
        return bool(self._entries)

    def __eq__(self, other: object) -> bool:
        """Returns `True` if the other has the same keys and values in the same order."""
        if not isinstance(other, Extra):
            return False
        ours: list[str] = []
        theirs: list[str] = []
        write_tree(self._entries, ours)
        write_tree(other.entries, theirs)
        return ours == theirs

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        """Shows the expression that creates it."""
        return f"Extra({quoted(repr({key: _plain(value) for key, value in self._entries}))})" if self else "Extra()"
