"""A small protocol, written by hand as `fcproto generate` writes them: one query, one command to follow, one report."""

from __future__ import annotations

from typing import TYPE_CHECKING

from . import messages as messages
from . import operations as operations
from . import sync as sync
from .client import AnyReport as AnyReport
from .client import Client as Client
from .client import Streams as Streams
from .groups import *
from .protocol import SAMPLE as SAMPLE
from .protocol import RequestEnvelope as RequestEnvelope
from .protocol import ResponseEnvelope as ResponseEnvelope
from .protocol import ResultCode as ResultCode
from .robot import ExampleRobot as ExampleRobot
from .robot import PartialRobot as PartialRobot
from .robot import Reporter as Reporter
from .robot import Robot as Robot
from .robot import Streamer as Streamer

# Type checkers use the imports above: not all of them read a computed `__all__`.
if not TYPE_CHECKING:
    __all__ = [
        "SAMPLE",
        "AnyReport",
        "Client",
        "ExampleRobot",
        "PartialRobot",
        "Reporter",
        "RequestEnvelope",
        "ResponseEnvelope",
        "ResultCode",
        "Robot",
        "Streamer",
        "Streams",
        "messages",
        "operations",
        "sync",
        *messages.__all__,
    ]
