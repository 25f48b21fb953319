"""Errors of a data connection."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from .calls import Loss, Refusal
    from .errors import BodyError, FrameError
    from .frame import FrameId


class DataError(Exception):
    """The error of sending or receiving a frame of raw bytes."""

    @property
    def name(self) -> str:
        """Name of the error, the same in every language."""
        return ""


class _DataLossError(DataError):
    def __init__(self, text: str, loss: Loss) -> None:
        super().__init__(f"{text}: {loss}")
        self.loss: Final = loss
        """The reason for having no connection."""


class DataLostError(_DataLossError):
    """The connection was lost, and is made again. Frames in flight may be lost with it."""

    def __init__(self, loss: Loss) -> None:
        """Creates the error with the reason."""
        super().__init__("the data connection was lost, and what was on its way may be lost with it", loss)

    @property
    def name(self) -> str:
        """Name of the error, the same in every language."""
        return "lost"


class DataNotConnectedError(_DataLossError):
    """No connection in time; the frame has not been sent."""

    def __init__(self, loss: Loss) -> None:
        """Creates the error with the reason."""
        super().__init__("there was no data connection in time", loss)

    @property
    def name(self) -> str:
        """Name of the error, the same in every language."""
        return "not_connected"


class DataClosedError(_DataLossError):
    """The connection is closed for good; the frame has not been sent."""

    def __init__(self, loss: Loss) -> None:
        """Creates the error with the reason."""
        super().__init__("the data connection is closed", loss)

    @property
    def name(self) -> str:
        """Name of the error, the same in every language."""
        return "closed"


class DataFrameError(DataError):
    """A received frame was unreadable and skipped, or the frame to send is too long. The connection stays open."""

    def __init__(self, error: FrameError) -> None:
        """Creates the error from the frame's error."""
        super().__init__(str(error))
        self.error: Final = error
        """The error of the frame."""

    @property
    def name(self) -> str:
        """Name of the frame's error."""
        return self.error.name

    @property
    def code(self) -> int | None:
        """Code of the command that the frame belongs to, if known."""
        return None if self.error.frame is None else self.error.frame.code


class DataRefusedError(DataError):
    """The robot has refused a frame sent to it. The connection stays open."""

    def __init__(self, frame: FrameId, refusal: Refusal) -> None:
        """Creates the error from the robot's refusal."""
        super().__init__(f"the robot has refused the frame of 0x{frame.code:04X}: {refusal}")
        self.frame: Final = frame
        """The frame sent."""
        self.refusal: Final = refusal
        """The robot's refusal."""

    @property
    def name(self) -> str:
        """Name of the error, the same in every language."""
        return "refused"


class DataUnexpectedError(DataError):
    """A frame that is not a stream's was received and skipped. The connection stays open."""

    def __init__(self, frame: FrameId) -> None:
        """Creates the error for the frame."""
        super().__init__(f"no stream: 0x{frame.code:04X} of kind {frame.kind}")
        self.frame: Final = frame
        """The frame received."""

    @property
    def name(self) -> str:
        """Name of the error, the same in every language."""
        return "unexpected_frame"


class DataInvalidError(DataError):
    """The content of a frame does not fit its stream, or breaks a constraint."""

    def __init__(self, error: BodyError) -> None:
        """Creates the error from the error in the content."""
        super().__init__(f"the content of a stream is invalid: {error}")
        self.error: Final = error
        """The error in the content."""

    @property
    def name(self) -> str:
        """Name of the error in the content."""
        return self.error.name
