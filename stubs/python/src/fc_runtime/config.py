"""What a client and a robot can be told beforehand. Times are in seconds."""

from __future__ import annotations

from dataclasses import dataclass, field
from datetime import datetime
from typing import TYPE_CHECKING, Literal

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping
    from ssl import SSLContext

    from .frame import Gzip
    from .operations import Effect
    from .protocol import Limits


@dataclass(frozen=True, slots=True, kw_only=True)
class Backoff:
    """How long to wait before connecting again."""

    first: float = 0.1
    """Before the first attempt."""
    longest: float = 10.0
    """Longest wait; each is twice the one before, minus up to a quarter at random."""
    attempts: int | None = None
    """Failed attempts in a row after which the connection is given up; `None`: never."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ClientConfig:
    """What a client can be told beforehand; what is `None` is as the protocol says."""

    host: str | None = None
    """Address of the robot."""
    command_port: int | None = None
    """Port of commands."""
    data_port: int | None = None
    """Port of streams."""
    connect_timeout: float = 3.0
    """Time for one attempt to connect."""
    call_timeout: float | None = None
    """How long a call waits for its response."""
    reconnect: Backoff | None = field(default_factory=Backoff)
    """How to connect again after a loss; `None` gives up at the first one."""
    keepalive: float | None = 30.0
    """TCP probes after so much silence; `None` switches them off."""
    stall_timeout: float = 10.0
    """Time without progress inside a frame, or while the robot does not read."""
    limits: Limits | None = None
    """Bounds."""
    queued_bytes: int | None = None
    """Most bytes of reports that wait for a receiver."""
    first_id: int | None = None
    """Message id of the first request; the time of day where none is given."""
    gzip: Gzip | None = None
    """When requests are compressed; never where nothing is given."""
    verify_digest: bool = True
    """Whether digests are verified."""
    resync: bool = False
    """Whether to search for the next frame after bytes that are none."""
    ssl: SSLContext | None = None
    """For TLS at both ports; the protocol itself has none."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ServerConfig:
    """What a robot can be told beforehand; what is `None` is as the protocol says."""

    address: str = "0.0.0.0"  # noqa: S104 - a robot listens to all its networks
    """Address to listen at."""
    command_port: int | None = None
    """Port of commands; 0 is any that is free."""
    data_port: int | None = None
    """Port of streams; 0 is any that is free."""
    handler_timeout: float | None = None
    """How long a handler may take before the app is told."""
    max_age: float | None | Literal["spec"] = "spec"
    """Oldest request that is still served, by the time in its envelope; `None` for any."""
    limits: Limits | None = None
    """Bounds."""
    queued_bytes: int | None = None
    """Most bytes of reports that wait for one app."""
    connections_per_address: int = 8
    """Most connections from one address, at each port. Apps behind one router share one."""
    allow: Mapping[str, Collection[Effect]] | None = None
    """Networks, such as `10.0.0.0/24`, that apps may connect from, and what they may call there by effect.

    The smallest network that has the address counts; `None` lets everybody do everything.
    """
    abandoned_handlers: int = 64
    """Handlers that may run on without anybody waiting for their result; 0: none does."""
    memory: int = 256 * 1024 * 1024
    """Bytes that apps may make the robot hold; the connection that holds most is closed then."""
    first_id: int | None = None
    """Message id of the first report to each app; the time of day where none is given."""
    gzip: Gzip | None = None
    """When responses and reports are compressed; never where nothing is given."""
    verify_digest: bool = True
    """Whether digests are verified."""
    resync: bool = False
    """Whether to search for the next frame after bytes that are none."""
    ssl: SSLContext | None = None
    """For TLS at both ports; the protocol itself has none."""
    header_timeout: float = 5.0
    """Time for a header, from its first byte to its last."""
    stall_timeout: float = 30.0
    """Time without progress inside a frame, or while the app does not read."""
    least_rate: int = 1024
    """Fewer bytes per second than this, over the stall timeout, are no progress."""
    idle_timeout: float | None = None
    """Time of silence between frames after which a connection is closed; `None` for any."""
    keepalive: float | None = 30.0
    """TCP probes after so much silence; `None` switches them off."""


def first_id_now() -> int:
    """Where ids begin: the local time of day as the decimal digits `HHmmssSSS`."""
    now = datetime.now()  # noqa: DTZ005 - local time is meant
    return int(f"{now:%H%M%S}{now.microsecond // 1000:03}")
