"""The groups, each with a module of its own."""

from __future__ import annotations

from typing import TYPE_CHECKING

from . import battery
from .battery import *

# Type checkers go by the imports above: not all of them read an `__all__` that is made of others.
if not TYPE_CHECKING:
    __all__ = [
        *battery.__all__,
    ]
