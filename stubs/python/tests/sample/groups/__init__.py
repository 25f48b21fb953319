"""The groups, each in a separate module."""

from __future__ import annotations

from typing import TYPE_CHECKING

from . import battery
from .battery import *

# Type checkers use the imports above: not all of them read a computed `__all__`.
if not TYPE_CHECKING:
    __all__ = [
        *battery.__all__,
    ]
