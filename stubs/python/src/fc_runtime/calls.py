"""Errors of connecting and of calls, and reasons for having no connection."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING, ClassVar, Final, TypeVar

if TYPE_CHECKING:
    from .errors import BodyError, FrameError
    from .results import Result

E = TypeVar("E", bound="Result")


class LossKind(str, Enum):
    """Reasons for having no connection."""

    NOT_YET = "not_yet"
    """The first connection is still being made."""
    CLOSED = "closed_by_robot"
    """The robot closed the connection."""
    UNHEARD = "closed_unheard"
    """The robot closed the connection before it sent anything."""
    BROKEN = "broken"
    """The network broke the connection."""
    FRAME = "frame"
    """The robot's bytes cannot be split into frames."""
    STALLED = "stalled"
    """A frame began and did not continue."""
    UNREAD = "unread"
    """The robot does not read."""
    UNREACHABLE = "unreachable"
    """The network refused a new connection."""
    CONNECT_TIMEOUT = "connect_timeout"
    """No new connection in time."""
    RENEWED = "renewed"
    """The command connection was made again, so the data connection is made again as well."""
    HERE = "closed_here"
    """This side closed the connection."""
    ENDED = "ended"
    """The event loop of the connection has ended."""


@dataclass(frozen=True, slots=True)
class Loss:
    """The reason for having no connection, with details."""

    kind: LossKind
    """The reason."""
    detail: str = ""
    """Details, or an empty text."""

    @property
    def name(self) -> str:
        """The kind's name, or that of the frame's error."""
        return self.detail.partition(":")[0] if self.kind is LossKind.FRAME else self.kind.value

    def __str__(self) -> str:
        """The name and the detail."""
        return f"{self.kind.value}: {self.detail}" if self.detail else self.kind.value


class ConnectError(OSError):
    """The error of a first connection that could not be made."""

    def __init__(self, address: str, loss: Loss) -> None:
        """Creates the error for an address, with the reason."""
        super().__init__(f"cannot connect to {address}: {loss}")
        self.loss: Final = loss
        """The reason."""


class Refusal(Exception):
    """A result other than success. A handler raises it. For a call, it is the `refusal` of `RefusedError`."""

    def __init__(self, code: int, text: str) -> None:
        """Creates a refusal with a result code, and a text for people."""
        super().__init__(f"refused with result {code}: {text}")
        self.code: Final = code
        """The result code."""
        self.text: Final = text
        """The text of the result. Never rely on it."""

    def declared(self, errors: type[E]) -> E | None:
        """Returns the command's declared error with this code; `None` if it declares none."""
        return errors.of(self.code)


class CallError(Exception):
    """The error of a failed call."""

    name: ClassVar[str] = ""
    """Name of the error, the same in every language."""

    @property
    def loss(self) -> Loss | None:
        """Why there was no connection; `None` for other errors."""
        return None

    def declared(self, errors: type[E]) -> E | None:
        """Returns the command's declared error that the robot responded with; `None` for any other."""
        return self.refusal.declared(errors) if isinstance(self, RefusedError) else None


class RefusedError(CallError):
    """The robot responded with a result other than success."""

    name: ClassVar[str] = "refused"

    def __init__(self, refusal: Refusal) -> None:
        """Creates the error from the robot's refusal."""
        super().__init__(str(refusal))
        self.refusal: Final = refusal
        """The robot's refusal."""


class CallTimeoutError(CallError, TimeoutError):
    """No response in time over a working connection; the robot may have acted."""

    name: ClassVar[str] = "timeout"

    def __init__(self) -> None:
        """Creates the error."""
        super().__init__("no response in time; the robot may have acted")


class _LossError(CallError):
    """The error of a call that failed for lack of a connection."""

    _text: ClassVar[str] = ""

    def __init__(self, loss: Loss) -> None:
        """Creates the error with the reason."""
        super().__init__(f"{self._text}: {loss}")
        self._loss: Final = loss

    @property
    def loss(self) -> Loss:
        """Why there is no connection."""
        return self._loss


class NotConnectedError(_LossError):
    """No connection in time; nothing was sent."""

    name: ClassVar[str] = "not_connected"
    _text: ClassVar[str] = "not sent, for there was no connection in time"


class ClosedError(_LossError):
    """The connection is over; nothing was sent."""

    name: ClassVar[str] = "closed"
    _text: ClassVar[str] = "not sent, for the connection is closed"


class LostError(_LossError):
    """The connection was lost before the response arrived; the robot may have acted."""

    name: ClassVar[str] = "lost"
    _text: ClassVar[str] = "the connection was lost before the response arrived; query the robot's state"


class BusyError(CallError):
    """Too many calls are in flight; nothing was sent."""

    name: ClassVar[str] = "busy"

    def __init__(self) -> None:
        """Creates the error."""
        super().__init__("too many calls are in flight; wait for one, or raise `in_flight`")


class InvalidRequestError(CallError):
    """The request breaks a constraint; nothing was sent."""

    name: ClassVar[str] = "invalid_request"

    def __init__(self, error: BodyError) -> None:
        """Creates the error from the error in the request."""
        super().__init__(f"the request is invalid: {error}")
        self.error: Final = error
        """The error in the request."""


class InvalidResponseError(CallError):
    """The answer is not a response to this command."""

    name: ClassVar[str] = "invalid_response"

    def __init__(self, error: BodyError) -> None:
        """Creates the error from the error in the response."""
        super().__init__(f"the response is invalid: {error}")
        self.error: Final = error
        """The error in the response."""


class FrameCallError(CallError):
    """The request does not fit into a frame, or the response came in an invalid one."""

    name: ClassVar[str] = "frame"

    def __init__(self, error: FrameError) -> None:
        """Creates the error from the frame's error."""
        super().__init__(str(error))
        self.error: Final = error
        """The error of the frame."""


CALL_ERRORS: Final[tuple[type[CallError], ...]] = (
    RefusedError,
    CallTimeoutError,
    NotConnectedError,
    ClosedError,
    LostError,
    BusyError,
    InvalidRequestError,
    InvalidResponseError,
    FrameCallError,
)
"""All kinds of errors of a call."""
