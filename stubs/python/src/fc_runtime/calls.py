"""What can go wrong with connecting and with calls, and why there is no connection."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING, ClassVar, Final, TypeVar

if TYPE_CHECKING:
    from .errors import BodyError, FrameError
    from .results import Result

E = TypeVar("E", bound="Result")


class LossKind(str, Enum):
    """Why there is no connection."""

    NOT_YET = "not_yet"
    """The first connection is still being made."""
    CLOSED = "closed_by_robot"
    """The robot has closed the connection."""
    UNHEARD = "closed_unheard"
    """The robot has closed the connection before it sent anything."""
    BROKEN = "broken"
    """The network broke the connection."""
    FRAME = "frame"
    """The robot's bytes are no frames."""
    STALLED = "stalled"
    """A frame began and did not go on."""
    UNREAD = "unread"
    """The robot does not read."""
    UNREACHABLE = "unreachable"
    """No new connection."""
    CONNECT_TIMEOUT = "connect_timeout"
    """No new connection in time."""
    RENEWED = "renewed"
    """The command connection was made again, and the data connection with it."""
    HERE = "closed_here"
    """The connection was closed by this side."""
    ENDED = "ended"
    """The event loop of the connection has ended."""


@dataclass(frozen=True, slots=True)
class Loss:
    """Why there is no connection, and what is known of it."""

    kind: LossKind
    """Why."""
    detail: str = ""
    """What is known of it."""

    @property
    def name(self) -> str:
        """The kind's name, or that of the frame's error."""
        return self.detail.partition(":")[0] if self.kind is LossKind.FRAME else self.kind.value

    def __str__(self) -> str:
        """The name and the detail."""
        return f"{self.kind.value}: {self.detail}" if self.detail else self.kind.value


class ConnectError(OSError):
    """A first connection that could not be made."""

    def __init__(self, address: str, loss: Loss) -> None:
        """Says to where, and why not."""
        super().__init__(f"cannot connect to {address}: {loss}")
        self.loss: Final = loss
        """Why not."""


class Refusal(Exception):
    """A result other than success. A handler raises it; of a call it is the `refusal` of `RefusedError`."""

    def __init__(self, code: int, text: str) -> None:
        """With a result code, and a text for people."""
        super().__init__(f"refused with result {code}: {text}")
        self.code: Final = code
        """The result code."""
        self.text: Final = text
        """The text beside it. Never rely on it."""

    def declared(self, errors: type[E]) -> E | None:
        """Which of the errors that a command declares it is; `None` if none of them."""
        return errors.of(self.code)


class CallError(Exception):
    """A call that has failed."""

    name: ClassVar[str] = ""
    """Its name, the same in every language."""

    @property
    def loss(self) -> Loss | None:
        """Why there was no connection (any more), if that is what ended the call."""
        return None

    def declared(self, errors: type[E]) -> E | None:
        """Which of the errors that the command declares the robot has answered with; `None` for anything else."""
        return self.refusal.declared(errors) if isinstance(self, RefusedError) else None


class RefusedError(CallError):
    """The robot answered with a result other than success."""

    name: ClassVar[str] = "refused"

    def __init__(self, refusal: Refusal) -> None:
        """With what the robot has answered."""
        super().__init__(str(refusal))
        self.refusal: Final = refusal
        """What the robot has answered."""


class CallTimeoutError(CallError, TimeoutError):
    """No response in time over a connection that is still there; the robot may have acted."""

    name: ClassVar[str] = "timeout"

    def __init__(self) -> None:
        """Says so."""
        super().__init__("no response in time; the robot may have acted")


class _LossError(CallError):
    """A call that has failed because there was no connection."""

    _text: ClassVar[str] = ""

    def __init__(self, loss: Loss) -> None:
        """With the reason."""
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
        """Says so."""
        super().__init__("too many calls are in flight; wait for one, or raise `in_flight`")


class InvalidRequestError(CallError):
    """The request breaks one of its own constraints; nothing was sent."""

    name: ClassVar[str] = "invalid_request"

    def __init__(self, error: BodyError) -> None:
        """With what is wrong."""
        super().__init__(f"the request is invalid: {error}")
        self.error: Final = error
        """What is wrong."""


class InvalidResponseError(CallError):
    """The answer is not a response to this command."""

    name: ClassVar[str] = "invalid_response"

    def __init__(self, error: BodyError) -> None:
        """With what is wrong."""
        super().__init__(f"the response is invalid: {error}")
        self.error: Final = error
        """What is wrong."""


class FrameCallError(CallError):
    """The request does not fit into a frame, or the answer came in a broken one."""

    name: ClassVar[str] = "frame"

    def __init__(self, error: FrameError) -> None:
        """With what is wrong."""
        super().__init__(str(error))
        self.error: Final = error
        """What is wrong."""


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
