"""An app's connection to the data port.

Nothing is queued but one frame that has come, unless something is subscribed to: while the app does not take it, the
robot is not read. Nothing on this port is acknowledged, so each loss is told once to who receives, and once to who
sends if anything was sent over the lost connection. Nothing is sent twice.
"""

from __future__ import annotations

import asyncio
import contextlib
import logging
from typing import TYPE_CHECKING, Any, Final, Generic, TypeAlias, TypeVar

from .backoff import Tries
from .calls import Loss, LossKind, Refusal
from .codec import write_content
from .data_errors import (
    DataClosedError,
    DataError,
    DataFrameError,
    DataInvalidError,
    DataLostError,
    DataNotConnectedError,
    DataRefusedError,
    DataUnexpectedError,
)
from .data_queues import StreamFrame, StreamItem, Taker
from .enveloped import read_response
from .errors import BodyError, FrameError
from .frame import Decoder, Encoder, frame_bytes, stream_frame
from .life import Life
from .link import Link, Patience, dialled
from .states import Closed, Connected, Connecting
from .within import within

if TYPE_CHECKING:
    from collections.abc import AsyncIterator
    from types import TracebackType

    from .connection import Connection
    from .frame import Frame
    from .link import Dial
    from .message import Message
    from .operations import Stream
    from .states import ConnectionState

B = TypeVar("B", bound="Message | bytes")

_log: Final = logging.getLogger(__name__)

Arrived: TypeAlias = "StreamFrame | DataError"


