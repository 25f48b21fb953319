"""Reads and writes messages, from the annotations of their fields."""

from __future__ import annotations

import sys
import types
from dataclasses import fields, replace
from enum import Enum
from operator import itemgetter
from typing import TYPE_CHECKING, Annotated, Any, Final, Generic, TypeVar, Union, cast, get_args, get_origin

from .conditions import ConditionError, ConditionErrorKind
from .constraints import constraint, length_check, without_constraints
from .document import Entries, Extra, Json, has_lone_surrogate, parse_body, to_bytes, write_text, write_tree
from .errors import BodyError, BodyErrorKind, quoted
from .message import Key, Message, Scalar, Unknown, Variants, wire_of
from .values import (
    Read,
    Write,
    base64_codec,
    bool_codec,
    float_codec,
    integer_codec,
    text_codec,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from .document import Tree

M = TypeVar("M", bound=Message)


class Slot:
    """A field of a message, prepared for reading and writing."""

    __slots__ = ("_empty_is_absent", "attribute", "check", "key", "opening", "optional", "read", "write")

    def __init__(self, attribute: str, key: Key, read: Read, write: Write, *, optional: bool) -> None:
        """Creates the field."""
        self.attribute: Final = attribute
        self.key: Final = key
        self.read: Final = read
        self.write: Final = write
        self.optional: Final = optional
        self.check: Final = constraint(key)
        self.opening: Final = write_text(key.name) + ":"
        self._empty_is_absent: Final = key.empty_is_absent

    def take(self, key: str, tree: Tree, values: dict[str, Any]) -> None:
        """Reads the value of the field that came under this key."""
        attribute = self.attribute
        if attribute in values:
            raise BodyError(BodyErrorKind.DUPLICATE_KEY, "the key comes twice").inside(key)
        if self.optional and (tree is None or (self._empty_is_absent and tree in ("", []))):
            values[attribute] = None
            return
        try:
            values[attribute] = self.read(tree)
        except BodyError as error:
            raise error.inside(key) from None


class Codec(Generic[M]):
    """Reader and writer of a type of messages."""

    def __init__(self, cls: type[M]) -> None:
        """Reads the annotations of the type, once."""
        self.cls: Final = cls
        self.slots: Final = [_slot(cls, field.name) for field in fields(cls) if field.name != "extra"]  # type: ignore[arg-type]
        self.by_key: Final = {name: slot for slot in self.slots for name in (slot.key.name, *slot.key.also)}
        self.required: Final = [slot for slot in self.slots if not slot.optional]
        # Raises `KeyError` for the first missing field, in one step.
        self._demand: Final = itemgetter(*[slot.attribute for slot in self.required]) if self.required else None
        self.constrained: Final = [(slot, slot.check) for slot in self.slots if slot.check is not None]

    def has_required(self, entries: Entries) -> bool:
        """Returns `True` if an object has the keys that such a message needs."""
        there = {key for key, _ in entries}
        return all(slot.key.name in there or not there.isdisjoint(slot.key.also) for slot in self.required)

    def read(self, tree: Tree) -> M:
        """Returns the message in an object."""
        if not isinstance(tree, Entries):
            raise BodyError(BodyErrorKind.WRONG_TYPE, "an object is wanted")
        values: dict[str, Any] = {}
        extra = Entries()
        by_key = self.by_key
        for key, value in tree:
            slot = by_key.get(key)
            if slot is None:
                check_key(key)
                extra.append((key, value))
            elif value and slot.attribute not in values:
                # The usual case, with one function call less.
                try:
                    values[slot.attribute] = slot.read(value)
                except BodyError as error:
                    raise error.inside(key) from None
            else:
                slot.take(key, value, values)
        return self.finish(values, extra)

    def finish(self, values: dict[str, Any], extra: Entries) -> M:
        """Returns the message with these field values and these unknown keys."""
        if self._demand is not None:
            try:
                self._demand(values)
            except KeyError:
                raise _missing(next(slot for slot in self.required if slot.attribute not in values)) from None
        for slot, check in self.constrained:
            value = values.get(slot.attribute)
            if value is not None:
                try:
                    check(value)
                except BodyError as error:
                    raise error.inside(slot.key.name) from None
        values["extra"] = Extra.of_entries(extra)
        return self.cls(**values)

    def empty(self) -> M:
        """Returns a message without keys. Raises `BodyError` for the first required key."""
        return self.finish({}, Entries())

    def read_text(self, text: str | bytes) -> M:
        """Returns the message in a JSON text."""
        return self.read(parse_body(text.encode("utf-8", "surrogatepass") if isinstance(text, str) else text))

    def write(self, message: M, out: list[str], separator: str = "{") -> str:
        """Appends the keys of a message, each after a separator. Returns the separator of the next key."""
        if not isinstance(message, self.cls):
            raise _not_a(self.cls.__name__, message)
        for slot in self.slots:
            value = getattr(message, slot.attribute)
            if value is None:
                if slot.optional:
                    continue
                raise _missing(slot)
            out.append(separator + slot.opening)
            separator = ","
            try:
                slot.write(value, out)
            except BodyError as error:
                raise error.inside(slot.key.name) from None
        extra = cast("object", message.extra)
        if not isinstance(extra, Extra):
            raise _not_a("`extra` of type Extra", extra)
        for key, tree in extra.entries:
            if key in self.by_key:
                raise BodyError(BodyErrorKind.DUPLICATE_KEY, "the type has a field for this key").inside(key)
            out.append(separator + write_text(key) + ":")
            separator = ","
            write_tree(tree, out)
        return separator

    def write_object(self, message: M, out: list[str]) -> None:
        """Appends a message as an object."""
        out.append("}" if self.write(message, out) == "," else "{}")

    def write_text(self, message: M) -> str:
        """Returns the compact JSON text of a message."""
        out: list[str] = []
        self.write_object(message, out)
        return to_bytes(out).decode("utf-8")

    def check_conditions(self, message: M) -> None:
        """Raises `ConditionError` if a field contradicts its condition."""
        for slot in self.slots:
            key = slot.key
            condition = key.when if key.when is not None else key.unless
            if condition is None or not slot.optional:
                continue
            is_when = key.when is not None
            asked = all(
                getattr(message, self.by_key[name].attribute) in _plain_values(values)
                for name, values in condition.items()
            )
            is_there = getattr(message, slot.attribute) is not None
            if is_there != (asked == is_when):
                kind = ConditionErrorKind.UNASKED if is_there else ConditionErrorKind.MISSING
                raise ConditionError(key.name, kind, condition, is_when=is_when)


def _plain_values(values: Sequence[object]) -> list[object]:
    return [*values]


def check_key(key: str) -> None:
    """Raises `BodyError` for a key with half of a surrogate pair, which no declared key has."""
    if has_lone_surrogate(key):
        raise BodyError(BodyErrorKind.LONE_SURROGATE, "half a surrogate pair is no text")


def _not_a(wanted: str, found: object) -> BodyError:
    """Returns the error of an object with the wrong type."""
    name = found.__name__ if isinstance(found, type) else type(found).__name__
    return BodyError(BodyErrorKind.WRONG_TYPE, f"{wanted} is wanted, not {name}")


def _missing(slot: Slot) -> BodyError:
    return BodyError(BodyErrorKind.MISSING_FIELD, "the key is required; send it").inside(slot.key.name)


_CODECS: Final[dict[type[Message], Codec[Any]]] = {}


def codec_of(cls: type[M]) -> Codec[M]:
    """Returns the reader and writer of a type of messages, created on first use."""
    codec = _CODECS.get(cls)
    if codec is None:
        codec = _CODECS[cls] = Codec(cls)
    return codec


def write_content(body: type[Any], content: object) -> bytes:
    """Returns the bytes of a stream's frame with this content. Raises `BodyError`."""
    if body is not bytes:
        return codec_of(body).write_text(cast("Message", content)).encode()
    if not isinstance(content, (bytes, bytearray, memoryview)):
        raise _not_a("bytes", content)
    return bytes(cast("bytes", content))


def _slot(cls: type[Message], attribute: str) -> Slot:
    """Prepares a field. Evaluates its annotation, a text, in the module of its class."""
    annotation = cls.__annotations__[attribute]
    ty = eval(annotation, vars(sys.modules[cls.__module__])) if isinstance(annotation, str) else annotation  # noqa: S307
    inner, *marks = get_args(ty) if get_origin(ty) is Annotated else (ty,)
    keys = [mark for mark in marks if isinstance(mark, Key)]
    if len(keys) != 1:
        raise TypeError(f"{cls.__name__}.{attribute} has no key")
    # `Annotated` joins its marks with those of the type inside it.
    others = tuple(mark for mark in marks if not isinstance(mark, Key))
    inner, optional = _without_none(inner)
    # The constraints of the key are checked once all keys have been read.
    read, _ = _codec(inner, replace(keys[0], **without_constraints()), others)
    _, write = _codec(inner, keys[0], others)
    return Slot(attribute, keys[0], read, write, optional=optional)


def _is_union(ty: Any) -> bool:
    return get_origin(ty) in (Union, types.UnionType)


def _without_none(ty: Any) -> tuple[Any, bool]:
    if not _is_union(ty):
        return ty, False
    members = [member for member in get_args(ty) if member is not type(None)]
    optional = len(members) < len(get_args(ty))
    return (members[0] if len(members) == 1 else Union[tuple(members)]), optional


def _codec(ty: Any, key: Key, marks: tuple[Any, ...] = ()) -> tuple[Read, Write]:
    """Returns the reader and writer of a type, with the constraints of a key."""
    if get_origin(ty) is Annotated:
        ty, *rest = get_args(ty)
        marks = tuple(rest)
    if hasattr(ty, "__supertype__"):
        # A `NewType` of an id is read and written as its base type.
        return _codec(ty.__supertype__, key, marks)
    for mark in marks:
        if isinstance(mark, Variants):
            return _choice(ty)
        if isinstance(mark, Scalar):
            return (float_codec if ty is float else integer_codec)(mark, key)
    if _is_union(ty):
        (enum,) = [member for member in get_args(ty) if isinstance(member, type) and issubclass(member, Enum)]
        return _enum(enum, key)
    if get_origin(ty) is list:
        return _list(get_args(ty)[0], key)
    if isinstance(ty, type) and issubclass(ty, Enum):
        return _enum(ty, key)
    if isinstance(ty, type) and issubclass(ty, Message):
        codec = codec_of(ty)
        return codec.read, codec.write_object
    simple: dict[Any, Callable[[Key], tuple[Read, Write]]] = {
        str: text_codec,
        bool: bool_codec,
        bytes: base64_codec,
        Json: lambda _: (Json.of_tree, _write_json),
    }
    return simple[ty](key)


def _write_json(value: Any, out: list[str]) -> None:
    if not isinstance(value, Json):
        raise BodyError(BodyErrorKind.WRONG_TYPE, f"`Json` is wanted, not {type(value).__name__}")
    write_tree(value.tree, out)


def _list(item: Any, key: Key) -> tuple[Read, Write]:
    # The length applies to the outermost list, all other constraints to its items.
    check = length_check(key, "items")
    read_item, write_item = _codec(item, replace(key, length=None))

    def read(tree: Tree) -> list[Any]:
        if not isinstance(tree, list) or isinstance(tree, Entries):
            raise BodyError(BodyErrorKind.WRONG_TYPE, "a list is wanted")
        check(len(tree))
        items: list[Any] = []
        try:
            for one in tree:
                items.append(read_item(one))  # noqa: PERF401
        except BodyError as error:
            raise error.inside(len(items)) from None
        return items

    def write(value: Any, out: list[str]) -> None:
        if not isinstance(value, (list, tuple)):
            raise BodyError(BodyErrorKind.WRONG_TYPE, f"a list is wanted, not {type(value).__name__}")
        items = cast("Sequence[Any]", value)
        check(len(items))
        for index, one in enumerate(items):
            out.append("," if index else "[")
            try:
                write_item(one, out)
            except BodyError as error:
                raise error.inside(index) from None
        out.append("]" if items else "[]")

    return read, write


def _enum(cls: type[Enum], key: Key) -> tuple[Read, Write]:
    scalar, is_open = wire_of(cls)
    only = frozenset(member.value for member in key.only)
    plain = replace(key, pattern=None, length=None)
    read_value, write_value = text_codec(plain) if scalar is None else integer_codec(scalar, plain)
    known = {member.value: member for member in cls}

    def check(value: Any) -> None:
        if value not in known and not is_open:
            raise BodyError(BodyErrorKind.UNKNOWN_VALUE, f"`{quoted(str(value))}` is none of the values of this field")
        if only and value not in only:
            taken = ", ".join(str(one) for one in sorted(only, key=str))
            raise BodyError(BodyErrorKind.OUT_OF_RANGE, f"the value must be one of: {taken}")

    def read(tree: Tree) -> Any:
        value = read_value(tree)
        member = known.get(value)
        if member is None or only:
            check(value)
        return Unknown(value) if member is None else member

    def write(value: Any, out: list[str]) -> None:
        if not isinstance(value, cls) and not (is_open and isinstance(value, Unknown)):
            raise BodyError(BodyErrorKind.WRONG_TYPE, f"`{cls.__name__}` is wanted, not {type(value).__name__}")
        sent: Any = cast("Any", value).value
        if only:
            check(sent)
        write_value(sent, out)

    return read, write


def _choice(ty: Any) -> tuple[Read, Write]:
    variants: list[type[Message]] = list(get_args(ty)) if _is_union(ty) else [ty]
    codecs = [codec_of(variant) for variant in variants]
    by_type: dict[type, Codec[Any]] = {codec.cls: codec for codec in codecs}

    def read(tree: Tree) -> Any:
        if not isinstance(tree, Entries):
            raise BodyError(BodyErrorKind.WRONG_TYPE, "an object is wanted")
        for key, _ in tree:
            check_key(key)
        for codec in codecs:
            if codec.has_required(tree):
                return codec.read(tree)
        wanted = ", or ".join(" and ".join(f"`{slot.key.name}`" for slot in codec.required) for codec in codecs)
        raise BodyError(BodyErrorKind.NO_VARIANT, f"send an object with the keys {wanted}")

    def write(value: object, out: list[str]) -> None:
        given = type(value)
        codec = by_type.get(given)
        if codec is None:
            names = ", ".join(variant.__name__ for variant in variants)
            raise BodyError(BodyErrorKind.WRONG_TYPE, f"one of {names} is wanted, not {given.__name__}")
        codec.write_object(value, out)

    return read, write
