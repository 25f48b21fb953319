"""A robot for trying out an app.

It responds to every command with the spec's example, even to those that move a real robot. It pushes every report once
to each app. If an app requests the picture of a map, it sends one over the data port.

    ./run robot --command-port 0 --data-port 0

The first line has its addresses: `commands 127.0.0.1:PORT data 127.0.0.1:PORT`. It ends with Ctrl-C or SIGTERM, after
responding to the requests in its handlers. A second signal ends it at once.
"""

from __future__ import annotations

import asyncio
import logging
import signal
import sys
from typing import TYPE_CHECKING, Any

import fc
import fc_runtime as rt
from common import arguments, server_config

if TYPE_CHECKING:
    import argparse
    from collections.abc import Coroutine, Mapping

# Time for requests in handlers when the robot is asked to end, in seconds.
GRACE = 5.0
# Signals that ask it to end.
ENDS = (signal.SIGINT, signal.SIGTERM)


class Attentive(fc.ExampleRobot):
    """Responds with the examples, and notes each request."""

    def __init__(self, delay: float) -> None:
        super().__init__(pretend_motion=True)
        self.delay = delay
        self.asked: asyncio.Queue[rt.Context] = asyncio.Queue()

    def handlers_by_code(self) -> Mapping[int, rt.Handler]:
        """Returns the handlers of the examples, with their requests noted."""
        return {code: self.watched(handler) for code, handler in super().handlers_by_code().items()}

    def watched(self, handler: rt.Handler) -> rt.Handler:
        """Returns a handler that notes its requests."""

        async def handle(context: rt.Context, request: Any) -> rt.Message:
            self.asked.put_nowait(context)
            if self.delay:
                await asyncio.sleep(self.delay)
            return await handler(context, request)

        return handle


class Attendant:
    """Sends the robot's reports and pictures."""

    def __init__(self, server: rt.Server, robot: Attentive, content: bytes) -> None:
        self.server, self.robot, self.content = server, robot, content
        self.known: set[int] = set()
        self.tasks: set[asyncio.Task[None]] = set()

    def start(self, work: Coroutine[Any, Any, None]) -> None:
        """Starts work in the background."""
        task = asyncio.get_running_loop().create_task(work)
        self.tasks.add(task)
        task.add_done_callback(self.tasks.discard)

    async def run(self) -> None:
        """Runs until it is cancelled."""
        while True:
            request = await self.robot.asked.get()
            if request.connection not in self.known:
                self.known.add(request.connection)
                self.start(self.push_all(request.connection))
            if request.code == fc.operations.GET_MAP_IMAGE.code:
                self.start(self.send_picture(request))

    async def left(self) -> None:
        """Waits until an app has made a request and the last app has left."""
        while not self.known or self.server.connections:
            await asyncio.sleep(0.1)

    async def push_all(self, app: int) -> None:
        """Pushes every report with the spec's example."""
        for report in fc.FC.reports_by_code.values():
            try:
                for acknowledgement in await self.server.push(report, report.request.example(), app):
                    say(f"{report.name} to {app}: {acknowledgement.outcome.value}")
            except rt.PushError as error:
                say(f"{report.name}: {error}")

    async def send_picture(self, request: rt.Context) -> None:
        """Sends a picture to the app that requested one, under the id of its request."""
        content = self.content
        for _ in range(40):
            try:
                await self.server.send_data(request.code, request.id, content, request.connection)
            except rt.NoConnectionError:
                # The app's request may come before its data connection has been accepted.
                await asyncio.sleep(0.05)
            except rt.PushError as error:
                say(f"picture: {error}")
                return
            else:
                say(f"picture of {len(content)} bytes to {request.connection}")
                return
        say(f"picture: {request.connection} has no data connection")


def say(line: str) -> None:
    """Prints a line at once."""
    print(line, flush=True)


def picture(scale: int) -> bytes:
    """A small map as a portable graymap: a room with a wall around it."""
    width, height = 64 * scale, 48 * scale
    wall, row = bytes(width), b"\0" + b"\xfe" * (width - 2) + b"\0"
    return f"P5 {width} {height} 255\n".encode() + wall + row * (height - 2) + wall


async def run(asked: argparse.Namespace) -> None:
    """Serves until a signal asks it to end."""
    robot = Attentive(asked.delay / 1000)
    server = rt.Server(robot, server_config(asked))
    await server.bind()
    # Set before the addresses are printed, so that an immediate signal is not lost.
    asked_to_end, asked_again = asyncio.Event(), asyncio.Event()
    left = [asked_again, asked_to_end]
    loop = asyncio.get_running_loop()

    def ask(*_: object) -> None:
        if left:
            loop.call_soon_threadsafe(left.pop().set)
        if not left:
            ignore_signals()

    # Handlers of the event loop would be removed before the program ends.
    for number in ENDS:
        signal.signal(number, ask)
    (host, command_port), (_, data_port) = server.command_address, server.data_address
    say(f"commands {host}:{command_port} data {host}:{data_port}")

    attendant = Attendant(server, robot, picture(asked.picture_scale))
    await first_of(attendant.run(), asked_to_end.wait(), *([attendant.left()] if asked.once else []))
    # A second signal ends the robot at once.
    await first_of(server.shutdown(GRACE), asked_again.wait())
    await server.shutdown(0)
    ignore_signals()


def ignore_signals() -> None:
    """Ignores further signals while the program ends."""
    for number in ENDS:
        signal.signal(number, signal.SIG_IGN)


async def first_of(*works: Coroutine[Any, Any, Any]) -> None:
    """Runs all of them until the first has ended."""
    tasks = [asyncio.create_task(work) for work in works]
    done, left = await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
    for task in left:
        task.cancel()
    for task in done:
        task.result()


if __name__ == "__main__":
    logging.basicConfig(level=logging.INFO, stream=sys.stderr)
    asyncio.run(run(arguments("Responds to every command with the example in the spec. Nothing moves.", is_robot=True)))
