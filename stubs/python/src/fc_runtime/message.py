"""Messages: plain dataclasses with annotations for reading and writing each field.

A field is named once: its annotation has its type and its `Key`. `fc_runtime.codec` derives the reader, the writer,
constraints and unknown keys from that.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Final, Generic, TypeAlias, TypeVar

from .constraints import Constraints
from .document import Extra

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from .codec import Codec

W = TypeVar("W", int, str, covariant=True)
E = TypeVar("E", bound=Enum)
M = TypeVar("M", bound="Message")


@dataclass(frozen=True, slots=True)
class Scalar:
    """A type of numbers in an annotation."""

    name: str
    """Its name in the spec."""
    low: int = 0
    """Least value of an integer."""
    high: int = 0
    """Greatest value of an integer."""


def _signed(bits: int) -> Scalar:
    return Scalar(f"i{bits}", -(1 << (bits - 1)), (1 << (bits - 1)) - 1)


def _unsigned(bits: int) -> Scalar:
    return Scalar(f"u{bits}", 0, (1 << bits) - 1)


I8: TypeAlias = Annotated[int, _signed(8)]
"""A signed integer of 8 bits."""
I16: TypeAlias = Annotated[int, _signed(16)]
"""A signed integer of 16 bits."""
I32: TypeAlias = Annotated[int, _signed(32)]
"""A signed integer of 32 bits."""
I64: TypeAlias = Annotated[int, _signed(64)]
"""A signed integer of 64 bits."""
U8: TypeAlias = Annotated[int, _unsigned(8)]
"""An unsigned integer of 8 bits."""
U16: TypeAlias = Annotated[int, _unsigned(16)]
"""An unsigned integer of 16 bits."""
U32: TypeAlias = Annotated[int, _unsigned(32)]
"""An unsigned integer of 32 bits."""
U64: TypeAlias = Annotated[int, _unsigned(64)]
"""An unsigned integer of 64 bits."""
F32: TypeAlias = Annotated[float, Scalar("f32")]
"""A float of 32 bits."""
F64: TypeAlias = Annotated[float, Scalar("f64")]
"""A float of 64 bits."""
TimestampMs: TypeAlias = I64
"""Milliseconds since 1970-01-01T00:00:00Z."""
TimestampS: TypeAlias = I64
"""Seconds since 1970-01-01T00:00:00Z."""

SCALARS: Final[Mapping[str, Scalar]] = {
    scalar.name: scalar
    for scalar in [*map(_signed, (8, 16, 32, 64)), *map(_unsigned, (8, 16, 32, 64)), Scalar("f32"), Scalar("f64")]
}
"""All types of numbers, by their names in the spec."""


@dataclass(frozen=True, slots=True)
class Unknown(Generic[W]):
    """A value that an open enum does not declare: kept, and sent again unchanged."""

    value: W
    """The value as received."""

    @property
    def name(self) -> str | None:
        """`None`: the protocol has no name for it."""
        return None

    @property
    def is_final(self) -> bool:
        """`False`: it is not a known state."""
        return False

    @property
    def is_error(self) -> bool:
        """`False`: it is not a known state."""
        return False

    def normally_follows(self, previous: object) -> bool:
        """Returns `False`: it is not a known state."""
        return False

    def may_follow(self, previous: object) -> bool:
        """Returns `True`: it is not a known state."""
        return True


class Form(Enum):
    """Forms of a value in JSON."""

    PLAIN = "plain"
    """The form of its type."""
    STRING = "string"
    """A number or bool inside a JSON string."""
    NUMBER = "number"
    """A bool as 1 or 0."""


Condition: TypeAlias = "Mapping[str, Sequence[int | str | bool | Enum]]"
"""Values by the keys of neighbouring fields: each field must have one of its values."""


@dataclass(frozen=True, slots=True)
class Key(Constraints):
    """Key and form of a field, with its constraints."""

    name: str
    """Its wire key."""
    also: tuple[str, ...] = ()
    """Other keys under which it is accepted."""
    form: Form = Form.PLAIN
    """Form in JSON."""
    lenient_number: bool = False
    """A number is also accepted as a string, and in hex."""
    lenient_bool: bool = False
    """A bool is also accepted as 0 or 1 and as a string."""
    empty_is_absent: bool = False
    """An empty value counts as absent."""
    when: Condition | None = None
    """The field is present exactly when this condition holds."""
    unless: Condition | None = None
    """The field is present exactly when this condition does not hold."""


@dataclass(frozen=True, slots=True)
class Variants:
    """Marks a choice: the first form whose required keys are all present applies."""

    names: tuple[str, ...]
    """Names of the forms in the spec."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Process:
    """The spec's facts about the values of an enum as states."""

    normal: Mapping[Enum, Sequence[Enum]] | None = None
    """For each value, the values that normally follow; other changes may occur."""
    complete: Mapping[Enum, Sequence[Enum]] | None = None
    """For each value, all values that may follow."""
    final: Sequence[Enum] = ()
    """Final values."""
    error: Sequence[Enum] = ()
    """Values that mean a failure."""


