"""Shared by the examples: their command line, and a table with aligned columns."""

from __future__ import annotations

import argparse
import math
import os
import sys
import unicodedata
from collections.abc import Callable
from typing import Any, TypeVar

import fc_runtime as rt

T = TypeVar("T")


def arguments(usage: str, *, is_robot: bool = False) -> argparse.Namespace:
    """Parses the command line: address and ports of the robot, by default the spec's ports."""
    parser = argparse.ArgumentParser(description=usage)
    parser.add_argument("--host", default="127.0.0.1")
    parser.add_argument("--command-port", type=int)
    parser.add_argument("--data-port", type=int)
    parser.add_argument("--gzip-from", type=int, default=1024, help="bytes from which on something is compressed")
    parser.add_argument("--lang", choices=["zh", "en"], default=_lang(), help="default: that of the environment")
    if is_robot:
        parser.add_argument("--once", action="store_true", help="end when the app has left")
        parser.add_argument("--delay", type=_delay, default=0.0, help="milliseconds to take over each command")
        parser.add_argument("--picture-scale", type=_scale, default=1, help="times as wide and high the picture is")
    return parser.parse_args()


def client_config(asked: argparse.Namespace) -> rt.ClientConfig:
    """The configuration of an app."""
    return _made(rt.ClientConfig, asked, host=asked.host)


def server_config(asked: argparse.Namespace) -> rt.ServerConfig:
    """The configuration of a robot."""
    return _made(rt.ServerConfig, asked, address=asked.host)


def _made(kind: Callable[..., T], asked: argparse.Namespace, **more: Any) -> T:
    """Returns a configuration. Ends the program if it is invalid."""
    try:
        gzip = rt.Gzip(from_bytes=asked.gzip_from)
        return kind(command_port=asked.command_port, data_port=asked.data_port, gzip=gzip, **more)
    except ValueError as error:
        print(error, file=sys.stderr)
        sys.exit(2)


def _delay(text: str) -> float:
    """Returns milliseconds. Raises `ValueError`."""
    number = float(text)
    if not 0 <= number < math.inf:
        raise ValueError
    return number


def _scale(text: str) -> int:
    """Returns a factor whose picture fits into a frame. Raises `ValueError`."""
    number = int(text)
    if not 1 <= number <= 50:
        raise ValueError
    return number


class Table:
    """Rows of cells, with each column as wide as its widest cell. Chinese characters take two columns on a terminal."""

    def __init__(self, *head: str) -> None:
        """Creates a table with its first row."""
        self.rows = [head]

    def row(self, *cells: str) -> None:
        """Adds a row."""
        self.rows.append(cells)

    def __str__(self) -> str:
        """Returns all rows."""
        widths = [max(map(_width, column)) for column in zip(*self.rows, strict=True)]
        lines = [
            "  ".join(cell + " " * (width - _width(cell)) for cell, width in zip(row, widths, strict=True)).rstrip()
            for row in self.rows
        ]
        return "\n".join(lines)


def _lang() -> str:
    """Returns the language of the environment, as POSIX specifies."""
    locales = map(os.environ.get, ("LC_ALL", "LC_MESSAGES", "LANG"))
    locale = next(filter(None, locales), "")
    return "zh" if locale.startswith("zh") else "en"


def _width(text: str) -> int:
    return sum(2 if unicodedata.east_asian_width(letter) in "WF" else 1 for letter in text)
