"""One app's connection to the data port of a robot, and its owner."""

from __future__ import annotations

import asyncio
from collections import deque
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from .enveloped import write_response
from .frame import Decoder, FrameId
from .link import Link
from .pace import Pace

if TYPE_CHECKING:
    from collections.abc import Callable

    from .errors import FrameError
    from .frame import Frame, Prepared
    from .server import Server


# Frames waiting for one app, or for the robot, without the one being sent.
_QUEUE: Final = 4


@dataclass(frozen=True, slots=True)
class AppStream:
    """A frame of raw bytes from an app."""

    connection: int
    """The data connection that it came over."""
    address: str
    """The app's address."""
    code: int
    """Code of the command that it belongs to."""
    id: int
    """Its message id."""
    data: bytes
    """Its bytes."""

    def __repr__(self) -> str:
        """Shows it without its bytes."""
        return f"AppStream(connection={self.connection}, code=0x{self.code:04X}, id={self.id}, bytes={len(self.data)})"


class AppStreams:
    """The frames of raw bytes from apps, in their order on each connection, for `async for`.

    While the queue is full, data connections are not read.
    """

    def __init__(self, most_bytes: int, on_room: Callable[[], None]) -> None:
        """Creates an empty queue. `on_room` is called when there may be room again."""
        self._most_bytes: Final = most_bytes
        self._on_room: Final = on_room
        self._frames: Final[deque[AppStream]] = deque()
        self._waiting: asyncio.Future[None] | None = None
        self._is_over = False

    @property
    def is_full(self) -> bool:
        """`True` if there is no room for a frame."""
        return not self._is_over and (len(self._frames) >= _QUEUE or self.held() >= self._most_bytes)

    def held(self, connection: int | None = None) -> int:
        """Number of waiting bytes, in total or of one connection."""
        return sum(len(one.data) for one in self._frames if connection in (None, one.connection))

    def put(self, frame: AppStream) -> None:
        """Queues a frame. The caller checks that there is room."""
        self._frames.append(frame)
        self._wake()

    def drop(self, connection: int) -> None:
        """Drops the frames of a connection."""
        left = [one for one in self._frames if one.connection != connection]
        self._frames.clear()
        self._frames.extend(left)
        self._on_room()

    def _wake(self) -> None:
        if self._waiting is not None and not self._waiting.done():
            self._waiting.set_result(None)

    def end(self) -> None:
        """Ends the queue: the robot has ended, or another receiver has taken over."""
        self._is_over = True
        self._on_room()
        self._wake()

    async def recv(self) -> AppStream | None:
        """Returns the next frame; `None` once the robot has ended or another receiver has taken over."""
        while not self._frames:
            if self._is_over:
                return None
            self._waiting = asyncio.get_running_loop().create_future()
            try:
                await self._waiting
            finally:
                self._waiting = None
        frame = self._frames.popleft()
        self._on_room()
        return frame

    def __aiter__(self) -> AppStreams:
        """Returns itself."""
        return self

    async def __anext__(self) -> AppStream:
        """Returns the next frame."""
        frame = await self.recv()
        if frame is None:
            raise StopAsyncIteration
        return frame


class DataPeer:
    """One app's data connection."""

    def __init__(self, server: Server, connection: int) -> None:
        """Creates a data connection of a robot, with this number."""
        config = server.config
        self.server: Final = server
        self.connection: Final = connection
        self.address = ""
        """The app's address."""
        self.owners: Final[set[int]] = set()
        """Command connections open at the same address since this one began."""
        self._outbox: Final[deque[tuple[FrameId, Prepared]]] = deque()
        self._room: Final[set[asyncio.Future[None]]] = set()
        self._writer: asyncio.Task[None] | None = None
        self._is_over = False
        self._pace: Final = Pace()
        decoder = Decoder(server.protocol, server.limits, verify_digest=config.verify_digest, resync=config.resync)
        self.link: Final = Link(
            decoder,
            server.patience,
            self._arrive,
            self._arrive_broken,
            self._ended,
            on_made=self._made,
            on_bytes=server.count_bytes,
        )

    def _made(self, link: Link) -> None:
        self.address = link.peer
        link.fill_nothing()
        self.server.admit_data(self)

    @property
    def is_heard(self) -> bool:
        """`True` if bytes have been received over it."""
        return self.link.received > 0

    @property
    def held(self) -> int:
        """Bytes held for it."""
        return self.link.held + sum(len(prepared.data) for _, prepared in self._outbox)

    def _arrive(self, _: Link, frame: Frame) -> None:
        server = self.server
        if frame.id.kind != server.protocol.stream or frame.id.response:
            self._refuse(frame.id)
            return
        server.put_stream(AppStream(self.connection, self.address, frame.id.code, frame.id.id, frame.data))

    def _arrive_broken(self, _: Link, error: FrameError) -> None:
        self.server.counters.bad_frames += 1
        assert error.frame is not None
        self._refuse(error.frame)

    def _refuse(self, frame: FrameId) -> None:
        """Refuses a frame that cannot be used, if there is room for the response."""
        server = self.server
        if not frame.response and server.protocol.has_result and len(self._outbox) < _QUEUE:
            data = write_response(server.protocol, server.protocol.results.protocol)
            self._put(frame.answer(), server.encoder.prepare(data))
        rest = self._pace.owe(1, 0, server.loop.time())
        if rest > 0:
            server.counters.connections_paced += 1
            self.link.hold("pace")
            server.loop.call_later(rest, self.link.let_go, "pace")

    def _put(self, frame: FrameId, prepared: Prepared) -> None:
        self._outbox.append((frame, prepared))
        self.server.look_at_memory(len(prepared.data))
        if self._is_over:
            return
        if self._writer is None:
            self._writer = self.server.loop.create_task(self._write())

    async def _write(self) -> None:
        """Sends the frames one after another, each when the socket has taken the one before."""
        while self._outbox and await self.link.drained():
            frame, prepared = self._outbox.popleft()
            self.link.send(self.server.encoder.frame(frame, prepared))
            self.link.flush()
            if not frame.response:
                self.server.counters.stream_frames_out += 1
            for waiting in self._room:
                if not waiting.done():
                    waiting.set_result(None)
        self._writer = None
        if self._is_over:
            self.link.close()

    async def send(self, frame: FrameId, prepared: Prepared) -> bool:
        """Queues a frame as soon as there is room. Returns `False` if the connection is over."""
        while len(self._outbox) >= _QUEUE and not self._is_over:
            waiting: asyncio.Future[None] = self.server.loop.create_future()
            self._room.add(waiting)
            try:
                await waiting
            finally:
                self._room.discard(waiting)
        if self._is_over:
            return False
        self._put(frame, prepared)
        return not self._is_over

    def _ended(self, _: Link, why: str, error: Exception | None) -> None:
        server = self.server
        if why in ("stalled", "idle", "unread"):
            server.counters.connections_timed_out += 1
        if why == "frame":
            server.counters.bad_frames += 1
        server.log_end(self.connection, self.address, "data", f"{why}: {error}" if error else why)
        self.over(at_once=why in ("broken", "unread"))

    def over(self, *, at_once: bool = False) -> None:
        """Ends the connection. Queued frames are still sent, unless `at_once`."""
        if self._is_over:
            return
        self._is_over = True
        for waiting in self._room:
            if not waiting.done():
                waiting.set_result(None)
        if at_once:
            self._outbox.clear()
        if at_once or self._writer is None:
            self.link.close(at_once=at_once)
        self.server.gone_data(self)