class State(Enum):
    """An enum whose values are states of a process."""

    @classmethod
    def process(cls) -> Process:
        """Returns the description of the states in the spec."""
        return Process()

    @property
    def is_final(self) -> bool:
        """`True` if the spec marks this value as final."""
        return self in self.process().final

    @property
    def is_error(self) -> bool:
        """`True` if the spec marks this value as a failure."""
        return self in self.process().error

    def normally_follows(self, previous: State | Unknown[Any]) -> bool:
        """Returns `True` if this value follows `previous` in the normal order. Other changes may occur as well."""
        normal = self.process().normal or {}
        return isinstance(previous, State) and self in normal.get(previous, ())

    def may_follow(self, previous: State | Unknown[Any]) -> bool:
        """Returns `True` if the spec lists the change from `previous` to this value.

        Also `True` if the spec has no complete list, or if `previous` is unknown.
        """
        complete = self.process().complete
        if complete is None or isinstance(previous, Unknown):
            return True
        return self in complete.get(previous, ())


def is_in_order(state: State | Unknown[Any], previous: State | Unknown[Any]) -> bool:
    """Returns `True` if the spec allows a state after another. Without a rule, every state is allowed.

    The same state, a failure, and any state next to an unknown value are always allowed.
    """
    if state == previous or isinstance(state, Unknown) or isinstance(previous, Unknown) or state.is_error:
        return True
    process = state.process()
    if process.complete is not None:
        return state.may_follow(previous)
    if process.normal is None:
        return True
    said = bool(process.normal.get(previous)) or previous.is_final
    return not said or state.normally_follows(previous)


def wire_enum(scalar: str, *, is_open: bool = True) -> Callable[[type[E]], type[E]]:
    """Declares the type of an enum's values in JSON: `string`, or the name of an integer type."""

    def mark(cls: type[E]) -> type[E]:
        _WIRE_ENUMS[cls] = (SCALARS.get(scalar), is_open)
        return cls

    return mark


_WIRE_ENUMS: Final[dict[type[Enum], tuple[Scalar | None, bool]]] = {}


def wire_of(cls: type[Enum]) -> tuple[Scalar | None, bool]:
    """Returns the integer type of an enum's values, `None` for texts; and `True` if it is open."""
    return _WIRE_ENUMS[cls]


def _codec_of(cls: type[M]) -> Codec[M]:
    from .codec import codec_of  # noqa: PLC0415 - which is made of messages

    return codec_of(cls)


class Message:
    """An object of the protocol. Its subclasses are dataclasses with slots, and their last field is `extra`."""

    __slots__ = ()

    __example__: ClassVar[str] = "{}"

    extra: Extra
    """Keys that the spec does not declare, kept and sent again."""

    @classmethod
    def example(cls: type[M]) -> M:
        """Returns the example of the spec."""
        return _codec_of(cls).read_text(cls.__example__)

    @classmethod
    def from_json(cls: type[M], text: str | bytes) -> M:
        """Reads the JSON text of such an object. Raises `BodyError`."""
        return _codec_of(cls).read_text(text)

    def to_json(self) -> str:
        """Returns its compact JSON text. Raises `BodyError` if a constraint does not hold."""
        return _codec_of(type(self)).write_text(self)

    def validate(self) -> None:
        """Raises `BodyError` if a value has the wrong type or breaks a constraint."""
        _codec_of(type(self)).write_text(self)

    def checked(self: M) -> M:
        """Returns the message if each field with a condition is present exactly where that holds.

        Messages that are sent or received are not checked, nor are the messages inside this one. Raises
        `ConditionError`.
        """
        _codec_of(type(self)).check_conditions(self)
        return self
