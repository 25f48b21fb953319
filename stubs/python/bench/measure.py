"""Work on one thread, in CPU time of this process."""

from __future__ import annotations

import random
import time
from statistics import median
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping


class Effort(NamedTuple):
    """Length of a measurement."""

    rounds: int
    """Rounds of all cases."""
    batch: float
    """Least CPU seconds of a batch."""


def _cost(run: Callable[[], object], times: int) -> float:
    before = time.process_time()
    for _ in range(times):
        run()
    return time.process_time() - before


def measure(cases: Mapping[str, Callable[[], object]], effort: Effort) -> dict[str, float]:
    """Returns the time of each case in microseconds, the median of its rounds.

    The cases take turns, in another order each round. A disturbance then affects all of them alike.
    """
    times: dict[str, int] = {}
    for name, run in cases.items():
        times[name] = 1
        while _cost(run, times[name]) < effort.batch:
            times[name] *= 2
    found: dict[str, list[float]] = {name: [] for name in cases}
    order = list(cases)
    for _ in range(effort.rounds):
        random.shuffle(order)
        for name in order:
            found[name].append(_cost(cases[name], times[name]) / times[name])
    return {name: median(seconds) * 1e6 for name, seconds in found.items()}
