"""A small tool that calls a command of a protocol from the command line, and shows its response and reports."""

from __future__ import annotations

import argparse
import asyncio
import sys
from typing import TYPE_CHECKING, Any

from .calls import CallError, ConnectError
from .config import ClientConfig
from .connection import Connection
from .errors import BodyError
from .following import Ended, Failed, Followable, FollowError, Going
from .operations import Effect
from .receivers import RawReport
from .settings import duration, or_none

if TYPE_CHECKING:
    from collections.abc import Sequence

    from .message import Message
    from .operations import Command
    from .protocol import Protocol

_WRONG_USE = 2


def main(protocol: Protocol, arguments: Sequence[str] | None = None) -> int:
    """Runs the command line. Returns 0 for success, 1 for an error, 2 for a wrong command line."""
    parser = _parser(protocol)
    asked = parser.parse_args(arguments)
    if asked.list:
        _list(protocol)
        return 0
    commands = {one.name: one for one in protocol.commands if one.code is not None}
    command = commands.get(asked.command or "")
    if command is None and not asked.reports:
        usage = parser.format_usage().strip()
        print(f"no such command: {asked.command}; see --list" if asked.command else usage, file=sys.stderr)
        return _WRONG_USE
    if asked.example and command is not None:
        print(command.request.example().to_json())
        return 0
    if command is not None and command.effect in (Effect.MOTION, Effect.UNKNOWN) and not asked.move:
        print(f"{command.name} may move the robot: add --move if it may", file=sys.stderr)
        return _WRONG_USE
    if command is not None and asked.follow and not command.sets_off:
        print(f"{command.name} sets no report off that could be followed", file=sys.stderr)
        return _WRONG_USE
    try:
        config = ClientConfig(host=asked.host, command_port=asked.command_port)
        or_none(duration)("--timeout", asked.timeout)
    except (TypeError, ValueError) as error:
        print(error, file=sys.stderr)
        return _WRONG_USE
    try:
        text = sys.stdin.read() if asked.body == "-" else asked.body
        request = None if command is None else command.request.from_json(text)
        return asyncio.run(_run(protocol, config, asked, command, request))
    except (BodyError, CallError, FollowError) as error:
        print(f"{error.name}: {error}", file=sys.stderr)
    except ConnectError as error:
        print(error, file=sys.stderr)
    except KeyboardInterrupt:
        pass
    return 1


def _parser(protocol: Protocol) -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog=f"python -m {protocol.name}.call",
        description="调用一条指令，打印应答。Call a command, and print what it answers.",
    )
    parser.add_argument("command", nargs="?", help="指令名称 / name of the command in the spec")
    parser.add_argument("body", nargs="?", default="{}", help="请求（JSON）/ the request as JSON; - for stdin")
    parser.add_argument("--host", help=f"机器人地址 / address of the robot ({protocol.host})")
    parser.add_argument("--command-port", type=int, help=f"指令端口 / port of commands ({protocol.command_port})")
    parser.add_argument("--timeout", type=float, help="等待应答的秒数 / seconds to wait for the answer")
    parser.add_argument("--move", action="store_true", help="允许会引起动作的指令 / allow what may move the robot")
    parser.add_argument("--follow", action="store_true", help="跟踪到过程结束 / follow what it sets off to its end")
    parser.add_argument("--reports", action="store_true", help="此后打印全部主动上报 / then print all reports")
    parser.add_argument("--example", action="store_true", help="打印请求的示例 / print an example of the request")
    parser.add_argument("--list", action="store_true", help="列出全部指令 / list all commands")
    return parser


def _list(protocol: Protocol) -> None:
    for one in protocol.commands:
        code = "      " if one.code is None else f"0x{one.code:04X}"
        print(f"{code}  {one.effect.value:<7}  {one.name}  {one.zh}  {one.en}")


async def _run(
    protocol: Protocol,
    config: ClientConfig,
    asked: argparse.Namespace,
    command: Command[Any, Any] | None,
    request: Message | None,
) -> int:
    connection = Connection(protocol, config)
    receiver = connection.receiver() if asked.reports else None
    await connection.connect()
    try:
        if command is not None and asked.follow:
            await _follow(connection, command, request, asked.timeout)
        elif command is not None:
            answer: Message = await connection.call(command, request, timeout=asked.timeout)
            print(answer.to_json(), flush=True)
        while receiver is not None and (event := await receiver.next()) is not None:
            if isinstance(event, RawReport):
                known = protocol.reports_by_code.get(event.code)
                print(known.name if known else f"0x{event.code:04X}", event.data.decode(), flush=True)
    finally:
        connection.close()
        await connection.gone()
    return 0


async def _follow(
    connection: Connection, command: Command[Any, Any], request: Message | None, timeout: float | None
) -> None:
    call: Followable[Any, Any] = Followable(connection, command, request, timeout, None)
    async with call.follow(command.sets_off[0].report) as following:
        print(following.answer.to_json(), flush=True)
        async for event in following:
            match event:
                case Going(report) | Ended(report) | Failed(report):
                    print(type(event).__name__.lower(), report.to_json(), flush=True)
                case _:
                    print(event, flush=True)
