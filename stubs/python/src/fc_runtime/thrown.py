"""Errors of user code as log text: class and place, never the message, which may quote received data."""

from __future__ import annotations

import functools
import inspect
import os
import sysconfig
import traceback
from pathlib import Path
from typing import Any, Final

from .errors import BodyError, FrameError

_RUNTIME: Final = str(Path(__file__).parent) + os.sep
_PACKAGES: Final = tuple(f"{os.sep}{name}{os.sep}" for name in ("site-packages", "dist-packages"))


@functools.cache
def _library() -> tuple[str, ...]:
    """Returns the folders of the standard library."""
    paths = sysconfig.get_paths()
    return tuple({paths[name] + os.sep for name in ("stdlib", "platstdlib")})


def _is_user(file: str) -> bool:
    """Returns `True` unless a file is part of the runtime or of Python."""
    return not file.startswith((_RUNTIME, "<frozen ")) and (_is_package(file) or not file.startswith(_library()))


def _is_package(file: str) -> bool:
    """Returns `True` if a file is part of an installed package."""
    return any(folder in file for folder in _PACKAGES)


def describe(error: BaseException, function: Any) -> str:
    """Returns the class of an error with the innermost line of user code, or else the place of the function called."""
    found = [(one.f_code.co_filename, line, one.f_code.co_name) for one, line in traceback.walk_tb(error.__traceback__)]
    users = [one for one in found if _is_user(one[0])]
    # A robot may be part of an installed package.
    own = [one for one in users if not _is_package(one[0])] or users
    file, line, name = own[-1] if own else _definition(function)
    return f"{_class(error)} at {file}:{line} in {name}" if file else _class(error)


def _class(error: BaseException) -> str:
    """Returns the class of an error. For errors of the runtime it includes the name, and the path of known keys."""
    if isinstance(error, BodyError):
        return f"BodyError ({error.name} at `{error.path}`)" if error.path else f"BodyError ({error.name})"
    return f"FrameError ({error.name})" if isinstance(error, FrameError) else type(error).__name__


def _definition(function: Any) -> tuple[str, int, str]:
    """Returns file, line and name of a function; an empty file if unknown."""
    while isinstance(function, functools.partial):
        function = function.func
    plain = inspect.unwrap(getattr(function, "__func__", function))
    code = getattr(plain, "__code__", None) or getattr(type(plain).__call__, "__code__", None)
    return (code.co_filename, code.co_firstlineno, code.co_name) if code is not None else ("", 0, "")
