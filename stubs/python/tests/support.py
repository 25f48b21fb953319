"""Files of the project, and the generated protocol that the tests of the runtime use."""

from __future__ import annotations

import asyncio
import faulthandler
import json
import unittest
from pathlib import Path
from typing import Any

from fc import FC

ROOT = Path(__file__).resolve().parents[3]

PROTOCOL = FC
LIMITS = FC.defaults.limits
# How long a test may take, in seconds.
PATIENCE = 120.0


class AsyncCase(unittest.IsolatedAsyncioTestCase):
    """Tests that fail where they would wait for ever."""

    async def asyncSetUp(self) -> None:
        loop = asyncio.get_running_loop()
        # These tests run in the debug mode of asyncio, and it is of no interest how busy the machine is.
        loop.slow_callback_duration = PATIENCE
        self.addCleanup(loop.call_later(PATIENCE, self.give_up).cancel)

    def give_up(self) -> None:
        for task in asyncio.all_tasks():
            task.cancel()


def load(path: str) -> Any:
    return json.loads((ROOT / path).read_text(encoding="utf-8"))


# A test that hangs ends all of them, and says where it hangs.
faulthandler.dump_traceback_later(500, exit=True)
