"""What can be wrong with a frame and with a body.

The names are those of `conformance/errors.json`, the same in every language.
"""

from __future__ import annotations

from enum import Enum
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from .frame import FrameId

# Longest quotation in a detail: what is quoted comes from the peer, and goes back to it.
_LONGEST_QUOTATION: Final = 200


class BodyErrorKind(str, Enum):
    """What is wrong with a body."""

    NOT_UTF8 = "not_utf8"
    """The bytes are not UTF-8."""
    BAD_JSON = "bad_json"
    """The text is not JSON (RFC 8259)."""
    NOT_AN_OBJECT = "not_an_object"
    """The body is JSON, but not an object."""
    WRONG_TYPE = "wrong_type"
    """A value of another kind than the field's."""
    MISSING_FIELD = "missing_field"
    """A required key is missing."""
    DUPLICATE_KEY = "duplicate_key"
    """A known key that comes twice in its object."""
    LONE_SURROGATE = "lone_surrogate"
    """Half of a surrogate pair that stands alone in a text or key that is read."""
    OUT_OF_RANGE = "out_of_range"
    """A number outside its range, or a value of an enum that its field does not take."""
    BAD_LENGTH = "bad_length"
    """A text, list or run of bytes of a length outside its constraint."""
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
    """A body that could not be read, or that breaks its constraints."""

    def __init__(self, kind: BodyErrorKind, detail: str) -> None:
        """Says what was found and what is wanted; the path grows on the way out."""
        super().__init__(detail)
        self.kind: Final = kind
        """What is wrong."""
        self.detail: Final = detail
        """What was found, and what is wanted."""
        self.path = ""
        """The wire keys down to the place, such as `data.stations[3].x`; empty for the body as a whole."""

    @property
    def name(self) -> str:
        """The kind's name, the same in every language."""
        return self.kind.value

    def inside(self, key: str | int) -> BodyError:
        """The same error, one key or one item further out."""
        here = f"[{key}]" if isinstance(key, int) else key
        separator = "" if not self.path or self.path.startswith("[") else "."
        self.path = here + separator + self.path
        return self

    def __str__(self) -> str:
        """The path, the name and the detail."""
        place = f"`{self.path}`: " if self.path else ""
        return f"{place}{self.name}: {self.detail}"


def quoted(text: str) -> str:
    """The beginning of a text that may be long."""
    return text if len(text) <= _LONGEST_QUOTATION else text[:_LONGEST_QUOTATION] + "…"


class FrameErrorKind(str, Enum):
    """What is wrong with a frame."""

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
    """A frame that cannot be read or written."""

    def __init__(self, kind: FrameErrorKind, detail: str, frame: FrameId | None = None) -> None:
        """Says what was found and what is wanted."""
        super().__init__(f"{kind.value}: {detail}")
        self.kind: Final = kind
        """What is wrong."""
        self.detail: Final = detail
        """What was found, and what is wanted."""
        self.frame: Final = frame
        """Which frame it is, if its length can be trusted: the next one then begins behind it."""

    @property
    def name(self) -> str:
        """The kind's name, the same in every language."""
        return self.kind.value
