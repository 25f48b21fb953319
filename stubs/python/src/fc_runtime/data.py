"""An app's connection to the data port.

Only one received frame is queued, except for subscriptions. Until the app takes it, nothing more is read from the
robot. This port has no acknowledgements and nothing is sent twice. Each loss is reported once to the receiver. It is
reported once to the sender, if the lost connection had sent anything.
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

    It is made in the background once the command connection exists. It is made again after a loss and after each new
    command connection, since a robot knows its owner only by the address. It ends with the command connection, or with
    `close()`.
    """

    def __init__(self, commands: Connection, dial: Dial | None = None) -> None:
        """Creates the data connection of a command connection."""
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
        # There is room for one frame, and for a loss not yet reported.
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
        """The present state of the connection, with the reason if there is none."""
        return self.life.state

    def states(self) -> AsyncIterator[ConnectionState]:
        """Yields the present state, then each change; `Closed` is the last."""
        return self.life.states()

    async def closed(self) -> Loss:
        """Waits until the connection has ended for good. Returns the reason."""
        return await self.life.closed()

    async def connected(self) -> None:
        """Waits until there is a connection, at most for the call timeout. Raises `DataError`.

        A robot sends requested data only to existing data connections: call this before the request.
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
        """Keeps the connection up."""
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
        """Waits for the command connection. Returns its number; `None` once there will be none."""
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
        """Waits until the connection ends, or the command connection that it belongs to."""

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
        """Notes that the connection is lost, with the frames in flight."""
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
        """Closes the connection. A frame being sent is finished, and received frames can still be taken."""
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
        """Delivers a received frame or error to the subscriptions or to the inbox."""
        code = arrived.code if isinstance(arrived, (StreamFrame, DataFrameError)) else None
        takers = [one for one in self._takers if one.code == code]
        if takers:
            for taker in takers:
                taker.push(arrived)
        elif len(self._inbox) < (1 if self._takers else 2):
            self._inbox.append(arrived)
        else:
            # Subscribers must not wait for a receiver that may not exist.
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
        """Returns the next frame without a subscription. Raises `DataError`.

        After any error except `DataClosedError`, the next call continues with the next frame. The call may be
        cancelled.
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
        """Number of frames without a subscription dropped so far, because the one before was not taken."""
        return self._skipped

    def subscribe(self, stream: Stream[B]) -> Subscription[B]:
        """Subscribes to the frames of one stream. They get a separate queue and no longer come to `recv`.

        While there is a subscription, the robot is read even if the app takes no frames.
        """
        if stream.code is None:
            raise ValueError(f"{stream.name} has no code yet")
        taker = Taker(stream.code)
        self._takers.append(taker)
        self._let_go()
        return Subscription(self, stream, taker)

    def leave(self, taker: Taker) -> None:
        """Ends a subscription."""
        if taker in self._takers:
            self._takers.remove(taker)

    async def next_of(self, taker: Taker) -> StreamFrame:
        """Returns the next frame of a subscription. Raises `DataError`."""
        while not taker.waiting:
            if isinstance(self.state, Closed) or taker not in self._takers:
                raise DataClosedError(self.state.why if isinstance(self.state, Closed) else Loss(LossKind.HERE))
            await self._wait()
        taken = taker.waiting.popleft()
        if isinstance(taken, DataError):
            raise taken
        return taken

    async def send_stream(self, stream: Stream[B], message_id: int, content: B) -> None:
        """Sends a frame of an app's stream, as `send` does."""
        if stream.code is None:
            raise ValueError(f"{stream.name} has no code yet")
        try:
            data = write_content(stream.body, content)
        except BodyError as error:
            raise DataInvalidError(error) from None
        await self.send(stream.code, message_id, data)

    async def send(self, code: int, message_id: int, data: bytes) -> None:
        """Sends a frame of raw bytes, and returns when the socket has taken it. Raises `DataError`.

        Waits for a connection up to the call timeout. After `DataLostError`, this frame or one sent before may not have
        arrived. After `DataNotConnectedError`, `DataClosedError` and `DataFrameError`, nothing was sent. A frame that
        has begun is finished even if this call is cancelled.
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
            # The fate of the frame is known once the driver has noted the end.
            while self._link is link and not self.life.is_closed:
                await self._wait()
            known, self._unsure = self._unsure, None
            state = self.state
            raise DataLostError(known or (state.why if not isinstance(state, Connected) else Loss(LossKind.BROKEN)))

    async def __aenter__(self) -> DataConnection:
        """Waits until there is a connection."""
        await self.connected()
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Closes the connection."""
        self.close()


class Subscription(Generic[B]):
    """The decoded frames of one stream until the connection ends, for `async for`.

    It has a queue of four frames. When that is full, the newest frame replaces the oldest, and `missed` counts it. It
    continues after reconnecting. To end it, call `close()` or use `async with`.
    """

    def __init__(self, data: DataConnection, stream: Stream[B], taker: Taker) -> None:
        """Made by `DataConnection.subscribe`."""
        self._data: Final = data
        self._stream: Final = stream
        self._taker: Final = taker

    @property
    def missed(self) -> int:
        """Number of frames replaced by later ones so far."""
        return self._taker.missed

    async def recv(self) -> StreamItem[B]:
        """Returns the next frame. Raises `DataError`. After any error except `DataClosedError`, the next call
        continues.
        """
        frame = await self._data.next_of(self._taker)
        body: Any = self._stream.body
        if body is bytes:
            return StreamItem(frame.id, frame.data)  # type: ignore[arg-type]
        try:
            return StreamItem(frame.id, body.from_json(frame.data))
        except BodyError as error:
            raise DataInvalidError(error) from None

    def close(self) -> None:
        """Ends receiving."""
        self._data.leave(self._taker)

    def __aiter__(self) -> Subscription[B]:
        """Returns itself."""
        return self

    async def __anext__(self) -> StreamItem[B]:
        """Returns the next frame."""
        try:
            return await self.recv()
        except DataClosedError:
            raise StopAsyncIteration from None

    async def __aenter__(self) -> Subscription[B]:
        """Returns itself."""
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Ends receiving."""
        self.close()


class Streams:
    """The streams of the data port: subscribe to the robot's, send the app's."""

    def __init__(self, data: DataConnection) -> None:
        """Creates the streams of a data connection; see `Client.data`."""
        self.data: Final = data
        """The data connection: its state, and frames without a subscription."""
