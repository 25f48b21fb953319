"""What a client and a robot can be told beforehand. Times are in seconds."""

from __future__ import annotations

import ipaddress
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from datetime import datetime
from ssl import SSLContext
from typing import TYPE_CHECKING, Any, Final, Literal, cast

from .frame import Gzip
from .operations import Effect
from .protocol import Limits
from .settings import (
    check_all,
    duration,
    flag,
    function,
    host,
    integer,
    keepalive,
    of_type,
    or_none,
    or_word,
    wrong,
)

if TYPE_CHECKING:
    from collections.abc import Callable

    from .context import Context
    from .settings import Check


@dataclass(frozen=True, slots=True, kw_only=True)
class Backoff:
    """How long to wait before connecting again."""

    first: float = 0.1
    """Before the first attempt."""
    longest: float = 10.0
    """Longest wait; each is twice the one before, minus up to a quarter at random."""
    attempts: int | None = None
    """Failed attempts in a row after which the connection is given up; `None`: never."""

    def __post_init__(self) -> None:
        """Checks every setting. Raises `TypeError` and `ValueError`."""
        check_all(self, _BACKOFF)


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

    def __post_init__(self) -> None:
        """Checks every setting. Raises `TypeError` and `ValueError`."""
        check_all(self, _CLIENT)


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
    on_handler_error: Callable[[BaseException, Context], None] | None = None
    """Is called with each error of a handler.

    That is what it raised besides a `Refusal`, also after its timeout, or why its response cannot be sent. The error
    may quote the request. The log has only its class and place. What this function raises is logged and ignored.
    """

    def __post_init__(self) -> None:
        """Checks every setting. Raises `TypeError` and `ValueError`."""
        check_all(self, _SERVER)


def _networks(name: str, value: Any) -> None:
    """Checks what may be called from which networks."""
    if not isinstance(value, Mapping):
        raise TypeError(wrong(name, value, "effects by network"))
    for network, effects in cast("dict[Any, Any]", value).items():
        network_expected = "a network such as '10.0.0.0/24'"
        # An integer would be an address, too.
        if not isinstance(network, str):
            raise TypeError(wrong(name, network, network_expected))
        try:
            ipaddress.ip_network(network)
        except ValueError:
            raise ValueError(wrong(name, network, network_expected)) from None
        is_collection = isinstance(effects, Collection)
        if not is_collection or not all(isinstance(one, Effect) for one in cast("Collection[Any]", effects)):
            raise TypeError(wrong(f"{name}[{network!r}]", cast("object", effects), "a collection of `Effect`"))


_PORT: Final = integer(1, 65_535)
_FREE_PORT: Final = integer(0, 65_535)
_LIMITS: Final = or_none(of_type(Limits, "`Limits`"))
_GZIP: Final = or_none(of_type(Gzip, "`Gzip`"))
_SSL: Final = or_none(of_type(SSLContext, "an `SSLContext`"))

_BACKOFF: Final[Mapping[str, Check]] = {
    "first": duration,
    "longest": duration,
    "attempts": or_none(integer(0)),
}

_CLIENT: Final[Mapping[str, Check]] = {
    "host": or_none(host),
    "command_port": or_none(_PORT),
    "data_port": or_none(_PORT),
    "connect_timeout": duration,
    "call_timeout": or_none(duration),
    "reconnect": or_none(of_type(Backoff, "`Backoff`")),
    "keepalive": or_none(keepalive),
    "stall_timeout": duration,
    "limits": _LIMITS,
    "queued_bytes": or_none(integer(0)),
    "first_id": or_none(integer(0)),
    "gzip": _GZIP,
    "verify_digest": flag,
    "resync": flag,
    "ssl": _SSL,
}

_SERVER: Final[Mapping[str, Check]] = {
    "address": host,
    "command_port": or_none(_FREE_PORT),
    "data_port": or_none(_FREE_PORT),
    "handler_timeout": or_none(duration),
    "max_age": or_word("spec", duration),
    "limits": _LIMITS,
    "queued_bytes": or_none(integer(0)),
    "connections_per_address": integer(1),
    "allow": or_none(_networks),
    "abandoned_handlers": integer(0),
    "memory": integer(0),
    "first_id": or_none(integer(0)),
    "gzip": _GZIP,
    "verify_digest": flag,
    "resync": flag,
    "ssl": _SSL,
    "header_timeout": duration,
    "stall_timeout": duration,
    "least_rate": integer(0),
    "idle_timeout": or_none(duration),
    "keepalive": or_none(keepalive),
    "on_handler_error": or_none(function),
}


def first_id_now() -> int:
    """Where ids begin: the local time of day as the decimal digits `HHmmssSSS`."""
    now = datetime.now()  # noqa: DTZ005 - local time is meant
    return int(f"{now:%H%M%S}{now.microsecond // 1000:03}")
