"""Waiting with a timeout."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, TypeVar

if TYPE_CHECKING:
    from collections.abc import Awaitable

T = TypeVar("T")


async def within(seconds: float | None, work: Awaitable[T]) -> T:
    """Returns the result of work that ends in time. Raises `asyncio.TimeoutError`, from 3.11 on plain `TimeoutError`.

    Before Python 3.12, `asyncio.wait_for` loses a cancellation if the work ends in the same turn. The cancelled task
    would then continue.
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
    """Retrieves the exception, so that asyncio does not log it as never retrieved."""
    if not task.cancelled():
        task.exception()
