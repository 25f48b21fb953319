"""A process that serves or calls, as its arguments specify: `peer.py serve PEER`, `peer.py call PEER PORT`.

It prints a JSON value on each line: first its port, then the answer to each line of its input.
"""

from __future__ import annotations

import asyncio
import json
import sys
import time
from typing import TYPE_CHECKING, Any

from peers import PEERS

if TYPE_CHECKING:
    from peers import Call


async def drive(call: Call, in_flight: int, calls: int) -> dict[str, float]:
    """Makes `calls` calls, `in_flight` at a time. Returns microseconds of the median and of a slow one."""
    latencies: list[float] = []
    left = iter(range(calls))

    async def caller() -> None:
        for _ in left:
            begun = time.perf_counter()
            await call()
            latencies.append(time.perf_counter() - begun)

    begun = time.perf_counter()
    await asyncio.gather(*(caller() for _ in range(in_flight)))
    seconds = time.perf_counter() - begun
    latencies.sort()
    p50, p99 = (latencies[int((calls - 1) * share)] * 1e6 for share in (0.5, 0.99))
    return {"seconds": seconds, "p50": p50, "p99": p99}


def say(value: Any) -> None:
    """Prints a value on a line."""
    print(json.dumps(value), flush=True)


async def main(does: str, name: str, port: int) -> None:
    """Serves or calls until its input ends."""
    peer = PEERS[name]()
    connections: dict[int, Call] = {}
    say(await peer.serve() if does == "serve" else None)
    loop = asyncio.get_running_loop()
    begun = 0.0
    while line := await loop.run_in_executor(None, sys.stdin.readline):
        asked: Any = json.loads(line)
        if asked == "begin":
            begun = time.process_time()
            say(None)
        elif asked == "end":
            say((time.process_time() - begun) * 1e6)
        else:
            in_flight, calls = asked["in_flight"], asked["calls"]
            window = in_flight if peer.windows else 1
            if window not in connections:
                connections[window] = await peer.connect(port, window)
            say(await drive(connections[window], in_flight // window, -(-calls // window)))


if __name__ == "__main__":
    arguments = sys.argv[1:]
    asyncio.run(main(arguments[0], arguments[1], int(arguments[2]) if arguments[2:] else 0))
