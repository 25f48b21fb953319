"""What the examples share: their command line, and a table whose columns line up."""

from __future__ import annotations

import argparse
import os
import unicodedata


def arguments(usage: str, *, is_robot: bool = False) -> argparse.Namespace:
    """Which robot, at which ports; without ports, those of the spec."""
    parser = argparse.ArgumentParser(description=usage)
    parser.add_argument("--host", default="127.0.0.1")
    parser.add_argument("--command-port", type=int)
    parser.add_argument("--data-port", type=int)
    parser.add_argument("--gzip-from", type=int, default=1024, help="bytes from which on something is compressed")
    parser.add_argument("--lang", choices=["zh", "en"], default=_lang(), help="default: that of the environment")
    if is_robot:
        parser.add_argument("--once", action="store_true", help="end when the app has left")
        parser.add_argument("--delay", type=float, default=0.0, help="milliseconds to take over each command")
        parser.add_argument("--picture-scale", type=int, default=1, help="times as wide and high the picture is")
    return parser.parse_args()


class Table:
    """Rows of cells, each column as wide as its widest cell on a terminal, where Chinese takes two columns a letter."""

    def __init__(self, *head: str) -> None:
        """With its first row."""
        self.rows = [head]

    def row(self, *cells: str) -> None:
        """Adds a row."""
        self.rows.append(cells)

    def __str__(self) -> str:
        """All rows."""
        widths = [max(map(_width, column)) for column in zip(*self.rows, strict=True)]
        lines = [
            "  ".join(cell + " " * (width - _width(cell)) for cell, width in zip(row, widths, strict=True)).rstrip()
            for row in self.rows
        ]
        return "\n".join(lines)


def _lang() -> str:
    """The language of the environment, as POSIX has it."""
    locales = map(os.environ.get, ("LC_ALL", "LC_MESSAGES", "LANG"))
    locale = next(filter(None, locales), "")
    return "zh" if locale.startswith("zh") else "en"


def _width(text: str) -> int:
    return sum(2 if unicodedata.east_asian_width(letter) in "WF" else 1 for letter in text)
