"""Errors of frames and bodies.

The names are those of `conformance/errors.json`, the same in every language.
"""

from __future__ import annotations

from enum import Enum
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from .frame import FrameId

# Longest quotation in a detail. The quoted text comes from the peer, and goes back to it.
_LONGEST_QUOTATION: Final = 200


class BodyErrorKind(str, Enum):
    """Errors of a body."""

    NOT_UTF8 = "not_utf8"
    """The bytes are not UTF-8."""
    BAD_JSON = "bad_json"
    """The text is not JSON (RFC 8259)."""
    NOT_AN_OBJECT = "not_an_object"
    """The body is JSON, but not an object."""
    WRONG_TYPE = "wrong_type"
    """A value of another type than the field's."""
    MISSING_FIELD = "missing_field"
    """A required key is missing."""
    DUPLICATE_KEY = "duplicate_key"
    """A known key is repeated in its object."""
    LONE_SURROGATE = "lone_surrogate"
    """Half of a surrogate pair without the other half, in a text or key."""
    OUT_OF_RANGE = "out_of_range"
    """A number outside its range, or a value of an enum that its field does not take."""
    BAD_LENGTH = "bad_length"
    """A text, list or byte string with a length outside its constraint."""
    BAD_PATTERN = "bad_pattern"
    """A text that does not match its pattern."""
    UNKNOWN_VALUE = "unknown_value"
    """A value that a closed enum does not have."""
    NO_VARIANT = "no_variant"
    """An object that has the required keys of no form of a choice."""
    TOO_DEEP = "too_deep"
    """Nested deeper than the limit."""
    TOO_MANY_VALUES = "too_many_values"
    """More keys and items than the limit."""
    BAD_BASE64 = "bad_base64"
    """A text that is not base64 (RFC 4648, standard alphabet)."""


class BodyError(ValueError):
    """The error of a body that cannot be read, or that breaks a constraint."""

    def __init__(self, kind: BodyErrorKind, detail: str) -> None:
        """Creates the error. `detail` has the value found and the one expected. The path grows on the way out."""
        super().__init__(detail)
        self.kind: Final = kind
        """The kind of error."""
        self.detail: Final = detail
        """The value found and the one expected."""
        self.path = ""
        """The keys down to the place, such as `data.stations[3].x`; empty for the body itself."""

    @property
    def name(self) -> str:
        """Name of the kind, the same in every language."""
        return self.kind.value

    def inside(self, key: str | int) -> BodyError:
        """Returns the same error, with its path prefixed by one key or index."""
        here = f"[{key}]" if isinstance(key, int) else key
        separator = "" if not self.path or self.path.startswith("[") else "."
        self.path = here + separator + self.path
        return self

    def __str__(self) -> str:
        """Returns the path, the name and the detail."""
        place = f"`{self.path}`: " if self.path else ""
        return f"{place}{self.name}: {self.detail}"


def quoted(text: str) -> str:
    """Returns the beginning of a text that may be long."""
    return text if len(text) <= _LONGEST_QUOTATION else text[:_LONGEST_QUOTATION] + "…"


class FrameErrorKind(str, Enum):
    """Errors of a frame."""

    BAD_HEAD = "bad_head"
    """No frame starts here."""
    SHORT_FRAME = "short_frame"
    """The total length is shorter than the header."""
    FRAME_TOO_LONG = "frame_too_long"
    """The total length exceeds the limit."""
    TRUNCATED = "truncated"
    """The bytes end inside a frame."""
    UNKNOWN_KIND = "unknown_kind"
    """Unknown kind."""
    RESERVED_KIND = "reserved_kind"
    """Reserved kind, always refused."""
    UNKNOWN_ENCODING = "unknown_encoding"
    """Unknown encoding."""
    BAD_DIGEST = "bad_digest"
    """The digest does not match the data."""
    BAD_GZIP = "bad_gzip"
    """The data is not one complete gzip member."""
    PLAIN_LENGTH_MISMATCH = "plain_length_mismatch"
    """The length before compression does not match the data."""
    INFLATED_TOO_LONG = "inflated_too_long"
    """Exceeds the limit after decompression."""
    INFLATES_TOO_MUCH = "inflates_too_much"
    """Grows by more than the limit allows when decompressed."""


class FrameError(ValueError):
    """The error of a frame that cannot be read or written."""

    def __init__(self, kind: FrameErrorKind, detail: str, frame: FrameId | None = None) -> None:
        """Creates the error. `detail` has the value found and the one expected."""
        super().__init__(f"{kind.value}: {detail}")
        self.kind: Final = kind
        """The kind of error."""
        self.detail: Final = detail
        """The value found and the one expected."""
        self.frame: Final = frame
        """The frame, if its length is reliable: then the next one begins after it. Otherwise `None`."""

    @property
    def name(self) -> str:
        """Name of the kind, the same in every language."""
        return self.kind.value
