"""Runs pdoc on the Python packages. Their classes are put together from the parts of groups, which no page lists: what
a class has of them is shown as its own."""

from typing import Any

from pdoc import doc
from pdoc.__main__ import cli

PARTS = ".groups."
taken_from = doc.Class._taken_from
bases = doc.Class.bases.func


def shown_from(cls: doc.Class, member: str, obj: Any) -> tuple[str, str]:
    """Where a member of a class comes from, for those who read of it."""
    module, name = taken_from(cls, member, obj)
    return (cls.modulename, f"{cls.qualname}.{member}") if PARTS in module else (module, name)


doc.Class._taken_from = shown_from
doc.Class.bases = property(lambda cls: [base for base in bases(cls) if PARTS not in base[0]])
cli()
