"""Configuration of a client and of a robot. Times are in seconds."""

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
    from .ended import EndedCall
    from .settings import Check


@dataclass(frozen=True, slots=True, kw_only=True)
class Backoff:
    """Waits between attempts to connect."""

    first: float = 0.1
    """The first wait."""
    longest: float = 10.0
    """The longest wait. Each wait is twice the one before, minus a random part of up to a quarter."""
    attempts: int | None = None
    """Failed attempts in a row after which the client gives up; `None` for never."""

    def __post_init__(self) -> None:
        """Checks every setting. Raises `TypeError` and `ValueError`."""
        check_all(self, _BACKOFF)


@dataclass(frozen=True, slots=True, kw_only=True)
class ClientConfig:
    """Configuration of a client. `None` means the protocol's default."""

    host: str | None = None
    """Address of the robot."""
    command_port: int | None = None
    """Port of commands."""
    data_port: int | None = None
    """Port of streams."""
    connect_timeout: float = 3.0
    """Time for one attempt to connect."""
    call_timeout: float | None = None
    """Time a call waits for its response."""
    reconnect: Backoff | None = field(default_factory=Backoff)
    """Waits between attempts to connect after a loss; `None` gives up at the first one."""
    keepalive: float | None = 30.0
    """Silence before TCP probes; `None` for no probes."""
    stall_timeout: float = 10.0
    """Time without progress inside a frame, or while the robot does not read."""
    limits: Limits | None = None
    """Limits."""
    queued_bytes: int | None = None
    """Most bytes of reports waiting for a receiver."""
    first_id: int | None = None
    """Message id of the first request; `None` for the time of day."""
    gzip: Gzip | None = None
    """Compression of requests; `None` for none."""
    verify_digest: bool = True
    """Verifies digests."""
    resync: bool = False
    """Searches for the next frame after invalid bytes."""
    ssl: SSLContext | None = None
    """TLS at both ports; the protocol has none."""
    on_call: Callable[[EndedCall], None] | None = None
    """Receives the end of each call, for metrics. An exception of this function is logged and ignored."""

    def __post_init__(self) -> None:
        """Checks every setting. Raises `TypeError` and `ValueError`."""
        check_all(self, _CLIENT)


@dataclass(frozen=True, slots=True, kw_only=True)
class ServerConfig:
    """Configuration of a robot. `None` means the protocol's default."""

    address: str = "0.0.0.0"  # noqa: S104 - a robot listens to all its networks
    """Address to listen on."""
    command_port: int | None = None
    """Port of commands; 0 for any free port."""
    data_port: int | None = None
    """Port of streams; 0 for any free port."""
    handler_timeout: float | None = None
    """Time a handler may take before the app gets the result for a timeout."""
    max_age: float | None | Literal["spec"] = "spec"
    """Oldest request that is still served, by the time in its envelope; `None` for any."""
    limits: Limits | None = None
    """Limits."""
    queued_bytes: int | None = None
    """Most bytes of reports waiting for one app."""
    connections_per_address: int = 8
    """Most connections from one address, at each port. Apps behind one router share an address."""
    allow: Mapping[str, Collection[Effect]] | None = None
    """Networks that apps may connect from, such as `10.0.0.0/24`, with the effects of the commands that they may call.

    The smallest matching network counts. `None` allows everything to every address.
    """
    abandoned_handlers: int = 64
    """Most handlers that may still run after their result is no longer awaited; 0 for none."""
    memory: int = 256 * 1024 * 1024
    """Most bytes held for apps. Beyond it, the connection that holds most is closed."""
    first_id: int | None = None
    """Message id of the first report to each app; `None` for the time of day."""
    gzip: Gzip | None = None
    """Compression of responses and reports; `None` for none."""
    verify_digest: bool = True
    """Verifies digests."""
    resync: bool = False
    """Searches for the next frame after invalid bytes."""
    ssl: SSLContext | None = None
    """TLS at both ports; the protocol has none."""
    header_timeout: float = 5.0
    """Time for a header, from its first byte to its last."""
    stall_timeout: float = 30.0
    """Time without progress inside a frame, or while the app does not read."""
    least_rate: int = 1024
    """Least bytes per second that count as progress, averaged over the stall timeout."""
    idle_timeout: float | None = None
    """Silence between frames after which a connection is closed; `None` for any."""
    keepalive: float | None = 30.0
    """Silence before TCP probes; `None` for no probes."""
    on_handler_error: Callable[[BaseException, Context], None] | None = None
    """Receives each error of a handler.

    That is an exception other than a `Refusal`, also after the timeout, or the error of an invalid response. It may
    quote the request. The log has only its class and place. An exception of this function is logged and ignored.
    """
    on_call: Callable[[EndedCall], None] | None = None
    """Receives the end of each call, for metrics. An exception of this function is logged and ignored."""

    def __post_init__(self) -> None:
        """Checks every setting. Raises `TypeError` and `ValueError`."""
        check_all(self, _SERVER)


def _networks(name: str, value: Any) -> None:
    """Checks the effects of each network."""
    if not isinstance(value, Mapping):
        raise TypeError(wrong(name, value, "effects by network"))
    for network, effects in cast("dict[Any, Any]", value).items():
        network_expected = "a network such as '10.0.0.0/24'"
        # `ip_network` would accept an integer as an address.
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
    "on_call": or_none(function),
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
    "on_call": or_none(function),
}


def first_id_now() -> int:
    """Returns the first message id: the local time of day as the decimal digits `HHmmssSSS`."""
    now = datetime.now()  # noqa: DTZ005 - local time is meant
    return int(f"{now:%H%M%S}{now.microsecond // 1000:03}")