class DataConnection:
    """A connection to a robot's data port: frames of raw bytes in both directions.

    It is made in the background as soon as the command connection is there, made again after a loss, and whenever the
    command connection was made again: a robot knows whose it is by the address alone. It ends with the command
    connection, or with `close()`.
    """

    def __init__(self, commands: Connection, dial: Dial | None = None) -> None:
        """Beside a connection to the command port."""
        config, protocol = commands.config, commands.protocol
        self.life: Final = Life()
        self._commands: Final = commands
        self._loop: Final = asyncio.get_running_loop()
        self._address: Final = (
            commands.address[0],
            protocol.data_port if config.data_port is None else config.data_port,
        )
        self._dial: Final = dial or self._tcp
        self._patience: Final = commands.call_timeout
        self._encoder: Final = Encoder(protocol, commands.limits, compress=config.gzip)
        self._sending: Final = asyncio.Lock()
        self._link: Link | None = None
        self._lost: asyncio.Future[Loss] = self._loop.create_future()
        # Beside a loss that nobody has been told yet there is room for one frame.
        self._inbox: Final[list[Arrived]] = []
        self._unsure: Loss | None = None
        self._has_sent = False
        self._takers: Final[list[Taker]] = []
        self._waiting: Final[set[asyncio.Future[None]]] = set()
        self._skipped = 0
        self._driver: Final = self._loop.create_task(self._drive())

    async def _tcp(self, factory: Any) -> tuple[asyncio.BaseTransport, asyncio.BaseProtocol]:
        host, port = self._address
        return await self._loop.create_connection(factory, host, port, ssl=self._commands.config.ssl)

    @property
    def state(self) -> ConnectionState:
        """Whether there is a connection at this moment, and why not."""
        return self.life.state

    def states(self) -> AsyncIterator[ConnectionState]:
        """The present state, and each that it comes to; nothing after `Closed`."""
        return self.life.states()

    async def closed(self) -> Loss:
        """Wait until the connection has ended for good, and say why."""
        return await self.life.closed()

    async def connected(self) -> None:
        """Wait until there is a connection, for no longer than the call timeout. Raises `DataError`.

        A robot sends what it is asked for to the data connections that there are: wait for this one before asking.
        """
        await self._wait_connected(self._loop.time() + self._patience)

    async def _wait_connected(self, deadline: float) -> None:
        async def wait() -> None:
            async for state in self.life.states():
                if not isinstance(state, Connecting):
                    return

        with contextlib.suppress(asyncio.TimeoutError, TimeoutError):
            await within(max(0.0, deadline - self._loop.time()), wait())
        if isinstance(self.state, Closed):
            raise DataClosedError(self.state.why)
        if isinstance(self.state, Connecting):
            raise DataNotConnectedError(self.state.why)

    async def _drive(self) -> None:
        """Keep the connection up."""
        tries = Tries(self._commands.config.reconnect)
        why = Loss(LossKind.NOT_YET)
        try:
            while (wait := tries.next()) is not None:
                await asyncio.sleep(wait)
                number = await self._commands_connected()
                if number is None:
                    break
                loss = await self._attempt()
                if loss is not None:
                    why = loss
                    tries.failed()
                    self.life.turn(Connecting(self.state.connects, loss))
                    continue
                why = await self._serve(number)
                if self._commands.life.is_closed:
                    break
                # A robot may have nothing to send.
                is_used = self._has_sent or (self._link is not None and self._link.is_heard)
                tries.connected(is_used=is_used or why.kind is LossKind.RENEWED)
                self._down(why)
        finally:
            commands = self._commands.life.state
            self._end(commands.why if isinstance(commands, Closed) else why)

    async def _commands_connected(self) -> int | None:
        """Wait for the command connection, and say which it is; `None` once there will be none."""
        async for state in self._commands.life.states():
            if isinstance(state, Connected):
                return state.connects
            if isinstance(state, Connecting):
                self.life.turn(Connecting(self.state.connects, state.why))
        return None

    async def _attempt(self) -> Loss | None:
        commands = self._commands
        config = commands.config
        link = Link(
            Decoder(commands.protocol, commands.limits, verify_digest=config.verify_digest, resync=config.resync),
            Patience(stall=config.stall_timeout, keepalive=config.keepalive),
            self._arrive,
            self._arrive_broken,
            self._ended,
        )
        self._lost = self._loop.create_future()
        loss = await dialled(self._dial, link, config.connect_timeout)
        if loss is not None:
            return loss
        link.fill_nothing()
        self._link = link
        self._has_sent = False
        self.life.turn(Connected(self.state.connects + 1))
        _log.info("%s: data connection to %s, %d", commands.protocol.name, self._address, self.state.connects)
        return None

    async def _serve(self, number: int) -> Loss:
        """Wait until the connection ends, or the command connection that it belongs to."""

        async def parted() -> Loss:
            async for state in self._commands.life.states():
                if isinstance(state, Closed):
                    return state.why
                if state.connects != number:
                    break
            return Loss(LossKind.RENEWED)

        watching = self._loop.create_task(parted())
        try:
            await asyncio.wait({self._lost, watching}, return_when=asyncio.FIRST_COMPLETED)
            return self._lost.result() if self._lost.done() else watching.result()
        finally:
            watching.cancel()

    def _down(self, why: Loss) -> None:
        """The connection that there was is lost, and what was on its way with it."""
        if self.life.is_closed:
            return
        link, self._link = self._link, None
        _log.info("%s: lost the data connection to %s: %s", self._commands.protocol.name, self._address, why)
        if link is not None:
            link.close(at_once=why.kind is not LossKind.RENEWED)
        if self._has_sent:
            self._unsure = why
        if not self._inbox or not isinstance(self._inbox[-1], DataLostError):
            self._inbox.append(DataLostError(why))
        for taker in self._takers:
            taker.lost(why)
        self.life.turn(Connecting(self.state.connects, why))
        self._tell()

    def _end(self, why: Loss) -> None:
        if self.life.is_closed:
            return
        link, self._link = self._link, None
        if link is not None:
            link.close()
        self.life.turn(Closed(self.state.connects, why))
        self._tell()

    def close(self) -> None:
        """Close the connection. What is being sent is finished; what has come can still be received."""
        self._end(Loss(LossKind.HERE))
        self._driver.cancel()

    def _ended(self, link: Link, why: str, error: Exception | None) -> None:
        kind = {
            "closed": LossKind.CLOSED if link.is_heard else LossKind.UNHEARD,
            "broken": LossKind.BROKEN if link.is_heard else LossKind.UNHEARD,
        }.get(why) or LossKind(why)
        detail = str(error) if isinstance(error, (FrameError, TimeoutError)) else type(error).__name__ if error else ""
        if not self._lost.done():
            self._lost.set_result(Loss(kind, detail))

    def _arrive(self, _: Link, frame: Frame) -> None:
        protocol = self._commands.protocol
        if frame.id.kind != protocol.stream:
            self._place(DataUnexpectedError(frame.id))
        elif not frame.id.response:
            self._place(StreamFrame(frame.id.code, frame.id.id, frame.data))
        else:
            try:
                read_response(protocol, None, frame.data, self._commands.limits)
            except Refusal as refusal:
                self._place(DataRefusedError(frame.id, refusal))
            except BodyError:
                self._place(DataUnexpectedError(frame.id))
            else:
                self._place(DataUnexpectedError(frame.id))

    def _arrive_broken(self, _: Link, error: FrameError) -> None:
        self._place(DataFrameError(error))

    def _place(self, arrived: Arrived) -> None:
        """Leave what has come where it is asked for."""
        code = arrived.code if isinstance(arrived, (StreamFrame, DataFrameError)) else None
        takers = [one for one in self._takers if one.code == code]
        if takers:
            for taker in takers:
                taker.push(arrived)
        elif len(self._inbox) < (1 if self._takers else 2):
            self._inbox.append(arrived)
        else:
            # Subscribers do not wait for a receiver that there may not be.
            self._skipped += 1
        if self._inbox and not self._takers and self._link is not None:
            self._link.hold("inbox")
        self._tell()

    def _tell(self) -> None:
        for waiting in self._waiting:
            if not waiting.done():
                waiting.set_result(None)

    async def _wait(self) -> None:
        waiting: asyncio.Future[None] = self._loop.create_future()
        self._waiting.add(waiting)
        try:
            await waiting
        finally:
            self._waiting.discard(waiting)

    def _let_go(self) -> None:
        if self._link is not None:
            self._link.let_go("inbox")

    async def recv(self) -> StreamFrame:
        """The next frame to which nobody has subscribed. Raises `DataError`.

        Unless that is `DataClosedError`, the next call goes on with the next frame. It may be cancelled.
        """
        while True:
            if self._inbox:
                taken = self._inbox.pop(0)
                if not self._inbox:
                    self._let_go()
                if isinstance(taken, DataError):
                    raise taken
                return taken
            if isinstance(self.state, Closed):
                raise DataClosedError(self.state.why)
            await self._wait()

    @property
    def missed(self) -> int:
        """How many frames to which nobody had subscribed have been dropped so far, for nobody took the one before."""
        return self._skipped

    def subscribe(self, stream: Stream[B]) -> Subscription[B]:
        """Receive the frames of one stream from now on, in a queue of their own; `recv` no longer gives them.

        As long as anybody has subscribed, the robot is read whatever the app takes.
        """
        if stream.code is None:
            raise ValueError(f"{stream.name} has no code yet")
        taker = Taker(stream.code)
        self._takers.append(taker)
        self._let_go()
        return Subscription(self, stream, taker)

    def leave(self, taker: Taker) -> None:
        """Keep no more frames for a subscription."""
        if taker in self._takers:
            self._takers.remove(taker)

    async def next_of(self, taker: Taker) -> StreamFrame:
        """What comes next for a subscription. Raises `DataError`."""
        while not taker.waiting:
            if isinstance(self.state, Closed) or taker not in self._takers:
                raise DataClosedError(self.state.why if isinstance(self.state, Closed) else Loss(LossKind.HERE))
            await self._wait()
        taken = taker.waiting.popleft()
        if isinstance(taken, DataError):
            raise taken
        return taken

    async def send_stream(self, stream: Stream[B], message_id: int, content: B) -> None:
        """Send a frame of one of the app's own streams; all else is as with `send`."""
        if stream.code is None:
            raise ValueError(f"{stream.name} has no code yet")
        try:
            data = write_content(stream.body, content)
        except BodyError as error:
            raise DataInvalidError(error) from None
        await self.send(stream.code, message_id, data)

    async def send(self, code: int, message_id: int, data: bytes) -> None:
        """Send a frame of raw bytes; done when the socket has taken it. Raises `DataError`.

        Without a connection it waits for one, for no longer than the call timeout. `DataLostError` says that this
        frame, or one sent before, may not have arrived; after `DataNotConnectedError`, `DataClosedError` and
        `DataFrameError` nothing was sent. A frame that has been begun is finished also when this is cancelled.
        """
        frame, data = stream_frame(self._commands.protocol, code, message_id), frame_bytes(data)
        deadline = self._loop.time() + self._patience
        async with self._sending:
            try:
                data = self._encoder.encode(frame, data)
            except FrameError as error:
                raise DataFrameError(error) from None
            while True:
                if isinstance(self.state, Closed):
                    raise DataClosedError(self.state.why)
                if self._unsure is not None:
                    loss, self._unsure = self._unsure, None
                    raise DataLostError(loss)
                if self._link is not None:
                    break
                await self._wait_connected(deadline)
            link, self._has_sent = self._link, True
            link.send(data)
            if await link.drained() and self._link is link:
                return
            # What has become of it is known when the driver has taken note of the end.
            while self._link is link and not self.life.is_closed:
                await self._wait()
            known, self._unsure = self._unsure, None
            state = self.state
            raise DataLostError(known or (state.why if not isinstance(state, Connected) else Loss(LossKind.BROKEN)))

    async def __aenter__(self) -> DataConnection:
        """Wait until there is a connection."""
        await self.connected()
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Close the connection."""
        self.close()


class Subscription(Generic[B]):
    """The frames of one stream, each read as its type; go through them with `async for`, to the connection's end.

    It has a queue of four frames. While that is full, the oldest makes way for the one that comes, and `missed` counts
    it. It goes on over reconnecting; `close()` it, or enter it with `async with`.
    """

    def __init__(self, data: DataConnection, stream: Stream[B], taker: Taker) -> None:
        """Made by `DataConnection.subscribe`."""
        self._data: Final = data
        self._stream: Final = stream
        self._taker: Final = taker

    @property
    def missed(self) -> int:
        """How many frames have made way so far."""
        return self._taker.missed

    async def recv(self) -> StreamItem[B]:
        """The next frame. Raises `DataError`; unless that is `DataClosedError`, the next call goes on."""
        frame = await self._data.next_of(self._taker)
        body: Any = self._stream.body
        if body is bytes:
            return StreamItem(frame.id, frame.data)  # type: ignore[arg-type]
        try:
            return StreamItem(frame.id, body.from_json(frame.data))
        except BodyError as error:
            raise DataInvalidError(error) from None

    def close(self) -> None:
        """Receive no more."""
        self._data.leave(self._taker)

    def __aiter__(self) -> Subscription[B]:
        """Itself."""
        return self

    async def __anext__(self) -> StreamItem[B]:
        """The next frame."""
        try:
            return await self.recv()
        except DataClosedError:
            raise StopAsyncIteration from None

    async def __aenter__(self) -> Subscription[B]:
        """Itself."""
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Receive no more."""
        self.close()


class Streams:
    """The streams of the data port: each that the robot sends can be subscribed to, each of the app's own be sent."""

    def __init__(self, data: DataConnection) -> None:
        """Those of a data connection; see `Client.data`."""
        self.data: Final = data
        """The data connection: its state, and frames that nobody has subscribed to."""
