"""The end of a call, for metrics."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class EndedCall:
    """A call that has ended."""

    operation: str
    """Name of the command; `unknown` for all codes that the spec does not have."""
    result: str
    """The result.

    At the client, it is `success`, the name of the `CallError`, or `dropped` if the waiting task was cancelled. At the
    robot, it is `success`, `protocol`, `timeout`, `invalid`, `expired` or `refused`.
    """
    seconds: float
    """Time: at the client from the call to its end, at the robot from the request to its response."""
