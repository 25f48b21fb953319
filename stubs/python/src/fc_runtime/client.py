"""The base of a generated client, which adds one method per command."""

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
    """The base of clients for calls only. Its subclasses have one method per command."""

    def __init__(self, connection: Connection) -> None:
        """Creates a client over an existing connection; see `Client.connect` and `Client.connect_lazy`."""
        self.connection: Final = connection
        """The underlying connection, for raw commands."""

    def _followable(
        self,
        command: Command[Message, R],
        *reports: Report[P],
        request: Message | None,
        timeout: float | None,
        repeat: bool | None,
    ) -> Followable[R, P]:
        """Calls a command that sets off these reports."""
        assert {one.name for one in reports} == {one.report.name for one in command.sets_off}
        return Followable(self.connection, command, request, timeout, repeat)


class Client(Calls, Generic[A]):
    """A robot as seen from the app. Its subclasses have one method per command; `A` is any of their reports."""

    protocol: ClassVar[Protocol]
    """The protocol that it speaks."""

    @classmethod
    def connect(cls: type[C], config: ClientConfig | None = None) -> Connect[C]:
        """Connects to a robot. Settings absent from `config` have the spec's defaults.

        `client = await Client.connect(…)`, or `async with Client.connect(…) as client:`. Raises `ConnectError`.
        """
        return Connect(cls, config)

    @classmethod
    def connect_lazy(cls: type[C], config: ClientConfig | None = None) -> C:
        """Connects in the background. Calls made meanwhile wait for the connection within their timeout."""
        connection = Connection(cls.protocol, config)
        connection.connect_lazy()
        return cls(connection)

    @property
    def state(self) -> ConnectionState:
        """The present state of the connection, with the reason if there is none."""
        return self.connection.state

    @property
    def counters(self) -> ClientCounters:
        """Counters since the client was made."""
        return self.connection.counters

    def states(self) -> AsyncIterator[ConnectionState]:
        """Yields the present state of the connection, then each change; `Closed` is the last."""
        return self.connection.states()

    async def closed(self) -> Loss:
        """Waits until the connection has ended for good. Returns the reason."""
        return await self.connection.closed()

    def close(self) -> None:
        """Closes the connection for good. Calls in flight end as lost."""
        self.connection.close()

    def reports(self) -> Reports[A]:
        """All reports received from now on. Each receiver has a separate queue and gets all of them.

        Without a receiver, reports are not acknowledged.
        """
        return Reports(self.connection)

    def data(self) -> DataConnection:
        """Makes a connection to the data port in the background, and again after a loss. It ends with this one."""
        return DataConnection(self.connection)

    async def __aenter__(self: C) -> C:
        """Returns itself."""
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Closes the connection for good."""
        self.close()
        await self.connection.gone()


class Connect(Work[C], Generic[C]):
    """A client being connected: a coroutine that also works with `async with`."""

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
        """Connects."""
        self._client = await self
        return self._client

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Closes the connection for good."""
        if self._client is not None:
            self._client.close()
            await self._client.connection.gone()


class Reports(Generic[A]):
    """Reports in their order of arrival, for `async for`.

    A report is acknowledged when at least one receiver has it in its queue. An invalid report is refused, counted in
    `reports_invalid`, and not delivered. To end receiving, call `close()` or use `async with`.
    """

    def __init__(self, connection: Connection) -> None:
        """Creates a receiver for the reports from now on."""
        self._connection: Final = connection
        self._receiver: Final[Receiver] = connection.receiver()

    @property
    def missed(self) -> int:
        """Number of reports missed so far: this queue was full while another receiver took them."""
        return self._receiver.missed

    async def recv(self) -> A | None:
        """Returns the next report with the type of its code, a `RawReport` for an unknown code, or `None` after the
        end.
        """
        while (event := await self._receiver.next()) is not None:
            if isinstance(event, RawReport):
                known = self._connection.protocol.reports_by_code.get(event.code)
                report: Any = event if known is None else self._connection.read_report(event, known.request)
                return report  # type: ignore[no-any-return]
        return None

    def close(self) -> None:
        """Ends receiving."""
        self._connection.leave(self._receiver)

    def __aiter__(self) -> Reports[A]:
        """Returns itself."""
        return self

    async def __anext__(self) -> A:
        """Returns the next report."""
        report = await self.recv()
        if report is None:
            raise StopAsyncIteration
        return report

    async def __aenter__(self) -> Reports[A]:
        """Returns itself."""
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Ends receiving."""
        self.close()
