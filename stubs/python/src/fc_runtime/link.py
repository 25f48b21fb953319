"""The bytes of a connection: splits received ones into frames, and joins frames to send into one write."""

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

# Least rate of a frame to an app, in bytes per second, after a grace of one stall timeout: a wrong length swallows the
# frames after it.
_EARNED: Final = 16 * 1024
# Frames handled in one turn. Then other connections run, and responses go out while the rest is read.
_TURN: Final = 16
# Most bytes of frames joined into one write. Longer ones are written separately, since joining copies them.
_TOGETHER: Final = 64 * 1024
# Time the other side may take to close its half.
_CLOSING: Final = 1.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Patience:
    """Timeouts of a connection, in seconds."""

    stall: float
    """Time without progress inside a frame, or while the other side does not read."""
    header: float | None = None
    """Time for a header, from its first byte to its last."""
    least_rate: int = 0
    """Least bytes per second that count as progress, averaged over `stall`."""
    idle: float | None = None
    """Silence allowed between frames."""
    earns: bool = False
    """A frame may take `stall` in all, and longer only at the least rate."""
    keepalive: float | None = None
    """Silence before TCP probes."""


class Link(asyncio.Protocol):
    """Frames of one connection. Calls its owner back for each frame, each invalid one, and the end."""

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
        """Creates the link with its owner's callbacks."""
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
        # Times of the present frame: its beginning, and the last sufficient progress.
        self._begun = self._flow_since = self._last_frame = 0.0
        self._flow = 0
        # Bytes sent, and bytes taken by the other side at the last sufficient progress.
        self._handed = self._taken = 0
        self._taken_since = 0.0
        self.is_full = False
        """`True` if the other side does not take sent bytes."""
        self._writable: Final[set[asyncio.Future[None]]] = set()
        self.gone: Final[asyncio.Future[None]] = self._loop.create_future()
        """Done once the transport is closed."""
        self.is_heard = False
        """`True` once a frame has been received."""
        self.received = 0
        """Number of bytes received."""

    @property
    def peer(self) -> str:
        """Address of the other side."""
        name: Any = None if self._transport is None else self._transport.get_extra_info("peername")
        return str(name[0]) if name else ""

    @property
    def sent(self) -> int:
        """Number of bytes handed over for sending."""
        return self._handed

    @property
    def surplus(self) -> int:
        """Bytes of decompressed data beyond the compressed ones, since the last query."""
        surplus, self._decoder.surplus = self._decoder.surplus, 0
        return surplus

    @property
    def held(self) -> int:
        """Bytes of an incomplete frame, and bytes that the other side has not taken."""
        return self._decoder.pending + self.unsent

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Takes over a transport."""
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
        # Python 3.10 starts reading after this callback, even if reading was paused here.
        self._loop.call_soon(self._start)
        if self._on_made is not None:
            self._on_made(self)

    def fill_nothing(self) -> None:
        """Makes `drained` wait until the socket has taken all bytes."""
        if self._transport is not None:
            self._transport.set_write_buffer_limits(high=0)

    def data_received(self, data: bytes) -> None:
        """Takes received bytes."""
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
        """Handles whole frames, as long as the owner does not hold the link."""
        if self._next_turn is None:
            self._take()

    def _take(self) -> None:
        self._next_turn = None
        left = _TURN
        while not self._holds and not self._is_over:
            if left == 0:
                self._next_turn = self._loop.call_soon(self._take)
                # The next turn may come before the frames of this one are handled.
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
            # A running request counts as activity.
            self._last_frame = self._loop.time()
        self._watch_idle()

    def eof_received(self) -> bool:
        """Notes that the other side sends no more."""
        if self._is_over:
            return False
        self._is_at_end = True
        self.take()
        # TLS cannot close one half: there the connection is over.
        return self._transport is not None and self._transport.get_extra_info("sslcontext") is None

    def connection_lost(self, exc: Exception | None) -> None:
        """Notes that the connection is over."""
        self.end("closed" if exc is None else "broken", exc)
        if self._goodbye is not None:
            self._goodbye.cancel()
        self._stop_waiting()
        if not self.gone.done():
            self.gone.set_result(None)

    def end(self, why: str, error: Exception | None) -> None:
        """Calls the owner back with the end, once. The transport stays open until `close`."""
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
        """Notes that the other side does not take sent bytes."""
        self.is_full = True
        if not self._reads_when_full:
            self.hold("full")

    def resume_writing(self) -> None:
        """Notes that it takes them again."""
        self.is_full = False
        self.let_go("full")
        self._stop_waiting()

    def _stop_waiting(self) -> None:
        for waiting in self._writable:
            if not waiting.done():
                waiting.set_result(None)

    async def drained(self) -> bool:
        """Waits until there is room to send. Returns `False` if the connection is over."""
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
        """Stops reading and handling frames, until each reason has been let go."""
        self._holds.add(why)
        self._read_or_rest()
        if self._watch is not None:
            self._watch.cancel()

    def let_go(self, why: str) -> None:
        """Removes a reason to hold."""
        if why not in self._holds:
            return
        self._holds.discard(why)
        if self._holds:
            return
        self._read_or_rest()
        # Time spent on hold does not count as a stall.
        self._begin(self._loop.time())
        self._loop.call_soon(self.take)

    def _start(self) -> None:
        self._is_started = True
        self._read_or_rest()

    def _read_or_rest(self) -> None:
        """Reads only while the link is not on hold and no frames wait, which bounds the received bytes."""
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
        """Number of bytes that the other side has not taken yet."""
        waiting = 0 if self._transport is None else self._transport.get_write_buffer_size()
        return waiting + self._out_bytes

    def send(self, data: bytes) -> None:
        """Sends bytes, together with others of the same turn of the event loop."""
        if not self._out:
            self._loop.call_soon(self.flush)
        self._out.append(data)
        self._out_bytes += len(data)
        # The owner may close the link if it holds too many bytes.
        if self._on_bytes is not None:
            self._on_bytes(0, len(data))

    def flush(self) -> None:
        """Hands the queued bytes to the transport."""
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
            # The transport may copy bytes, so they are released one by one.
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
        """Ends waiting for the other side. Unsent bytes have a separate timeout."""
        if self._transport is None or self._transport.get_write_buffer_size() == 0:
            self.abort()
        else:
            self._goodbye = self._loop.call_later(_CLOSING, self._end_goodbye)

    def abort(self) -> None:
        """Closes the transport without sending the rest."""
        self._stop()
        if self._transport is not None:
            self._transport.abort()

    def close(self, *, at_once: bool = False) -> None:
        """Sends the rest, unless `at_once`, and closes the transport."""
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
            # Closing with unread bytes resets the connection, and sent bytes may be lost with it.
            try:
                transport.write_eof()
            except OSError:
                # The other side has reset the connection, and the event loop has not noticed yet.
                transport.abort()
                return
            if not self._is_reading:
                transport.resume_reading()
            self._goodbye = self._loop.call_later(_CLOSING, self._end_goodbye)
        else:
            transport.close()


async def dialled(dial: Dial, link: Link, seconds: float) -> Loss | None:
    """Connects a link. Returns the loss if that fails."""
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
