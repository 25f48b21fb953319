"""What can go wrong on a data connection."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from .calls import Loss, Refusal
    from .errors import BodyError, FrameError
    from .frame import FrameId


class DataError(Exception):
    """Why a frame of raw bytes could not be sent, or what came instead of one."""

    @property
    def name(self) -> str:
        """Its name, the same in every language."""
        return ""


class _DataLossError(DataError):
    def __init__(self, text: str, loss: Loss) -> None:
        super().__init__(f"{text}: {loss}")
        self.loss: Final = loss
        """Why there is no connection."""


class DataLostError(_DataLossError):
    """The connection was lost, and is being made again; what was on its way may be lost with it."""

    def __init__(self, loss: Loss) -> None:
        """With the reason."""
        super().__init__("the data connection was lost, and what was on its way may be lost with it", loss)

    @property
    def name(self) -> str:
        """Its name, the same in every language."""
        return "lost"


class DataNotConnectedError(_DataLossError):
    """No connection in time; the frame has not been sent."""

    def __init__(self, loss: Loss) -> None:
        """With the reason."""
        super().__init__("there was no data connection in time", loss)

    @property
    def name(self) -> str:
        """Its name, the same in every language."""
        return "not_connected"


class DataClosedError(_DataLossError):
    """The connection is closed for good; the frame has not been sent."""

    def __init__(self, loss: Loss) -> None:
        """With the reason."""
        super().__init__("the data connection is closed", loss)

    @property
    def name(self) -> str:
        """Its name, the same in every language."""
        return "closed"


class DataFrameError(DataError):
    """A frame could not be read and was skipped, or the one to be sent is too long. The connection stays open."""

    def __init__(self, error: FrameError) -> None:
        """With what is wrong."""
        super().__init__(str(error))
        self.error: Final = error
        """What is wrong."""

    @property
    def name(self) -> str:
        """That of what is wrong."""
        return self.error.name

    @property
    def code(self) -> int | None:
        """What the frame belongs to, if that is known."""
        return None if self.error.frame is None else self.error.frame.code


class DataRefusedError(DataError):
    """The robot has refused a frame sent to it. The connection stays open."""

    def __init__(self, frame: FrameId, refusal: Refusal) -> None:
        """With what the robot has answered."""
        super().__init__(f"the robot has refused the frame of 0x{frame.code:04X}: {refusal}")
        self.frame: Final = frame
        """Which."""
        self.refusal: Final = refusal
        """What the robot has answered."""

    @property
    def name(self) -> str:
        """Its name, the same in every language."""
        return "refused"


class DataUnexpectedError(DataError):
    """A frame came that is not a stream's. It has been skipped, and the connection stays open."""

    def __init__(self, frame: FrameId) -> None:
        """Says which."""
        super().__init__(f"no stream: 0x{frame.code:04X} of kind {frame.kind}")
        self.frame: Final = frame
        """Which."""

    @property
    def name(self) -> str:
        """Its name, the same in every language."""
        return "unexpected_frame"


class DataInvalidError(DataError):
    """What a frame carries is not what its stream does, or what is to be sent breaks a constraint."""

    def __init__(self, error: BodyError) -> None:
        """With what is wrong."""
        super().__init__(f"the content of a stream is invalid: {error}")
        self.error: Final = error
        """What is wrong."""

    @property
    def name(self) -> str:
        """That of what is wrong."""
        return self.error.name
