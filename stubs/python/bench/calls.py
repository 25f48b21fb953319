"""Calls over loopback: each peer has a process that serves and one that calls, and the peers take turns."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from contextlib import ExitStack
from pathlib import Path
from statistics import median
from typing import TYPE_CHECKING, Any, NamedTuple

from peers import PEERS

if TYPE_CHECKING:
    from types import TracebackType

IN_FLIGHT = (1, 64)
"""Calls in flight at a time."""


class Span(NamedTuple):
    """Length of a measurement."""

    rounds: int
    """Rounds of all peers."""
    seconds: float
    """Least seconds of a round."""


class Worker:
    """A process, on a separate core if there are several."""

    def __init__(self, core: int, *words: str) -> None:
        """Starts it and waits for its first line."""
        pinned = ["taskset", "-c", str(core)] if (os.cpu_count() or 1) > 1 and shutil.which("taskset") else []
        command = [*pinned, sys.executable, str(Path(__file__).with_name("peer.py")), *words]
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)  # noqa: S603
        self.first = self._answer()

    def _answer(self) -> Any:
        assert self.process.stdout is not None
        return json.loads(self.process.stdout.readline())

    def ask(self, value: Any) -> Any:
        """Sends a value, and waits for the answer."""
        assert self.process.stdin is not None
        self.process.stdin.write(json.dumps(value) + "\n")
        self.process.stdin.flush()
        return self._answer()

    def __enter__(self) -> Worker:
        """Returns itself."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Ends the process."""
        self.process.kill()
        self.process.communicate()


class Pair(NamedTuple):
    """The processes of a peer."""

    server: Worker
    caller: Worker

    def round(self, in_flight: int, calls: int) -> dict[str, float]:
        """Runs one round. Returns its duration and the CPU time of both processes."""
        self.server.ask("begin")
        self.caller.ask("begin")
        found: dict[str, float] = self.caller.ask({"in_flight": in_flight, "calls": calls})
        cpu = self.caller.ask("end") + self.server.ask("end")
        return {**found, "rate": calls / found["seconds"], "cpu": cpu / calls}


def calls(span: Span) -> list[dict[str, Any]]:
    """Returns the cost of calls for each number in flight, and each peer."""
    with ExitStack() as stack:
        pairs: dict[str, Pair] = {}
        for name in PEERS:
            server = stack.enter_context(Worker(0, "serve", name))
            pairs[name] = Pair(server, stack.enter_context(Worker(1, "call", name, str(server.first))))
        return [{"in_flight": in_flight, "peers": _scenario(pairs, in_flight, span)} for in_flight in IN_FLIGHT]


def _scenario(pairs: dict[str, Pair], in_flight: int, span: Span) -> list[dict[str, Any]]:
    counts: dict[str, int] = {}
    for name, pair in pairs.items():
        counts[name] = 16 * in_flight
        while pair.round(in_flight, counts[name])["seconds"] < span.seconds:
            counts[name] *= 2
    rounds: dict[str, list[dict[str, float]]] = {name: [] for name in pairs}
    for _ in range(span.rounds):
        for name, pair in pairs.items():
            rounds[name].append(pair.round(in_flight, counts[name]))
    found: list[dict[str, Any]] = []
    for name, of in rounds.items():
        middle = {figure: median(one[figure] for one in of) for figure in ("rate", "p50", "p99", "cpu")}
        if PEERS[name]().windows and in_flight > 1:
            # A window of the floor is not a single call, so it has no latency.
            middle.update(p50=None, p99=None)  # type: ignore[call-overload]
        found.append({"name": name, **middle})
    return found
