"""What the client of a protocol stands on: it has one method per command, and everything else from here."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar, Final, Generic, TypeVar

from .connection import Connection
from .data import DataConnection
from .following import Followable
from .receivers import RawReport
from .work import Work

if TYPE_CHECKING:
    from collections.abc import AsyncIterator
    from types import TracebackType

    from .calls import Loss
    from .config import ClientConfig
    from .message import Message
    from .operations import Command, Report
    from .protocol import Protocol
    from .receivers import Receiver
    from .states import ClientCounters, ConnectionState

A = TypeVar("A", covariant=True)
C = TypeVar("C", bound="Client[Any]")
R = TypeVar("R", bound="Message")
P = TypeVar("P", bound="Message")


class Calls:
    """What calls go through: a client without its reports. Its subclasses have one method per command."""

    def __init__(self, connection: Connection) -> None:
        """Over a connection that there is; see `Client.connect` and `Client.connect_lazy`."""
        self.connection: Final = connection
        """The underlying connection: raw commands."""

    def _followable(
        self,
        command: Command[Message, R],
        *reports: Report[P],
        request: Message | None,
        timeout: float | None,
        repeat: bool | None,
    ) -> Followable[R, P]:
        """A call of a command that sets these reports off."""
        assert {one.name for one in reports} == {one.report.name for one in command.sets_off}
        return Followable(self.connection, command, request, timeout, repeat)


class Client(Calls, Generic[A]):
    """A robot as seen from the app. Its subclasses have one method per command; `A` is any of their reports."""

    protocol: ClassVar[Protocol]
    """The protocol that it speaks."""

    @classmethod
    def connect(cls: type[C], config: ClientConfig | None = None) -> Connect[C]:
        """Connect to a robot; what `config` does not set has the default of the spec.

        `client = await Client.connect(…)`, or `async with Client.connect(…) as client:`. Raises `ConnectError`.
        """
        return Connect(cls, config)

    @classmethod
    def connect_lazy(cls: type[C], config: ClientConfig | None = None) -> C:
        """Connect in the background; calls made meanwhile wait for the connection within their timeout."""
        connection = Connection(cls.protocol, config)
        connection.connect_lazy()
        return cls(connection)

    @property
    def state(self) -> ConnectionState:
        """Whether there is a connection at this moment, and why not."""
        return self.connection.state

    @property
    def counters(self) -> ClientCounters:
        """What has happened since the client was made."""
        return self.connection.counters

    def states(self) -> AsyncIterator[ConnectionState]:
        """The present state of the connection, and each that it comes to; nothing after `Closed`."""
        return self.connection.states()

    async def closed(self) -> Loss:
        """Wait until the connection has ended for good, and say why."""
        return await self.connection.closed()

    def close(self) -> None:
        """Close the connection for good; calls in flight end as lost."""
        self.connection.close()

    def reports(self) -> Reports[A]:
        """All reports received from now on. Each receiver gets all of them and has a queue of its own.

        While there is no receiver, no report is acknowledged.
        """
        return Reports(self.connection)

    def data(self) -> DataConnection:
        """A connection to the data port: made in the background, made again after a loss, as long as this one."""
        return DataConnection(self.connection)

    async def __aenter__(self: C) -> C:
        """Itself."""
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Close the connection for good."""
        self.close()
        await self.connection.gone()


class Connect(Work[C], Generic[C]):
    """A client on its way to being connected: a coroutine, that can also be entered with `async with`."""

    def __init__(self, cls: type[C], config: ClientConfig | None) -> None:
        """Made by `Client.connect`."""
        self._cls: Final = cls
        self._config: Final = config
        self._client: C | None = None
        super().__init__(self._start(), f"{cls.__name__}.connect")

    async def _start(self) -> C:
        connection = Connection(self._cls.protocol, self._config)
        await connection.connect()
        return self._cls(connection)

    async def __aenter__(self) -> C:
        """Connect."""
        self._client = await self
        return self._client

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Close the connection for good."""
        if self._client is not None:
            self._client.close()
            await self._client.connection.gone()


class Reports(Generic[A]):
    """Reports in the order in which they came; go through them with `async for`.

    Each is acknowledged when at least one receiver has it in its queue. A report that does not read as its type says is
    refused, counted as `reports_invalid`, and never comes out here. To receive no more, `close()` it or enter it with
    `async with`.
    """

    def __init__(self, connection: Connection) -> None:
        """Of a connection, from now on."""
        self._connection: Final = connection
        self._receiver: Final[Receiver] = connection.receiver()

    @property
    def missed(self) -> int:
        """How many it has missed so far, because its queue was full while another receiver took them."""
        return self._receiver.missed

    async def recv(self) -> A | None:
        """The next report, as the type of its code; `RawReport` where that is not known; `None` after the end."""
        while (event := await self._receiver.next()) is not None:
            if isinstance(event, RawReport):
                known = self._connection.protocol.reports_by_code.get(event.code)
                report: Any = event if known is None else self._connection.read_report(event, known.request)
                return report  # type: ignore[no-any-return]
        return None

    def close(self) -> None:
        """Receive no more."""
        self._connection.leave(self._receiver)

    def __aiter__(self) -> Reports[A]:
        """Itself."""
        return self

    async def __anext__(self) -> A:
        """The next report."""
        report = await self.recv()
        if report is None:
            raise StopAsyncIteration
        return report

    async def __aenter__(self) -> Reports[A]:
        """Itself."""
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Receive no more."""
        self.close()
