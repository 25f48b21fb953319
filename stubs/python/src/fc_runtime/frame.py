"""Frames: bytes to header and data, and back. The layout comes only from the protocol."""

from __future__ import annotations

import gzip
import hashlib
import zlib
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final, NamedTuple, cast

from .errors import FrameError, FrameErrorKind
from .layout import Digest, HeaderRole
from .protocol import INFLATE_FREE
from .settings import check_all, integer, wrong

if TYPE_CHECKING:
    from collections.abc import Mapping

    from .protocol import Limits, Protocol
    from .settings import Check

# A search for the next frame ends after this many times the longest frame.
_SEARCH: Final = 4


class FrameId(NamedTuple):
    """Identity of a frame."""

    response: bool
    """`True` for a response or an acknowledgement."""
    kind: int
    """Kind of the data."""
    code: int
    """Command code."""
    id: int
    """Message id."""

    def answer(self) -> FrameId:
        """Returns the id of the response to this frame."""
        return self._replace(response=True)


@dataclass(frozen=True, slots=True)
class Frame:
    """A received frame."""

    id: FrameId
    """Its identity."""
    header: tuple[Any, ...]
    """All fields of the header as received, in order."""
    data: bytes = field(repr=False)
    """The data, decompressed."""
    fingerprint: bytes
    """Distinguishes its data from that of other frames."""


@dataclass(frozen=True, slots=True)
class Gzip:
    """Settings for compressing sent data."""

    from_bytes: int = 1024
    """Least length of data to compress, in bytes."""
    level: int = 1
    """From 1, the fastest, to 9, the smallest."""

    def __post_init__(self) -> None:
        """Checks both. Raises `TypeError` and `ValueError`."""
        check_all(self, _GZIP)


_GZIP: Final[Mapping[str, Check]] = {"from_bytes": integer(0), "level": integer(1, 9)}


def digest(protocol: Protocol, data: bytes | memoryview) -> bytes:
    """Returns the digest of data in a header; empty if the header has none."""
    layout = protocol.layout
    if layout.digest is Digest.MD5:
        return hashlib.md5(data, usedforsecurity=False).digest()
    if layout.digest is Digest.CRC32:
        return zlib.crc32(data).to_bytes(layout.digest_size, "big")
    return b""


