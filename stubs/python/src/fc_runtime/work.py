"""Coroutines with more than one way to run."""

from __future__ import annotations

import inspect
from collections.abc import Coroutine
from typing import TYPE_CHECKING, Any, Final, TypeVar

if TYPE_CHECKING:
    from collections.abc import Generator

T = TypeVar("T", covariant=True)


class Work(Coroutine[Any, Any, T]):
    """A coroutine, for `await` and for tasks. Its subclasses add another way to run it."""

    def __init__(self, work: Coroutine[Any, Any, T], name: str) -> None:
        """Wraps this coroutine, with a name for warnings and logs."""
        named: Any = work
        named.__name__ = named.__qualname__ = name
        self._work: Final = work

    @property
    def is_begun(self) -> bool:
        """`True` if it has been awaited or closed."""
        return inspect.getcoroutinestate(self._work) != inspect.CORO_CREATED

    def send(self, value: Any, /) -> Any:
        """Continues it, for event loops."""
        return self._work.send(value)

    def throw(self, kind: Any, value: Any = None, trace: Any = None, /) -> Any:
        """Continues it with an error, for event loops."""
        if value is None and trace is None:
            return self._work.throw(kind)
        return self._work.throw(kind, value, trace)

    def close(self) -> None:
        """Closes it."""
        self._work.close()

    def __await__(self) -> Generator[Any, None, T]:
        """Waits for its result."""
        return self._work.__await__()
