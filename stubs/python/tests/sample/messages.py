"""All message types, whatever their group."""

from __future__ import annotations

from typing import TYPE_CHECKING

from . import groups, operations
from .groups import *

# Type checkers use the imports above: not all of them read a computed `__all__`.
if not TYPE_CHECKING:
    __all__ = [name for name in groups.__all__ if name not in operations.__all__]