class Decoder:
    """Splits received bytes into frames. The order of its checks is part of the protocol."""

    def __init__(
        self, protocol: Protocol, limits: Limits | None = None, *, verify_digest: bool = True, resync: bool = False
    ) -> None:
        """Creates a decoder, by default with the limits of the protocol."""
        self._protocol: Final = protocol
        self._layout: Final = protocol.layout
        self._limits: Final = limits or protocol.defaults.limits
        self._verify: Final = verify_digest
        self._resync: Final = resync
        self._heads: Final = (protocol.request_head, protocol.response_head)
        self._held = bytearray()
        self._at = 0
        self._failed: FrameError | None = None
        self._searching = False
        self._tried = 0
        self.surplus = 0
        """Bytes of decompressed data beyond the compressed ones."""

    def push(self, data: bytes | bytearray | memoryview) -> None:
        """Appends received bytes."""
        if self._at:
            del self._held[: self._at]
            self._at = 0
        self._held += data

    @property
    def pending(self) -> int:
        """Number of received bytes not yet returned as frames."""
        return len(self._held) - self._at

    @property
    def header_length(self) -> int:
        """Length of a header, in bytes."""
        return self._layout.length

    @property
    def expected(self) -> int | None:
        """Length of the frame that has begun, from its header; `None` until that is known."""
        return self._total() if self.pending >= self._layout.total_end else None

    def _total(self) -> int:
        (total,) = self._layout.total.unpack_from(self._held, self._at + self._layout.total_at)
        return int(total)

    def next(self) -> Frame | None:
        """Returns the next whole frame; `None` if it has not arrived yet. Raises `FrameError`.

        An error with a `frame` concerns only that frame: the next call continues after it. Without one, every further
        call raises the error again.
        """
        while True:
            if self._failed is not None:
                raise self._failed
            try:
                total = self._locate()
            except FrameError as error:
                if not self._resync:
                    self._failed = error
                    raise
                self._search()
                continue
            if total is None:
                return None
            start, self._at = self._at, self._at + total
            try:
                frame = self._read(start, total)
            except FrameError as error:
                if not self._searching:
                    raise
                self._tried += total
                if self._tried > _SEARCH * self._limits.frame_bytes:
                    self._failed = FrameError(FrameErrorKind.BAD_HEAD, "no frame has been found", None)
                    raise self._failed from error
                self._at = start
                self._search()
                continue
            self._searching = False
            self._tried = 0
            return frame

    def finish(self) -> None:
        """Raises `FrameError` if the bytes end inside a frame."""
        if self._failed is not None:
            raise self._failed
        if self.pending and not self._searching:
            raise FrameError(FrameErrorKind.TRUNCATED, f"the bytes end after {self.pending} of a frame")

    def _locate(self) -> int | None:
        """Returns the length of the first frame, if all of it has arrived."""
        there = self.pending
        if there == 0:
            return None
        if not self._held.startswith(self._heads, self._at):
            opening = bytes(self._held[self._at : self._at + max(map(len, self._heads))])
            if not any(opening[: len(head)] == head[: len(opening)] for head in self._heads):
                raise FrameError(FrameErrorKind.BAD_HEAD, f"no frame begins with {opening.hex(' ')}")
        if there < self._layout.total_end:
            return None
        total = self._total()
        if total < self._layout.length:
            raise FrameError(FrameErrorKind.SHORT_FRAME, f"{total} bytes are less than the header")
        if total > self._limits.frame_bytes:
            raise FrameError(FrameErrorKind.FRAME_TOO_LONG, f"{total} bytes; at most {self._limits.frame_bytes}")
        return total if there >= total else None

    def _search(self) -> None:
        """Advances to the possible beginning of the next frame."""
        self._searching = True
        found = [self._held.find(head, self._at + 1) for head in self._heads]
        places = [place for place in found if place >= 0]
        # The last bytes may be the beginning of a head.
        end = len(self._held)
        tail = next(
            (place for place in range(max(self._at + 1, end - 8), end) if self._may_begin(place)),
            end,
        )
        self._at = min([*places, tail])

    def _may_begin(self, place: int) -> bool:
        rest = bytes(self._held[place:])
        return any(head.startswith(rest) for head in self._heads)

    def _read(self, start: int, total: int) -> Frame:
        layout, protocol = self._layout, self._protocol
        header = layout.struct.unpack_from(self._held, start)
        with memoryview(self._held) as held:
            data = bytes(held[start + layout.length : start + total])
        frame = FrameId(
            self._held.startswith(protocol.response_head, start),
            0 if layout.kind_at is None else header[layout.kind_at],
            0 if layout.code_at is None else header[layout.code_at],
            header[layout.id_index],
        )
        if frame.kind in protocol.reserved_kinds:
            raise FrameError(FrameErrorKind.RESERVED_KIND, f"kind {frame.kind}", frame)
        if frame.kind not in (protocol.command, protocol.report, protocol.stream):
            raise FrameError(FrameErrorKind.UNKNOWN_KIND, f"kind {frame.kind}", frame)
        encoding: int = protocol.plain if layout.encoding_at is None else header[layout.encoding_at]
        if encoding != protocol.plain and encoding != protocol.gzip:
            raise FrameError(FrameErrorKind.UNKNOWN_ENCODING, f"encoding {encoding}", frame)
        fingerprint = header[layout.digest_at] if layout.digest_at is not None else b""
        if self._verify and layout.digest_at is not None:
            expected = digest(protocol, data)
            sent = fingerprint if isinstance(fingerprint, bytes) else fingerprint.to_bytes(len(expected), "big")
            if sent != expected:
                raise FrameError(FrameErrorKind.BAD_DIGEST, f"{sent.hex()} is not {expected.hex()}", frame)
        plain_length: int = -1 if layout.plain_at is None else header[layout.plain_at]
        if encoding != protocol.plain:
            data = self._inflate(data, plain_length, frame)
        elif plain_length == 0 and layout.zero_when_plain:
            plain_length = len(data)
        if plain_length not in (-1, len(data)):
            detail = f"{plain_length} bytes are announced, and there are {len(data)}"
            raise FrameError(FrameErrorKind.PLAIN_LENGTH_MISMATCH, detail, frame)
        if layout.digest is not Digest.MD5:
            fingerprint = hashlib.blake2b(data, digest_size=16).digest()
        return Frame(frame, header, data, bytes(fingerprint))

    def _inflate(self, data: bytes, plain_length: int, frame: FrameId) -> bytes:
        """Returns the content of one gzip member, at most as long as announced and as the limits allow."""
        most = self._limits.inflated_bytes
        if plain_length > most:
            raise FrameError(FrameErrorKind.INFLATED_TOO_LONG, f"{plain_length} bytes; at most {most}", frame)
        allowed = most
        if frame.kind != self._protocol.stream:
            allowed = min(most, max(INFLATE_FREE, self._limits.inflate_ratio * len(data)))
        if plain_length > allowed:
            detail = f"{len(data)} bytes would become {plain_length}"
            raise FrameError(FrameErrorKind.INFLATES_TOO_MUCH, detail, frame)
        if plain_length >= 0:
            allowed = plain_length
        unpacker = zlib.decompressobj(wbits=31)
        try:
            plain = unpacker.decompress(data, allowed + 1)
        except zlib.error as error:
            raise FrameError(FrameErrorKind.BAD_GZIP, str(error), frame) from None
        self.surplus += max(0, len(plain) - len(data))
        if len(plain) > plain_length >= 0:
            # The rest is not read.
            detail = f"{plain_length} bytes are announced, and there are more"
            raise FrameError(FrameErrorKind.PLAIN_LENGTH_MISMATCH, detail, frame)
        if len(plain) > allowed:
            kind = FrameErrorKind.INFLATED_TOO_LONG if allowed == most else FrameErrorKind.INFLATES_TOO_MUCH
            raise FrameError(kind, f"more than {allowed} bytes", frame)
        if not unpacker.eof or unpacker.unused_data:
            raise FrameError(FrameErrorKind.BAD_GZIP, "not one complete member", frame)
        return plain


