"""A connection's bytes: frames out of what is received, and what is sent in one write."""

from __future__ import annotations

import asyncio
import socket
from typing import TYPE_CHECKING, Any, Final

from .errors import FrameError

if TYPE_CHECKING:
    from collections.abc import Callable

    from .frame import Decoder, Frame

# What a frame has to bring beside the stall timeout, in bytes per second: a wrong length swallows what follows.
_LEAST: Final = 16 * 1024


class Link(asyncio.Protocol):
    """Frames of one connection. Its owner is told of each, of each that is broken, and of the end."""

    def __init__(
        self,
        decoder: Decoder,
        stall_timeout: float,
        keepalive: float | None,
        on_frame: Callable[[Link, Frame], None],
        on_fault: Callable[[Link, FrameError], None],
        on_end: Callable[[Link, str, Exception | None], None],
    ) -> None:
        """With what its owner wants to be told."""
        self._decoder: Final = decoder
        self._stall: Final = stall_timeout
        self._keepalive: Final = keepalive
        self._on_frame: Final = on_frame
        self._on_fault: Final = on_fault
        self._on_end: Final = on_end
        self._loop: Final = asyncio.get_running_loop()
        self._transport: asyncio.Transport | None = None
        self._out: list[bytes] = []
        self._is_over = False
        self._watch: asyncio.TimerHandle | None = None
        self._begun = 0.0
        self._paused_since: asyncio.TimerHandle | None = None
        self.is_heard = False
        """Whether a frame has come."""
        self.is_read = True
        """Whether what comes is looked at."""

    @property
    def peer(self) -> str:
        """Address of the other side."""
        name: Any = None if self._transport is None else self._transport.get_extra_info("peername")
        return str(name[0]) if name else ""

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Take over a transport."""
        assert isinstance(transport, asyncio.Transport)
        self._transport = transport
        found = transport.get_extra_info("socket")
        if found is not None and self._keepalive is not None and found.family in (socket.AF_INET, socket.AF_INET6):
            found.setsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE, 1)
            for name, value in (("TCP_KEEPIDLE", int(self._keepalive)), ("TCP_KEEPINTVL", 10), ("TCP_KEEPCNT", 3)):
                if hasattr(socket, name):
                    found.setsockopt(socket.IPPROTO_TCP, getattr(socket, name), max(1, value))

    def data_received(self, data: bytes) -> None:
        """Take what has come."""
        if self._is_over:
            return
        if self._decoder.pending == 0:
            self._begun = self._loop.time()
        self._decoder.push(data)
        self.take()

    def take(self) -> None:
        """Give out whole frames, as long as they are looked at."""
        while self.is_read and not self._is_over:
            try:
                frame = self._decoder.next()
            except FrameError as error:
                self.is_heard = True
                if error.frame is None:
                    self.end("frame", error)
                    return
                self._begun = self._loop.time()
                self._on_fault(self, error)
                continue
            if frame is None:
                break
            self.is_heard = True
            self._begun = self._loop.time()
            self._on_frame(self, frame)
        self._watch_stall()

    def _watch_stall(self) -> None:
        if self._watch is not None:
            self._watch.cancel()
            self._watch = None
        pending = self._decoder.pending
        if pending and not self._is_over and self.is_read:
            now = self._loop.time()
            due = min(now + self._stall, self._begun + self._stall + pending / _LEAST)
            self._watch = self._loop.call_at(due, self._stalled)

    def _stalled(self) -> None:
        total = self._decoder.expected
        detail = f"{self._decoder.pending} bytes have come of {total if total is not None else 'a header'}"
        self.end("stalled", TimeoutError(detail))

    def eof_received(self) -> bool:
        """Take note that the other side sends no more."""
        try:
            self._decoder.finish()
        except FrameError as error:
            self.end("frame", error)
        else:
            self.end("closed", None)
        return True

    def connection_lost(self, exc: Exception | None) -> None:
        """Take note that the connection is over."""
        self.end("closed" if exc is None else "broken", exc)

    def end(self, why: str, error: Exception | None) -> None:
        """Tell the owner of the end, once. The transport stays open until `close`."""
        if self._is_over:
            return
        self._is_over = True
        for timer in (self._watch, self._paused_since):
            if timer is not None:
                timer.cancel()
        self._on_end(self, why, error)

    def pause_writing(self) -> None:
        """Watch a peer that does not read."""
        self._paused_since = self._loop.call_later(self._stall, self.end, "unread", None)

    def resume_writing(self) -> None:
        """Stop watching it."""
        if self._paused_since is not None:
            self._paused_since.cancel()
            self._paused_since = None

    def pause(self) -> None:
        """Look at no more frames, and read no more, until `resume`."""
        self.is_read = False
        if self._transport is not None and not self._transport.is_closing():
            self._transport.pause_reading()

    def resume(self) -> None:
        """Go on where `pause` has stopped."""
        if self.is_read:
            return
        self.is_read = True
        if self._transport is not None and not self._transport.is_closing():
            self._transport.resume_reading()
        self._loop.call_soon(self.take)

    @property
    def unsent(self) -> int:
        """Bytes that the peer has not taken yet."""
        waiting = 0 if self._transport is None else self._transport.get_write_buffer_size()
        return waiting + sum(map(len, self._out))

    def send(self, data: bytes) -> None:
        """Send bytes, together with those that follow in the same turn of the event loop."""
        if not self._out:
            self._loop.call_soon(self.flush)
        self._out.append(data)

    def flush(self) -> None:
        """Hand over what is to be sent."""
        if self._out and self._transport is not None and not self._transport.is_closing():
            self._transport.write(b"".join(self._out))
        self._out.clear()

    def close(self, *, at_once: bool = False) -> None:
        """Send what is left, unless at once, and close the transport."""
        self._is_over = True
        self.flush()
        if self._transport is not None:
            if at_once:
                self._transport.abort()
            else:
                self._transport.close()
