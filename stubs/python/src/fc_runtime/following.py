"""Follows a command to its end: the response, then the reports that it set off."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar, Final, Generic, TypeAlias, TypeVar, overload

from .calls import Loss, LossKind
from .errors import BodyError
from .message import is_in_order
from .receivers import Interrupted, Missed, Resumed
from .states import Closed
from .work import Work

if TYPE_CHECKING:
    from types import TracebackType

    from .connection import Connection
    from .message import Message
    from .operations import Command, Report, SetsOff
    from .receivers import RawReport, Receiver

R = TypeVar("R", bound="Message")
P = TypeVar("P", bound="Message")
S = TypeVar("S", bound="Message")


@dataclass(frozen=True, slots=True)
class Going(Generic[P]):
    """The process goes on."""

    report: P
    """The report."""


@dataclass(frozen=True, slots=True)
class Ended(Generic[P]):
    """The process has ended with a final state. The last event."""

    report: P
    """The report."""


@dataclass(frozen=True, slots=True)
class Failed(Generic[P]):
    """The report means a failure. The last event."""

    report: P
    """The report."""


Followed: TypeAlias = "Going[P] | Ended[P] | Failed[P] | Missed | Interrupted | Resumed"
"""An event of a process that is being followed."""


class FollowError(Exception):
    """The error that ends following a process, although the process may go on."""

    name: ClassVar[str] = ""
    """Name of the error, the same in every language."""


class FollowClosedError(FollowError):
    """The connection is closed for good."""

    name: ClassVar[str] = "closed"

    def __init__(self, loss: Loss) -> None:
        """Creates the error with the reason."""
        super().__init__(f"the connection is closed: {loss}; the process may go on")
        self.loss: Final = loss
        """The reason for having no connection."""


class FollowInvalidError(FollowError):
    """A report does not fit its type: the peer uses a protocol with other types."""

    name: ClassVar[str] = "invalid_report"

    def __init__(self, error: BodyError) -> None:
        """Creates the error from the error in the report."""
        super().__init__(f"the report is invalid: {error}")
        self.error: Final = error
        """The error in the report."""


class Following(Generic[R, P]):
    """The response to a command, and the reports that it sets off, for `async for`.

    It ends after `Ended` and `Failed`. If the spec declares no final states and no failures, it continues until it is
    closed. To limit the wait for a report, use `asyncio.wait_for(following.recv(), …)`, for example.

    It has a separate queue for reports of this code, and they are acknowledged once queued. To end it, call `close()`
    or use `async with`. If no fields tie a report to a call, it gets every report of that code.
    """

    def __init__(
        self, connection: Connection, sets_off: SetsOff, receiver: Receiver, request: Message, answer: R
    ) -> None:
        """Made by `Followable`."""
        self._connection: Final = connection
        self._sets_off: Final = sets_off
        self._receiver: Final = receiver
        self._request: Final = request
        self._last: Any = None
        self._is_over = False
        self.answer: Final[R] = answer
        """The robot's response to the command."""

    async def recv(self) -> Followed[P] | None:
        """Returns the next event; `None` after the end. Raises `FollowError`.

        The call may be cancelled: a report is taken from the queue only when it is returned.
        """
        while not self._is_over:
            event = await self._receiver.next()
            if event is None:
                state = self._connection.state
                self.close()
                raise FollowClosedError(state.why if isinstance(state, Closed) else Loss(LossKind.ENDED))
            if isinstance(event, (Missed, Interrupted, Resumed)):
                return event
            placed = self._place(event)
            if placed is not None:
                return placed
        return None

    def _place(self, raw: RawReport) -> Followed[P] | None:
        """Returns the event for a report; `None` if it belongs to another process."""
        described: Report[Any] = self._sets_off.report
        try:
            report: Any = self._connection.read_report(raw, described.request)
        except BodyError as error:
            self.close()
            raise FollowInvalidError(error) from None
        if not self._sets_off.has_set_off(self._request, self.answer, report):
            return None
        state = described.state_of(report)
        if state is not None and self._last is not None and not is_in_order(state, self._last):
            self._connection.out_of_order(described.name)
        self._last = self._last if state is None else state
        if described.is_failure(report):
            self.close()
            return Failed(report)
        if getattr(state, "is_final", False):
            self.close()
            return Ended(report)
        return Going(report)

    def close(self) -> None:
        """Ends following."""
        self._is_over = True
        self._connection.leave(self._receiver)

    def __aiter__(self) -> Following[R, P]:
        """Returns itself."""
        return self

    async def __anext__(self) -> Followed[P]:
        """Returns the next event."""
        event = await self.recv()
        if event is None:
            raise StopAsyncIteration
        return event

    async def __aenter__(self) -> Following[R, P]:
        """Returns itself."""
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Ends following."""
        self.close()


class Follow(Work["Following[R, P]"], Generic[R, P]):
    """A command to be followed: a coroutine that also works with `async with`.

    It calls the command and waits for its response. Raises `CallError`, without following.
    """

    def __init__(self, call: Followable[R, Any], sets_off: SetsOff) -> None:
        """Made by `Followable.follow`."""
        self._call: Final = call
        self._sets_off: Final = sets_off
        self._following: Following[R, P] | None = None
        super().__init__(self._start(), f"{call.command.method_name}.follow")

    async def _start(self) -> Following[R, P]:
        call = self._call
        code = self._sets_off.report.code
        if code is None:
            raise ValueError(f"{self._sets_off.report.name} has no code yet")
        request = call.connection.asked(call.command, call.request)
        # Receives from the moment the request is sent, also before the response.
        receiver = call.connection.receiver(frozenset({code}))
        try:
            answer = await call.connection.call(call.command, request, timeout=call.timeout, repeat=call.repeat)
        except BaseException:
            call.connection.leave(receiver)
            raise
        return Following(call.connection, self._sets_off, receiver, request, answer)

    async def __aenter__(self) -> Following[R, P]:
        """Calls the command and waits for its response."""
        self._following = await self
        return self._following

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Ends following."""
        if self._following is not None:
            self._following.close()


class Followable(Work[R], Generic[R, P]):
    """A call of a command that sets off reports. Await it for the response, or `follow()` it to its end.

    The request is sent only then.
    """

    def __init__(
        self,
        connection: Connection,
        command: Command[Message, R],
        request: Message | None,
        timeout: float | None,
        repeat: bool | None,
    ) -> None:
        """Made by a client's method."""
        self.connection: Final = connection
        self.command: Final = command
        self.request: Final = request
        self.timeout: Final = timeout
        self.repeat: Final = repeat
        call = connection.call(command, request, timeout=timeout, repeat=repeat)
        super().__init__(call, command.method_name)

    @overload
    def follow(self) -> Follow[R, P]: ...

    @overload
    def follow(self, report: Report[S]) -> Follow[R, S]: ...

    def follow(self, report: Report[Any] | None = None) -> Follow[R, Any]:
        """Follows the reports that it sets off. `report` selects one if there is more than one kind."""
        if self.is_begun:
            raise RuntimeError(f"{self.command.name} has been called already: follow another call")
        sets_off = [one for one in self.command.sets_off if report is None or one.report is report]
        if len(sets_off) != 1:
            names = ", ".join(one.report.name for one in self.command.sets_off)
            raise ValueError(f"{self.command.name} sets off {names or 'nothing'}: say which of them to follow")
        self.close()
        return Follow(self, sets_off[0])
