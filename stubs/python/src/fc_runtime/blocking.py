"""The client without `async`, for tools and tests: each method blocks the calling thread.

Each connection runs the asyncio client in a separate thread with an event loop. Reports are acknowledged and a lost
connection is made again even while no method runs.
"""

from __future__ import annotations

import asyncio
import threading
from typing import TYPE_CHECKING, Any, ClassVar, Final, Generic, TypeVar

from . import client as client_module
from .calls import ClosedError, Loss, LossKind
from .connection import Connection
from .following import Followable, Followed, Following
from .within import within

if TYPE_CHECKING:
    from collections.abc import Coroutine, Iterator
    from types import TracebackType

    from .config import ClientConfig
    from .message import Message
    from .operations import Command, Report
    from .protocol import Protocol
    from .states import ClientCounters, ConnectionState

A = TypeVar("A", covariant=True)
C = TypeVar("C", bound="SyncClient[Any]")
Q = TypeVar("Q", bound="Message")
R = TypeVar("R", bound="Message")
P = TypeVar("P", bound="Message")
T = TypeVar("T")


class _Thread:
    """A thread with an event loop."""

    def __init__(self, name: str) -> None:
        self.loop: Final = asyncio.new_event_loop()
        self._thread: Final = threading.Thread(target=self._run, name=name, daemon=True)
        self._thread.start()

    def _run(self) -> None:
        asyncio.set_event_loop(self.loop)
        try:
            self.loop.run_forever()
            left = asyncio.all_tasks(self.loop)
            for task in left:
                task.cancel()
            self.loop.run_until_complete(asyncio.gather(*left, return_exceptions=True))
        finally:
            self.loop.close()

    def wait(self, work: Coroutine[Any, Any, T]) -> T:
        """Runs work on the thread and waits for it. Ctrl-C cancels it."""
        if threading.current_thread() is self._thread or self.loop.is_closed():
            work.close()
            if self.loop.is_closed():
                raise ClosedError(Loss(LossKind.HERE))
            raise RuntimeError("this waits for the thread that it is called from: use the asyncio client there")
        future = asyncio.run_coroutine_threadsafe(work, self.loop)
        try:
            return future.result()
        except BaseException:
            future.cancel()
            raise

    def end(self) -> None:
        """Ends the thread."""
        self.loop.call_soon_threadsafe(self.loop.stop)
        self._thread.join()


class SyncCalls:
    """The base of clients for calls only. Its subclasses have one method per command."""

    protocol: ClassVar[Protocol]
    """The protocol that it speaks."""

    def __init__(self, config: ClientConfig | None = None) -> None:
        """Connects to a robot. Settings absent from `config` have the spec's defaults. Raises `ConnectError`."""
        self._thread: Final = _Thread(f"{self.protocol.name} client")
        try:
            self.connection: Final[Connection] = self._thread.wait(self._connect(config))
        except BaseException:
            self._thread.end()
            raise

    async def _connect(self, config: ClientConfig | None) -> Connection:
        connection = Connection(self.protocol, config)
        await connection.connect()
        return connection

    def wait(self, work: Coroutine[Any, Any, T]) -> T:
        """Waits for work that only has `async` methods, such as `connection.closed()` and the data port."""
        return self._thread.wait(work)

    def _call(self, command: Command[Q, R], request: Message | None, timeout: float | None, repeat: bool | None) -> R:
        return self._thread.wait(self.connection.call(command, request, timeout=timeout, repeat=repeat))

    def _follow(
        self,
        command: Command[Message, R],
        report: Report[P],
        request: Message | None,
        timeout: float | None,
        repeat: bool | None,
    ) -> SyncFollowing[R, P]:
        async def follow() -> Following[R, P]:
            followable: Followable[R, P] = Followable(self.connection, command, request, timeout, repeat)
            return await followable.follow(report)

        return SyncFollowing(self, self._thread.wait(follow()))


