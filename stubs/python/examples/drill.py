"""Tries out the connection to a robot: reads while it is cut, gives calls up, calls while the robot ends.

./run drill --command-port PORT

From `reading` on the connection may be cut; `calling` asks for the robot to be ended.
"""

from __future__ import annotations

import asyncio
import sys
from dataclasses import replace

import fc
import fc_runtime as rt
from common import arguments, client_config

# Calls in flight at a time.
AT_ONCE = 64
# Reads that get a response although the connection is cut.
READS = 1000


async def read(client: fc.Client) -> None:
    """Each call only reads, so it is sent again after a loss, and every call gets its response."""
    left = iter(range(READS))

    async def one_after_another() -> None:
        for _ in left:
            await client.get_robot_sn()

    await asyncio.gather(*(one_after_another() for _ in range(AT_ONCE)))


async def give_up(client: fc.Client) -> None:
    """Sends calls and cancels them before a response can come. The connection stays usable."""
    calls = [asyncio.ensure_future(client.get_robot_sn()) for _ in range(AT_ONCE)]
    # Each task runs once, to send its call.
    await asyncio.sleep(0)
    for call in calls:
        call.cancel()
    await asyncio.gather(*calls, return_exceptions=True)
    await client.get_robot_sn()


async def call_to_the_end(client: fc.Client) -> int:
    """Calls until the robot has gone. Returns the number of responses.

    Every call ends, the last ones because the connection was lost.
    """
    answered = 0

    async def until_it_ends() -> None:
        nonlocal answered
        while True:
            try:
                await client.get_robot_sn()
            except rt.CallError as error:
                if error.loss is None:
                    raise
                return
            answered += 1

    await asyncio.gather(*(until_it_ends() for _ in range(AT_ONCE)))
    return answered


async def run() -> None:
    """Runs one part after another, with a line for the program that causes the trouble."""
    asked = arguments("Tries out the connection to a robot while somebody else makes trouble.")
    config = client_config(asked)
    async with fc.Client.connect(config) as client:
        print("reading", flush=True)
        await read(client)
        print(f"read: {READS} answered", flush=True)
        await give_up(client)
        print(f"given up: {AT_ONCE}, and the next one answered", flush=True)
    # A client without reconnecting: its calls end when the robot has ended.
    async with fc.Client.connect(replace(config, reconnect=None)) as client:
        print("calling", flush=True)
        answered = await call_to_the_end(client)
        print(f"ended: {answered} answered, {AT_ONCE} lost", flush=True)


if __name__ == "__main__":
    try:
        asyncio.run(run())
    except (rt.ConnectError, rt.CallError) as error:
        sys.exit(f"{type(error).__name__}: {error}")
