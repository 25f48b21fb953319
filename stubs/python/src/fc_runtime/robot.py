"""The base of a generated robot, which adds one method per command."""

from __future__ import annotations

import inspect
from dataclasses import dataclass
from difflib import get_close_matches
from typing import TYPE_CHECKING, Any, ClassVar, Final, TypeAlias, TypeVar

from .operations import Effect

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable, Mapping

    from .context import Context
    from .document import Json
    from .message import Message
    from .operations import Command
    from .protocol import Protocol
    from .server import Server

RawHandler: TypeAlias = "Callable[[Context, RawRequest], Awaitable[Json]]"
"""Handles a request of any code, and returns an object with the response's keys."""

HANDLER_PARAMETERS: Final = 3
"""Robot, context and request."""

F = TypeVar("F", bound="Callable[..., Any]")

Handler: TypeAlias = "Callable[[Context, Any], Awaitable[Message]]"
"""Handles a request. To refuse it, raise `Refusal`."""


def left_out(method: F) -> F:
    """Marks a method as not implemented: its command is refused."""
    method.__left_out__ = True  # type: ignore[attr-defined]
    return method


def _is_missing(method: Any) -> bool:
    return method is None or hasattr(method, "__left_out__") or hasattr(method, "__isabstractmethod__")


def _is_handler(method: Any) -> bool:
    """Return `True` for a coroutine function with the parameters of a handler."""
    return inspect.iscoroutinefunction(method) and len(inspect.signature(method).parameters) == HANDLER_PARAMETERS


def _plain(name: str) -> str:
    """Return the letters of a name, so that `getRobotSn` is close to `get_robot_sn`."""
    return name.replace("_", "").lower()


class Robot:
    """A robot. Its subclasses have one method per command."""

    protocol: ClassVar[Protocol]
    """The protocol that it speaks."""

    def __init_subclass__(cls, **options: Any) -> None:
        """Raise `TypeError` for a misspelt handler.

        That is a public coroutine method with two parameters. Its name is close to a handler that the class lacks.
        """
        super().__init_subclass__(**options)
        protocol: Protocol | None = getattr(cls, "protocol", None)
        if protocol is None:
            return
        handlers = {command.method_name for command in protocol.commands}
        handlers |= {"unknown", *(one.method for one in protocol.pass_through)}
        missing = {_plain(name): name for name in handlers if _is_missing(getattr(cls, name, None))}
        for name in dir(cls):
            if name in handlers or name.startswith("_") or not _is_handler(inspect.getattr_static(cls, name)):
                continue
            for near in get_close_matches(_plain(name), missing, n=1, cutoff=0.8):
                raise TypeError(
                    f"{cls.__name__} has no handler `{missing[near]}`, and `{name}` is none: "
                    "rename it, or begin the name of a helper with `_`"
                )

    def handlers_by_code(self) -> Mapping[int, Handler]:
        """Returns the handler of each code. A command without a handler is refused as not implemented."""
        commands = self.protocol.commands_by_code
        methods = {code: getattr(self, command.method_name, None) for code, command in commands.items()}
        return {
            code: method
            for code, method in methods.items()
            if method is not None and not getattr(method, "__left_out__", False)
        }

    def raw_handler(self, code: int) -> RawHandler | None:
        """Returns the handler of a code without a command; `None` if that is refused as unknown."""
        for one in self.protocol.pass_through:
            method: RawHandler | None = getattr(self, one.method, None)
            if one.first <= code <= one.last and method is not None and not getattr(method, "__left_out__", False):
                return method
        return None if getattr(self.unknown, "__left_out__", False) else self.unknown

    @left_out
    async def unknown(self, context: Context, request: RawRequest) -> Json:
        """Handles a request with an undeclared code. Without this method such requests are refused."""
        raise NotImplementedError


class Handlers(Robot):
    """A robot made of functions, by command code."""

    def __init__(self, protocol: Protocol, handlers: Mapping[int, Handler]) -> None:
        """Creates the robot for a protocol."""
        self.protocol = protocol  # type: ignore[misc]
        self._handlers: Final = handlers

    def handlers_by_code(self) -> Mapping[int, Handler]:
        """Returns the given handlers."""
        return self._handlers


@dataclass(frozen=True, slots=True)
class RawRequest:
    """A request as received, without types."""

    code: int
    """Its code."""
    id: int
    """Its message id."""
    data: bytes
    """Its JSON text, envelope included."""

    def __repr__(self) -> str:
        """Shows it without its text, which may contain anything."""
        return f"RawRequest(code=0x{self.code:04X}, id={self.id}, bytes={len(self.data)})"


class ExampleRobot(Robot):
    """A robot that responds with the examples of the spec, for trying out apps.

    It refuses commands that move a real robot, unless `pretend_motion` is set.
    """

    def __init__(self, *, pretend_motion: bool = False) -> None:
        """`pretend_motion`: respond with success to these as well, without any motion."""
        self.pretend_motion: Final = pretend_motion

    def handlers_by_code(self) -> Mapping[int, Handler]:
        """Returns handlers with examples for all commands."""
        return {
            code: _example(command)
            for code, command in self.protocol.commands_by_code.items()
            if self.pretend_motion or command.effect in (Effect.READ, Effect.CONFIG)
        }


def _example(command: Command[Any, Any]) -> Handler:
    async def handle(_: Context, __: Any) -> Message:
        example: Message = command.response.example()
        return example

    return handle


class Reporter:
    """Pushes reports. Its subclasses have one method per report."""

    def __init__(self, server: Server) -> None:
        """Creates the reporter of a server."""
        self.server: Final = server


class Streamer:
    """Sends the robot's streams. Its subclasses have one method per stream."""

    def __init__(self, server: Server) -> None:
        """Creates the streamer of a server."""
        self.server: Final = server