class SyncClient(SyncCalls, Generic[A]):
    """A robot as seen from the app. Its subclasses have one method per command; `A` is any of their reports."""

    @classmethod
    def connect(cls: type[C], config: ClientConfig | None = None) -> C:
        """Connects to a robot. Settings absent from `config` have the spec's defaults. Raises `ConnectError`."""
        return cls(config)

    @property
    def state(self) -> ConnectionState:
        """The present state of the connection, with the reason if there is none."""
        return self.connection.state

    @property
    def counters(self) -> ClientCounters:
        """Counters since the client was made."""
        return self.connection.counters

    def closed(self, timeout: float | None = None) -> Loss:
        """Wait until the connection has ended for good, and return the cause. Raises `TimeoutError`."""
        return self.wait(_within(self.connection.closed(), timeout))

    def reports(self) -> SyncReports[A]:
        """All reports received from now on. Without a receiver, reports are not acknowledged."""
        return SyncReports(self)

    def close(self) -> None:
        """Closes the connection for good, and ends its thread. Calls in flight end as lost."""
        if not self._thread.loop.is_closed():
            self._thread.wait(self._close())
            self._thread.end()

    async def _close(self) -> None:
        self.connection.close()
        # Waiting tasks get the loss before the thread ends.
        await self.connection.gone()

    def __enter__(self: C) -> C:
        """Returns itself."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Closes the connection for good."""
        self.close()


class SyncReports(Generic[A]):
    """Reports in their order of arrival, for a `for` loop."""

    def __init__(self, client: SyncCalls) -> None:
        """Creates a receiver for the reports from now on."""
        self._client: Final = client
        self._reports: Final[client_module.Reports[A]] = client.wait(self._open())

    async def _open(self) -> client_module.Reports[A]:
        return client_module.Reports(self._client.connection)

    @property
    def missed(self) -> int:
        """Number of reports missed so far: this queue was full while another receiver took them."""
        return self._reports.missed

    def recv(self, timeout: float | None = None) -> A | None:
        """Returns the next report; `None` after the end. Raises `TimeoutError` if none comes within the timeout."""
        return self._client.wait(_within(self._reports.recv(), timeout))

    def close(self) -> None:
        """Ends receiving."""
        self._client.wait(self._close())

    async def _close(self) -> None:
        self._reports.close()

    def __iter__(self) -> Iterator[A]:
        """Yields the reports until the connection ends."""
        while (report := self.recv()) is not None:
            yield report

    def __enter__(self) -> SyncReports[A]:
        """Returns itself."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Ends receiving."""
        self.close()


class SyncFollowing(Generic[R, P]):
    """The response to a command and the reports that it sets off, for a `for` loop."""

    def __init__(self, client: SyncCalls, following: Following[R, P]) -> None:
        """Made by a client's method."""
        self._client: Final = client
        self._following: Final = following

    @property
    def answer(self) -> R:
        """The robot's response to the command."""
        return self._following.answer

    def recv(self, timeout: float | None = None) -> Followed[P] | None:
        """Returns the next event; `None` after the end. Raises `FollowError`; `TimeoutError` if none comes in time."""
        return self._client.wait(_within(self._following.recv(), timeout))

    def close(self) -> None:
        """Ends following."""
        self._client.wait(self._close())

    async def _close(self) -> None:
        self._following.close()

    def __iter__(self) -> Iterator[Followed[P]]:
        """Yields the events to the end."""
        while (event := self.recv()) is not None:
            yield event

    def __enter__(self) -> SyncFollowing[R, P]:
        """Returns itself."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Ends following."""
        self.close()


async def _within(work: Coroutine[Any, Any, T], timeout: float | None) -> T:
    # `asyncio` has a separate class before Python 3.11.
    try:
        return await within(timeout, work)
    except asyncio.TimeoutError:
        raise TimeoutError("nothing has come in time") from None
