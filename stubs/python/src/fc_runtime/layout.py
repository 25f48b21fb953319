"""The layout of a frame's header: field names and bytes, from the protocol."""

from __future__ import annotations

import struct
from dataclasses import dataclass
from enum import Enum
from typing import Final

from .settings import integer


class HeaderRole(str, Enum):
    """Role of a header field."""

    HEAD = "head"
    """The bytes that open the frame."""
    KIND = "kind"
    """Kind of the data."""
    CODE = "code"
    """Command code."""
    ID = "id"
    """Message id."""
    ENCODING = "encoding"
    """Encoding of the data."""
    STATUS = "status"
    """Sent with a fixed value, kept as received."""
    TOTAL_LENGTH = "total_length"
    """Length of the whole frame, header included."""
    PLAIN_LENGTH = "plain_length"
    """Length of the data before compression."""
    DIGEST = "digest"
    """Digest of the data as sent."""


class Digest(str, Enum):
    """Digest algorithm of a frame's data."""

    MD5 = "md5"
    """MD5 (RFC 1321)."""
    CRC32 = "crc32"
    """CRC-32 as in gzip, zlib and Ethernet."""


@dataclass(frozen=True, slots=True)
class HeaderField:
    """A field of the frame's header."""

    name: str
    """Its name in code."""
    size: int
    """Its number of bytes."""
    role: HeaderRole | None = None
    """Role of the field; `None` if it has a fixed value."""
    is_bytes: bool = False
    """`True` for raw bytes, `False` for an unsigned integer."""
    value: int = 0
    """Value sent for a field without a role."""
    digest: Digest | None = None
    """Digest algorithm."""
    zero_when_plain: bool = False
    """A received 0 on an uncompressed frame is accepted."""


_INTEGERS: Final = {1: "B", 2: "H", 4: "I", 8: "Q"}


class Layout:
    """Places of the header's fields."""

    def __init__(self, header: tuple[HeaderField, ...], byte_order: str) -> None:
        """Computes places and formats."""
        order = ">" if byte_order == "big" else "<"
        formats = [f"{one.size}s" if one.is_bytes else _INTEGERS[one.size] for one in header]
        self.fields: Final = header
        self.struct: Final = struct.Struct(order + "".join(formats))
        self.length: Final = self.struct.size
        """Length of the header, in bytes."""
        self._index: Final = {one.role: index for index, one in enumerate(header) if one.role is not None}
        total = self.total_index = self._index[HeaderRole.TOTAL_LENGTH]
        self.head_index: Final = self._index[HeaderRole.HEAD]
        self.id_index: Final = self._index[HeaderRole.ID]
        self.total_at: Final = sum(one.size for one in header[:total])
        self.total: Final = struct.Struct(order + formats[total])
        self.total_end: Final = self.total_at + self.total.size
        self.kind_at: Final = self._index.get(HeaderRole.KIND)
        self.code_at: Final = self._index.get(HeaderRole.CODE)
        self.id_at: Final = self._index.get(HeaderRole.ID)
        self.encoding_at: Final = self._index.get(HeaderRole.ENCODING)
        self.plain_at: Final = self._index.get(HeaderRole.PLAIN_LENGTH)
        self.digest_at: Final = self._index.get(HeaderRole.DIGEST)
        self.digest: Final = None if self.digest_at is None else header[self.digest_at].digest
        self.is_digest_bytes: Final = self.digest_at is not None and header[self.digest_at].is_bytes
        self.digest_size: Final = 0 if self.digest_at is None else header[self.digest_at].size
        self.digest_order: Final = "big" if byte_order == "big" else "little"
        self.id_max: Final = (1 << (8 * header[self._index[HeaderRole.ID]].size)) - 1
        """Largest message id."""
        code_max = None if self.code_at is None else (1 << (8 * header[self.code_at].size)) - 1
        self.check_code: Final = integer(0, code_max)
        """Checks that a command code fits the header."""
        self.check_id: Final = integer(0, self.id_max)
        """Checks that a message id fits the header."""
        self.zero_when_plain: Final = any(one.zero_when_plain for one in header)
