"""Every operation, whatever its group."""

from __future__ import annotations

from typing import TYPE_CHECKING

import fc_runtime as rt

from . import groups
from .groups import *

# Type checkers use the imports above: not all of them read a computed `__all__`.
if not TYPE_CHECKING:
    __all__ = [name for name in groups.__all__ if isinstance(getattr(groups, name), rt.Command | rt.Report | rt.Stream)]
