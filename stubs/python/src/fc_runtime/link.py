"""A connection's bytes: frames out of what is received, and what is sent in one write."""

from __future__ import annotations

import asyncio
import socket
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final, TypeAlias

from .calls import Loss, LossKind
from .errors import FrameError
from .within import within

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable

    from .frame import Decoder, Frame

Dial: TypeAlias = (
    "Callable[[Callable[[], asyncio.Protocol]], Awaitable[tuple[asyncio.BaseTransport, asyncio.BaseProtocol]]]"
)
"""Makes a connection, as `loop.create_connection` does: over TLS, or over a pipe."""

# What a frame has to bring to an app beside the stall timeout, in bytes per second: a wrong length swallows what
# follows.
_EARNED: Final = 16 * 1024
# After so many frames the others have their turn, and what has been answered goes out while the rest is read.
_TURN: Final = 16
# Frames are written together up to so many bytes. Longer ones are written one by one, for joining copies them.
_TOGETHER: Final = 64 * 1024
# How long the other side may take over its goodbye.
_CLOSING: Final = 1.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Patience:
    """What has to come, or go, in time. Times are in seconds."""

    stall: float
    """Without progress inside a frame, or while the other side does not read."""
    header: float | None = None
    """For a header, from its first byte to its last."""
    least_rate: int = 0
    """Fewer bytes per second than this, over a `stall`, are no progress."""
    idle: float | None = None
    """Of silence between frames."""
    earns: bool = False
    """Whether a frame may take `stall` in all, and longer only for what has come of it."""
    keepalive: float | None = None
    """TCP asks after so much silence."""


