"""Marks deprecated items for editors and type checkers."""

from __future__ import annotations

import functools
import warnings
from typing import TYPE_CHECKING, Any, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable

    from typing_extensions import deprecated
else:
    T = TypeVar("T", bound="type | Callable[..., Any]")

    def deprecated(message: str) -> Callable[[T], T]:
        """Marks a deprecated function or class. Calling a marked function warns; a class only has the mark."""

        def mark(withdrawn: T) -> T:
            withdrawn.__deprecated__ = message
            if isinstance(withdrawn, type):
                return withdrawn

            @functools.wraps(withdrawn)
            def warn(*args: Any, **kwargs: Any) -> Any:
                warnings.warn(message, DeprecationWarning, stacklevel=2)
                return withdrawn(*args, **kwargs)

            return warn

        return mark


__all__ = ["deprecated"]
