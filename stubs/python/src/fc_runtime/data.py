"""An app's connection to the data port."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, Generic, TypeVar

if TYPE_CHECKING:
    from .connection import Connection
    from .message import Message
    from .operations import Stream

B = TypeVar("B", bound="Message | bytes")


@dataclass(frozen=True, slots=True)
class StreamItem(Generic[B]):
    """A frame of a stream."""

    id: int
    """Its message id."""
    content: B
    """What it carries."""


class Subscription(Generic[B]):
    """The frames of one stream."""


class DataConnection:
    """A connection to a robot's data port."""

    def __init__(self, commands: Connection) -> None:
        """Beside a connection to the command port."""
        self._commands: Final = commands

    def subscribe(self, stream: Stream[B]) -> Subscription[B]:
        """Receive the frames of one stream from now on."""
        raise NotImplementedError

    async def send_stream(self, stream: Stream[B], message_id: int, content: B) -> None:
        """Send a frame of one of the app's own streams."""
        raise NotImplementedError


class Streams:
    """The streams of the data port: each that the robot sends can be subscribed to, each of the app's own be sent."""

    def __init__(self, data: DataConnection) -> None:
        """Those of a data connection; see `Client.data`."""
        self.data: Final = data
        """The data connection: its state, and frames that nobody has subscribed to."""