class Link(asyncio.Protocol):
    """Frames of one connection. Its owner is told of each, of each that is broken, and of the end."""

    def __init__(
        self,
        decoder: Decoder,
        patience: Patience,
        on_frame: Callable[[Link, Frame], None],
        on_fault: Callable[[Link, FrameError], None],
        on_end: Callable[[Link, str, Exception | None], None],
        on_made: Callable[[Link], None] | None = None,
        on_bytes: Callable[[int, int], None] | None = None,
        is_idle: Callable[[], bool] | None = None,
        *,
        reads_when_full: bool = True,
    ) -> None:
        """With what its owner wants to be told, and what it is asked."""
        self._decoder: Final = decoder
        self._patience: Final = patience
        self._on_frame: Final = on_frame
        self._on_fault: Final = on_fault
        self._on_end: Final = on_end
        self._on_made: Final = on_made
        self._on_bytes: Final = on_bytes
        self._is_idle: Final = is_idle
        self._reads_when_full: Final = reads_when_full
        self._loop: Final = asyncio.get_running_loop()
        self._least: Final = max(1, int(patience.least_rate * patience.stall))
        self._transport: asyncio.Transport | None = None
        self._out: list[bytes] = []
        self._out_bytes = 0
        self._is_started = False
        self._is_reading = True
        self._is_over = False
        self._holds: Final[set[str]] = set()
        self._next_turn: asyncio.Handle | None = None
        self._is_at_end = False
        self._watch: asyncio.TimerHandle | None = None
        self._write_watch: asyncio.TimerHandle | None = None
        self._idle_watch: asyncio.TimerHandle | None = None
        self._goodbye: asyncio.TimerHandle | None = None
        # The frame that arrives: when it began, and since when enough of it has not come.
        self._begun = self._flow_since = self._last_frame = 0.0
        self._flow = 0
        # What the other side has been sent, and what of that it had taken when that was enough.
        self._handed = self._taken = 0
        self._taken_since = 0.0
        self.is_full = False
        """Whether the other side does not take what is sent."""
        self._writable: Final[set[asyncio.Future[None]]] = set()
        self.gone: Final[asyncio.Future[None]] = self._loop.create_future()
        """Done once the transport is closed."""
        self.is_heard = False
        """Whether a frame has come."""
        self.received = 0
        """Bytes that have come."""

    @property
    def peer(self) -> str:
        """Address of the other side."""
        name: Any = None if self._transport is None else self._transport.get_extra_info("peername")
        return str(name[0]) if name else ""

    @property
    def sent(self) -> int:
        """Bytes handed over to be sent."""
        return self._handed

    @property
    def surplus(self) -> int:
        """Bytes that have come out of compressed data beyond those that went in, since this was last asked."""
        surplus, self._decoder.surplus = self._decoder.surplus, 0
        return surplus

    @property
    def held(self) -> int:
        """Bytes that have come and make no frame yet, and those that the other side has not taken."""
        return self._decoder.pending + self.unsent

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Take over a transport."""
        assert isinstance(transport, asyncio.Transport)
        self._transport = transport
        found = transport.get_extra_info("socket")
        keepalive = self._patience.keepalive
        if found is not None and keepalive is not None and found.family in (socket.AF_INET, socket.AF_INET6):
            found.setsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE, 1)
            for name, value in (("TCP_KEEPIDLE", int(keepalive)), ("TCP_KEEPINTVL", 10), ("TCP_KEEPCNT", 3)):
                if hasattr(socket, name):
                    found.setsockopt(socket.IPPROTO_TCP, getattr(socket, name), max(1, value))
        self._last_frame = self._loop.time()
        self._watch_idle()
        # Python 3.10 begins to read behind this, also where reading has been paused here.
        self._loop.call_soon(self._start)
        if self._on_made is not None:
            self._on_made(self)

    def fill_nothing(self) -> None:
        """Count as full as soon as the socket does not take what is sent, for `drained`."""
        if self._transport is not None:
            self._transport.set_write_buffer_limits(high=0)

    def data_received(self, data: bytes) -> None:
        """Take what has come."""
        if self._is_over:
            return
        now = self._loop.time()
        if self._decoder.pending == 0:
            self._begin(now)
        self.received += len(data)
        if self._on_bytes is not None:
            self._on_bytes(len(data), 0)
        self._flow += len(data)
        if self._flow >= self._least:
            self._flow, self._flow_since = 0, now
        self._decoder.push(data)
        self.take()

    def _begin(self, now: float) -> None:
        self._begun = self._flow_since = now
        self._flow = 0

    def take(self) -> None:
        """Give out whole frames, as long as they are looked at."""
        if self._next_turn is None:
            self._take()

    def _take(self) -> None:
        self._next_turn = None
        left = _TURN
        while not self._holds and not self._is_over:
            if left == 0:
                self._next_turn = self._loop.call_soon(self._take)
                # The next turn may be faster to come than the frames of this one are handled.
                self._read_or_rest()
                return
            left -= 1
            try:
                frame = self._decoder.next()
            except FrameError as error:
                self.is_heard = True
                if error.frame is None:
                    self.end("frame", error)
                    return
                self._whole()
                self._on_fault(self, error)
                continue
            if frame is None:
                if self._is_at_end:
                    self._finish()
                break
            self.is_heard = True
            self._whole()
            self._on_frame(self, frame)
        self._read_or_rest()
        self._watch_stall()

    def _finish(self) -> None:
        try:
            self._decoder.finish()
        except FrameError as error:
            self.end("frame", error)
        else:
            self.end("closed", None)

    def _whole(self) -> None:
        self._last_frame = self._loop.time()
        self._begin(self._last_frame)

    def _watch_stall(self) -> None:
        if self._watch is not None:
            self._watch.cancel()
            self._watch = None
        pending = self._decoder.pending
        if not pending or self._is_over or self._holds:
            return
        patience = self._patience
        due = self._flow_since + patience.stall
        if patience.earns:
            due = min(due, self._begun + patience.stall + pending / _EARNED)
        if patience.header is not None and pending < self._decoder.header_length:
            due = min(due, self._begun + patience.header)
        self._watch = self._loop.call_at(due, self._stalled)

    def _stalled(self) -> None:
        total = self._decoder.expected
        detail = f"{self._decoder.pending} bytes have come of {total if total is not None else 'a header'}"
        self.end("stalled", TimeoutError(detail))

    def _watch_idle(self) -> None:
        if self._patience.idle is not None and not self._is_over:
            due = max(self._last_frame + self._patience.idle, self._loop.time())
            self._idle_watch = self._loop.call_at(due, self._idle, self._last_frame)

    def _idle(self, last_frame: float) -> None:
        is_idle = self._is_idle is None or self._is_idle()
        if last_frame == self._last_frame and is_idle and self._decoder.pending == 0:
            self.end("idle", None)
            return
        if last_frame == self._last_frame:
            # What it is at counts as something that happens.
            self._last_frame = self._loop.time()
        self._watch_idle()

    def eof_received(self) -> bool:
        """Take note that the other side sends no more."""
        if self._is_over:
            return False
        self._is_at_end = True
        self.take()
        # TLS has no half of a connection: there it is over.
        return self._transport is not None and self._transport.get_extra_info("sslcontext") is None

    def connection_lost(self, exc: Exception | None) -> None:
        """Take note that the connection is over."""
        self.end("closed" if exc is None else "broken", exc)
        if self._goodbye is not None:
            self._goodbye.cancel()
        self._stop_waiting()
        if not self.gone.done():
            self.gone.set_result(None)

    def end(self, why: str, error: Exception | None) -> None:
        """Tell the owner of the end, once. The transport stays open until `close`."""
        if self._is_over:
            return
        self._stop()
        self._on_end(self, why, error)

    def _stop(self) -> None:
        self._is_over = True
        for timer in (self._watch, self._idle_watch):
            if timer is not None:
                timer.cancel()

    def pause_writing(self) -> None:
        """Take note that the other side does not take what is sent."""
        self.is_full = True
        if not self._reads_when_full:
            self.hold("full")

    def resume_writing(self) -> None:
        """Take note that it does again."""
        self.is_full = False
        self.let_go("full")
        self._stop_waiting()

    def _stop_waiting(self) -> None:
        for waiting in self._writable:
            if not waiting.done():
                waiting.set_result(None)

    async def drained(self) -> bool:
        """Wait until there is room to send; false if the connection is over."""
        self.flush()
        while self.is_full and not self.gone.done():
            waiting: asyncio.Future[None] = self._loop.create_future()
            self._writable.add(waiting)
            try:
                await waiting
            finally:
                self._writable.discard(waiting)
        return not self.gone.done()

    def hold(self, why: str) -> None:
        """Look at no more frames, and read no more, until all who have held it have let go."""
        self._holds.add(why)
        self._read_or_rest()
        if self._watch is not None:
            self._watch.cancel()

    def let_go(self, why: str) -> None:
        """Go on where `hold` has stopped."""
        if why not in self._holds:
            return
        self._holds.discard(why)
        if self._holds:
            return
        self._read_or_rest()
        # What could not come meanwhile is not missed.
        self._begin(self._loop.time())
        self._loop.call_soon(self.take)

    def _start(self) -> None:
        self._is_started = True
        self._read_or_rest()

    def _read_or_rest(self) -> None:
        """Read while nobody holds it, and while nothing waits to be looked at: what has come is bounded by that."""
        wants = not self._holds and self._next_turn is None
        if wants == self._is_reading or not self._is_started or self._transport is None:
            return
        if self._transport.is_closing():
            return
        self._is_reading = wants
        if wants:
            self._transport.resume_reading()
        else:
            self._transport.pause_reading()

    @property
    def unsent(self) -> int:
        """Bytes that the other side has not taken yet."""
        waiting = 0 if self._transport is None else self._transport.get_write_buffer_size()
        return waiting + self._out_bytes

    def send(self, data: bytes) -> None:
        """Send bytes, together with those that follow in the same turn of the event loop."""
        if not self._out:
            self._loop.call_soon(self.flush)
        self._out.append(data)
        self._out_bytes += len(data)
        # The owner may close the link for what it holds.
        if self._on_bytes is not None:
            self._on_bytes(0, len(data))

    def flush(self) -> None:
        """Hand over what is to be sent."""
        out, size = self._out, self._out_bytes
        self._out, self._out_bytes = [], 0
        if not out or self._transport is None or self._transport.is_closing():
            return
        if self._transport.get_write_buffer_size() == 0:
            self._taken, self._taken_since = self._handed, self._loop.time()
        self._handed += size
        if size <= _TOGETHER:
            out = [b"".join(out)]
        out.reverse()
        while out:
            # The transport may copy what it takes: nothing is held twice for long.
            self._transport.write(out.pop())
        self._watch_writing()

    def _watch_writing(self) -> None:
        if self._write_watch is None and self._transport is not None and self._transport.get_write_buffer_size():
            self._write_watch = self._loop.call_later(self._patience.stall / 4, self._look_at_writing)

    def _look_at_writing(self) -> None:
        self._write_watch = None
        if self._transport is None or self.gone.done():
            return
        now, left = self._loop.time(), self._transport.get_write_buffer_size()
        if left == 0:
            return
        if self._handed - left - self._taken >= self._least:
            self._taken, self._taken_since = self._handed - left, now
        if now - self._taken_since >= self._patience.stall:
            if self._is_over:
                self._transport.abort()
            self.end("unread", None)
            return
        self._watch_writing()

    def _end_goodbye(self) -> None:
        """Wait no longer, unless there is still something to be sent: that has its own time."""
        if self._transport is None or self._transport.get_write_buffer_size() == 0:
            self.abort()
        else:
            self._goodbye = self._loop.call_later(_CLOSING, self._end_goodbye)

    def abort(self) -> None:
        """Close the transport, whatever is still to be sent."""
        self._stop()
        if self._transport is not None:
            self._transport.abort()

    def close(self, *, at_once: bool = False) -> None:
        """Send what is left, unless at once, and close the transport."""
        self._stop()
        transport = self._transport
        if at_once:
            self._out, self._out_bytes = [], 0
            if transport is not None:
                transport.abort()
            return
        self.flush()
        if transport is None or transport.is_closing():
            return
        if not self._is_at_end and transport.can_write_eof():
            # To close with something unread resets the connection, and what was sent may be lost with it.
            try:
                transport.write_eof()
            except OSError:
                # The other side has reset the connection, and the loop has not seen it yet.
                transport.abort()
                return
            if not self._is_reading:
                transport.resume_reading()
            self._goodbye = self._loop.call_later(_CLOSING, self._end_goodbye)
        else:
            transport.close()


async def dialled(dial: Dial, link: Link, seconds: float) -> Loss | None:
    """Connects a link. Returns why there is no connection, if there is none."""
    try:
        await within(seconds, dial(lambda: link))
    except asyncio.CancelledError:
        link.abort()
        raise
    except (asyncio.TimeoutError, TimeoutError):
        return Loss(LossKind.CONNECT_TIMEOUT)
    except Exception as error:  # noqa: BLE001 - such as a name that cannot be encoded; attempts go on whatever it is
        return Loss(LossKind.UNREACHABLE, type(error).__name__)
    return None