def stream_frame(protocol: Protocol, code: int, message_id: int) -> FrameId:
    """Returns the id of a frame of raw bytes. Raises `TypeError` and `ValueError` for values that do not fit the
    header.
    """
    protocol.layout.check_code("code", code)
    protocol.layout.check_id("message_id", message_id)
    return FrameId(False, protocol.stream, code, message_id)


def frame_bytes(data: bytes | bytearray | memoryview) -> bytes:
    """Returns the data of a frame of raw bytes. Raises `TypeError` for any other value."""
    given = cast("object", data)
    if not isinstance(given, (bytes, bytearray, memoryview)):
        raise TypeError(wrong("data", given, "bytes"))
    return bytes(data)


class Encoder:
    """Encodes frames."""

    def __init__(self, protocol: Protocol, limits: Limits | None = None, *, compress: Gzip | None = None) -> None:
        """Creates an encoder, by default with the limits of the protocol."""
        self._protocol: Final = protocol
        self._layout: Final = protocol.layout
        self._most: Final = (limits or protocol.defaults.limits).frame_bytes
        self._gzip: Final = compress if protocol.gzip is not None else None
        layout = self._layout
        self._fixed: Final = [
            b"" if one.role is HeaderRole.HEAD else one.value.to_bytes(one.size, "big") if one.is_bytes else one.value
            for one in layout.fields
        ]

    def prepare(self, data: bytes) -> Prepared:
        """Compresses and digests data, for one or more frames. Raises `FrameError`."""
        packed, is_packed = data, False
        if self._gzip is not None and len(data) >= self._gzip.from_bytes:
            member = gzip.compress(data, self._gzip.level, mtime=0)
            if len(member) < len(data):
                packed, is_packed = member, True
        total = self._layout.length + len(packed)
        if total > self._most:
            raise FrameError(FrameErrorKind.FRAME_TOO_LONG, f"{total} bytes; at most {self._most}")
        return Prepared(packed, is_packed, len(data), digest(self._protocol, packed))

    def frame(self, frame: FrameId, prepared: Prepared) -> bytes:
        """Returns the frame with this id and the prepared data."""
        layout, protocol = self._layout, self._protocol
        values: list[Any] = self._fixed.copy()
        values[layout.head_index] = protocol.response_head if frame.response else protocol.request_head
        values[layout.total_index] = layout.length + len(prepared.data)
        values[layout.id_index] = frame.id & layout.id_max
        if layout.kind_at is not None:
            values[layout.kind_at] = frame.kind
        if layout.code_at is not None:
            values[layout.code_at] = frame.code
        if layout.encoding_at is not None:
            values[layout.encoding_at] = protocol.gzip if prepared.is_packed else protocol.plain
        if layout.plain_at is not None:
            values[layout.plain_at] = prepared.plain_length
        if layout.digest_at is not None:
            made = prepared.digest
            values[layout.digest_at] = made if layout.is_digest_bytes else int.from_bytes(made, "big")
        return layout.struct.pack(*values) + prepared.data

    def encode(self, frame: FrameId, data: bytes) -> bytes:
        """Returns the frame with this data. Raises `FrameError`."""
        return self.frame(frame, self.prepare(data))


class Prepared(NamedTuple):
    """Data prepared for sending."""

    data: bytes
    """The data, compressed if that is shorter."""
    is_packed: bool
    """`True` if it is compressed."""
    plain_length: int
    """Length before compression."""
    digest: bytes
    """Its digest in the header."""
