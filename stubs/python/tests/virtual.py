"""An event loop whose clock jumps to the next timer when there is no activity, and a peer that speaks in frames."""

from __future__ import annotations

import asyncio
import functools
import gc
import selectors
import time
import warnings
from dataclasses import replace
from typing import TYPE_CHECKING, Any, ClassVar

import fc_runtime as rt
import sample

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable

# Seconds without activity before the clock jumps.
_QUIET = 0.005
# Seconds of that clock after which a waiting test fails.
_PATIENCE = 5_000.0
# The same in real seconds.
_REAL_PATIENCE = 60.0


class _Selector(selectors.DefaultSelector):
    skipped = 0.0

    def select(self, timeout: float | None = None) -> Any:
        if timeout is None or timeout <= 0:
            return super().select(timeout)
        found = super().select(min(timeout, _QUIET))
        if not found:
            self.skipped += timeout
        return found


class Loop(asyncio.SelectorEventLoop):
    """An event loop whose timers cost no time."""

    def __init__(self) -> None:
        self._jumping = _Selector()
        super().__init__(self._jumping)

    def time(self) -> float:
        return super().time() + self._jumping.skipped


def clocked(test: Callable[[Any], Awaitable[None]]) -> Callable[[Any], None]:
    """Runs a test on such a loop."""

    @functools.wraps(test)
    def run(case: Any) -> None:
        loop = Loop()
        try:
            loop.run_until_complete(asyncio.wait_for(test(case), _PATIENCE))
        finally:
            for raw in Raw.made:
                raw.writer.transport.abort()
            Raw.made.clear()
            left = asyncio.all_tasks(loop)
            for task in left:
                task.cancel()
            if left:
                loop.run_until_complete(asyncio.wait(left))
            loop.run_until_complete(asyncio.sleep(0.1))
            loop.close()
            with warnings.catch_warnings():
                # Resources that the other side of a test left open do not matter.
                warnings.simplefilter("ignore", ResourceWarning)
                gc.collect()

    return run


class Raw:
    """One side of a connection, frame by frame."""

    made: ClassVar[list[Raw]] = []

    def __init__(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        self.made.append(self)
        self.reader, self.writer = reader, writer
        self.decoder = rt.Decoder(sample.SAMPLE)
        self.encoder = rt.Encoder(sample.SAMPLE)

    @classmethod
    async def connect(cls, address: tuple[str, int]) -> Raw:
        return cls(*await asyncio.open_connection(*address))

    def frame(self, code: int, body: bytes, message_id: int = 1, kind: int = 1, *, response: bool = False) -> bytes:
        return self.encoder.encode(rt.FrameId(response, kind, code, message_id), body)

    def send(self, code: int, body: bytes, message_id: int = 1, kind: int = 1, *, response: bool = False) -> None:
        self.writer.write(self.frame(code, body, message_id, kind, response=response))

    def answer(self, frame: rt.Frame, body: bytes = b'{"resultCode":1001}') -> None:
        self.writer.write(self.encoder.encode(frame.id.answer(), body))

    async def next(self) -> rt.Frame | None:
        """Returns the next frame; `None` at the end."""
        while (frame := self.decoder.next()) is None:
            try:
                data = await self.reader.read(65536)
            except ConnectionError:
                return None
            if not data:
                return None
            self.decoder.push(data)
        return frame

    async def frames(self, count: int) -> list[rt.Frame]:
        found = [await self.next() for _ in range(count)]
        return [one for one in found if one is not None]

    async def is_closed(self) -> bool:
        """Waits for the other side to end the connection. Returns `False` if a frame comes instead."""
        return await self.next() is None

    def close(self) -> None:
        self.writer.close()


class Listener:
    """A robot that the test controls: accepts connections, and speaks in frames."""

    def __init__(self) -> None:
        self.accepted: asyncio.Queue[Raw] = asyncio.Queue()

    async def listen(self, port: int = 0) -> int:
        self.server = await asyncio.start_server(self._take, "127.0.0.1", port)
        found: int = self.server.sockets[0].getsockname()[1]
        return found

    async def _take(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        self.accepted.put_nowait(Raw(reader, writer))

    async def accept(self) -> Raw:
        return await self.accepted.get()

    def close(self) -> None:
        self.server.close()


async def serve(robot: rt.Robot, **config: Any) -> rt.Server:
    """Returns a robot on free ports."""
    server = rt.Server(robot, rt.ServerConfig(**{"address": "127.0.0.1", "command_port": 0, "data_port": 0, **config}))
    await server.bind()
    return server


def limits(**changed: Any) -> rt.Limits:
    """Returns the limits of the sample with these changes."""
    return replace(sample.SAMPLE.defaults.limits, **changed)


async def until(condition: Callable[[], bool]) -> None:
    """Yields until this holds. No other task may wait meanwhile, or the clock stops."""
    since = time.monotonic()
    while not condition():
        await asyncio.sleep(0)
        if time.monotonic() - since > _REAL_PATIENCE:
            raise AssertionError("it has not come to that")
