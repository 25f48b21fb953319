"""Files of the project, and the generated protocol that the tests of the runtime use."""

from __future__ import annotations

import asyncio
import atexit
import faulthandler
import json
import os
import unittest
from collections import Counter
from pathlib import Path
from typing import Any

from fc import FC

ROOT = Path(__file__).resolve().parents[3]

PROTOCOL = FC
LIMITS = FC.defaults.limits
# Time limit of a test, in seconds.
PATIENCE = 120.0


class AsyncCase(unittest.IsolatedAsyncioTestCase):
    """Tests that fail instead of waiting forever."""

    async def asyncSetUp(self) -> None:
        loop = asyncio.get_running_loop()
        # The tests run in asyncio's debug mode. Its warnings about slow callbacks depend on the machine's load.
        loop.slow_callback_duration = PATIENCE
        self.addCleanup(loop.call_later(PATIENCE, self.give_up).cancel)

    def give_up(self) -> None:
        for task in asyncio.all_tasks():
            task.cancel()


def load(path: str) -> Any:
    return json.loads((ROOT / path).read_text(encoding="utf-8"))


HELD: Counter[str] = Counter()


def holds(kind: str) -> None:
    """Counts a passed case of a kind in `conformance/README.md`."""
    HELD[kind] += 1


def say_what_held() -> None:
    """Appends a line `KIND NUMBER` for each kind to the file that `FC_CONFORMANCE` names."""
    if path := os.environ.get("FC_CONFORMANCE"):
        with Path(path).open("a", encoding="utf-8") as file:
            file.writelines(f"{kind} {number}\n" for kind, number in HELD.items())


atexit.register(say_what_held)

# A test that hangs ends all of them, with a stack trace.
faulthandler.dump_traceback_later(500, exit=True)
