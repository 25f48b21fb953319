"""Waiting no longer than so long."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, TypeVar

if TYPE_CHECKING:
    from collections.abc import Awaitable

T = TypeVar("T")


async def within(seconds: float | None, work: Awaitable[T]) -> T:
    """What comes of some work, if it comes in time. Raises `asyncio.TimeoutError`, from 3.11 on plain `TimeoutError`.

    `asyncio.wait_for` forgets before Python 3.12 that it was cancelled, if the work ends in the same turn: then who has
    closed something finds it going on.
    """
    task = asyncio.ensure_future(work)
    try:
        await asyncio.wait({task}, timeout=seconds)
    except asyncio.CancelledError:
        task.cancel()
        task.add_done_callback(_forget)
        raise
    if not task.done():
        task.cancel()
        await asyncio.wait({task})
        if task.cancelled():
            raise asyncio.TimeoutError
    return task.result()


def _forget(task: asyncio.Future[T]) -> None:
    """Take note of how it ended, so that nobody is told that nobody has."""
    if not task.cancelled():
        task.exception()
