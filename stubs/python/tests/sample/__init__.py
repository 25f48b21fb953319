"""A small protocol, written by hand as `fc generate` writes them: one query, one command to follow, one report."""

from __future__ import annotations

from . import operations, sync
from .client import AnyReport, Client, Streams
from .messages import (
    DockError,
    DockId,
    Docking,
    DockingAck,
    DockRequest,
    DockResponse,
    GetBatteryRequest,
    GetBatteryResponse,
    Phase,
    Scan,
    Unit,
)
from .protocol import SAMPLE, RequestEnvelope, ResponseEnvelope, ResultCode
from .robot import ExampleRobot, PartialRobot, Reporter, Robot, Streamer

__all__ = [
    "SAMPLE",
    "AnyReport",
    "Client",
    "DockError",
    "DockId",
    "DockRequest",
    "DockResponse",
    "Docking",
    "DockingAck",
    "ExampleRobot",
    "GetBatteryRequest",
    "GetBatteryResponse",
    "PartialRobot",
    "Phase",
    "Reporter",
    "RequestEnvelope",
    "ResponseEnvelope",
    "ResultCode",
    "Robot",
    "Scan",
    "Streamer",
    "Streams",
    "Unit",
    "operations",
    "sync",
]
