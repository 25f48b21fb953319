"""A robot on the network: it takes commands, pushes reports until they are acknowledged, and sends streams."""

from __future__ import annotations

import asyncio
import contextlib
import ipaddress
import itertools
import logging
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Final, TypeVar
from typing import Protocol as Interface

from .codec import write_content
from .config import ServerConfig
from .counters import ServerCounters
from .data_peer import AppStreams, DataPeer
from .enveloped import write_request
from .errors import BodyError, FrameError
from .frame import Encoder, frame_bytes, stream_frame
from .link import Patience
from .operations import Effect
from .peer import Peer
from .pushes import (
    Acknowledgement,
    AmbiguousError,
    FramePushError,
    InvalidReportError,
    NoConnectionError,
    Push,
)
from .settings import duration
from .thin import Thin
from .thrown import describe

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from types import TracebackType

    from .context import Context
    from .data_peer import AppStream
    from .link import Link
    from .message import Message
    from .operations import AckPolicy, Report, Stream
    from .protocol import Protocol
    from .robot import Handler, Robot

Q = TypeVar("Q", bound="Message")
B = TypeVar("B", bound="Message | bytes")
T = TypeVar("T", bound="_Member")

_log: Final = logging.getLogger(__name__)
# How often, in bytes received or sent, it is looked at how much is held.
_LOOK_EACH: Final = 256 * 1024


class _Member(Interface):
    """A connection at one of the ports."""

    @property
    def connection(self) -> int: ...
    @property
    def address(self) -> str: ...
    @property
    def held(self) -> int: ...
    @property
    def is_heard(self) -> bool: ...
    @property
    def link(self) -> Link: ...
    def over(self, *, at_once: bool = False) -> None: ...


class Server:
    """Serves a robot at its command port and its data port. Belongs to the event loop in which it is made."""

    def __init__(self, robot: Robot, config: ServerConfig | None = None) -> None:
        """Of a robot; what it does not implement is refused."""
        config = config or ServerConfig()
        protocol = robot.protocol
        self.robot: Final = robot
        self.protocol: Final[Protocol] = protocol
        self.handlers: Final[Mapping[int, Handler]] = robot.handlers_by_code()
        self.config: Final = config
        self.limits: Final = config.limits or protocol.defaults.limits
        self.queued_bytes: Final = self.limits.inflated_bytes if config.queued_bytes is None else config.queued_bytes
        self.counters: Final = ServerCounters()
        self.encoder: Final = Encoder(protocol, self.limits, compress=config.gzip)
        self.loop: Final = asyncio.get_running_loop()
        timeout, max_age = config.handler_timeout, config.max_age
        self.handler_timeout: Final = protocol.defaults.handler_timeout if timeout is None else timeout
        self.max_age: Final = protocol.defaults.max_age if max_age == "spec" else max_age
        self.patience: Final = Patience(
            stall=config.stall_timeout,
            header=config.header_timeout,
            least_rate=config.least_rate,
            idle=config.idle_timeout,
            keepalive=config.keepalive,
        )
        self.app_streams: AppStreams | None = None
        self._allowed: Final = _networks(config.allow)
        self._ids: Final = itertools.count(1)
        self._peers: Final[dict[int, Peer]] = {}
        self._data_peers: Final[dict[int, DataPeer]] = {}
        self._closing: Final[set[Link]] = set()
        self._abandoned: Final[set[asyncio.Task[Any]]] = set()
        self._listening: list[asyncio.Server] = []
        self._lines: Final[dict[str, Thin]] = {}
        self._looked = 0
        self._is_stopping = False
        self._over: Final[asyncio.Future[None]] = self.loop.create_future()

    async def bind(self) -> None:
        """Listen at both ports; then see `command_address` and `data_address`."""
        config, protocol = self.config, self.protocol
        ports = (
            (config.command_port, protocol.command_port, self.accept),
            (
                config.data_port,
                protocol.data_port,
                self.accept_data,
            ),
        )
        try:
            for chosen, usual, accept in ports:
                port = usual if chosen is None else chosen
                self._listening.append(await self.loop.create_server(accept, config.address, port, ssl=config.ssl))
        except BaseException:
            for listening in self._listening:
                listening.close()
            raise

    @property
    def command_address(self) -> tuple[str, int]:
        """Where it listens for commands."""
        return self._address(0)

    @property
    def data_address(self) -> tuple[str, int]:
        """Where it listens for data connections."""
        return self._address(1)

    def _address(self, index: int) -> tuple[str, int]:
        address: tuple[str, int] = self._listening[index].sockets[0].getsockname()[:2]
        return address

    def accept(self) -> asyncio.Protocol:
        """Make the protocol of a new command connection: for `loop.create_server`, for TLS, and for pipes."""
        return Peer(self, next(self._ids)).link

    def accept_data(self) -> asyncio.Protocol:
        """Make the protocol of a new data connection."""
        return DataPeer(self, next(self._ids)).link

    @property
    def connections(self) -> list[tuple[int, str]]:
        """The apps that are connected, and their addresses."""
        return sorted((one.connection, one.address) for one in self._peers.values())

    @property
    def memory(self) -> int:
        """Bytes that apps make the robot hold at this moment."""
        streams = 0 if self.app_streams is None else self.app_streams.held()
        return sum(one.held for one in self._members()) + streams

    def _held_by(self, one: _Member) -> int:
        """Bytes that one connection makes the robot hold."""
        return one.held + (0 if self.app_streams is None else self.app_streams.held(one.connection))

    def _members(self) -> list[_Member]:
        return [*self._peers.values(), *self._data_peers.values()]

    def log(self, cause: str, level: int, text: str, *values: object) -> None:
        """Write a line of the log, unless there have been many of this cause."""
        held = self._lines.setdefault(cause, Thin()).line(self.loop.time())
        if held is not None:
            _log.log(level, "%s: " + text + "%s", self.protocol.name, *values, held)

    def log_end(self, connection: int, address: str, port: str, reason: str) -> None:
        """Log the end of a connection."""
        self.log(
            "ended", logging.INFO, "connection %d from %s ended at the %s port: %s", connection, address, port, reason
        )

    def admit(self, peer: Peer) -> None:
        """Enter a command connection, or close it if it may not be or there are too many."""
        effects = self._effects(peer.address)
        if effects is None:
            peer.over(at_once=True)
            return
        peer.effects = effects
        if not self._admit(self._peers, peer, lambda one: not one.is_heard):
            return
        self.counters.connections += 1
        for data in self._data_peers.values():
            if data.address == peer.address and len(data.owners) < 2:
                data.owners.add(peer.connection)

    def admit_data(self, peer: DataPeer) -> None:
        """Enter a data connection, or close it if it may not be or there are too many."""
        if self._effects(peer.address) is None:
            peer.over(at_once=True)
            return
        # An app that only receives streams is known by its commands.
        speakers = {one.address for one in self._peers.values() if one.is_heard}
        if not self._admit(self._data_peers, peer, lambda one: not one.is_heard and one.address not in speakers):
            return
        self.counters.data_connections += 1
        if self.app_streams is not None and self.app_streams.is_full:
            peer.link.hold("streams")
        peer.owners.update(one.connection for one in self._peers.values() if one.address == peer.address)

    def _effects(self, address: str) -> frozenset[Effect] | None:
        """What may be called from an address; `None` if nobody may connect from there."""
        if self._allowed is None:
            return frozenset(Effect)
        with contextlib.suppress(ValueError):
            known = ipaddress.ip_address(address.partition("%")[0])
            known = getattr(known, "ipv4_mapped", None) or known
            for network, effects in self._allowed:
                if known.version == network.version and known in network:
                    return effects
        self.counters.connections_forbidden += 1
        self.log("forbidden", logging.WARNING, "refused %s: the address is not allowed", address)
        return None

    def _admit(self, table: dict[int, T], peer: T, is_silent: Callable[[T], bool]) -> bool:
        neighbours = [one for one in table.values() if one.address == peer.address]
        crowd = neighbours if len(neighbours) >= self.config.connections_per_address else [*table.values()]
        if self._is_stopping:
            peer.over(at_once=True)
            return False
        if crowd is neighbours or len(table) >= self.limits.connections:
            silent = [one for one in crowd if is_silent(one)]
            if not silent:
                self.counters.connections_refused += 1
                self.log("refused", logging.WARNING, "refused %s: too many connections", peer.address)
                peer.over(at_once=True)
                return False
            count = {one.address: 0 for one in silent}
            for one in table.values():
                if one.address in count:
                    count[one.address] += 1
            goes = max(silent, key=lambda one: (count[one.address], -one.connection))
            self.counters.connections_displaced += 1
            text = "%s takes the place of %s, which was silent"
            self.log("displaced", logging.WARNING, text, peer.address, goes.address)
            goes.over(at_once=True)
        table[peer.connection] = peer
        self.log("connected", logging.INFO, "connection %d from %s", peer.connection, peer.address)
        return True

    def gone(self, peer: Peer) -> None:
        """Forget a command connection that has ended."""
        self._peers.pop(peer.connection, None)
        self._close(peer.link)

    def gone_data(self, peer: DataPeer) -> None:
        """Forget a data connection that has ended."""
        self._data_peers.pop(peer.connection, None)
        self._close(peer.link)

    def _close(self, link: Link) -> None:
        if not link.gone.done():
            self._closing.add(link)
            link.gone.add_done_callback(lambda _: self._closing.discard(link))

    def count_bytes(self, received: int, sent: int) -> None:
        """Note bytes that have come or gone, and look now and then at how much is held."""
        self.counters.bytes_in += received
        self.counters.bytes_out += sent
        self.look_at_memory(received + sent)

    def look_at_memory(self, more: int) -> None:
        """Note that more bytes may be held, and look now and then at how much is."""
        self._looked += more
        if self._looked < _LOOK_EACH:
            return
        self._looked = 0
        # An eighth is kept for what is read and answered at a moment.
        if self.memory > self.config.memory - self.config.memory // 8:
            most = max(self._members(), key=self._held_by, default=None)
            if most is None:
                return
            self.counters.connections_evicted += 1
            text = "closed %s, which held %d bytes: memory is short"
            self.log("evicted", logging.WARNING, text, most.address, self._held_by(most))
            most.over(at_once=True)
            if self.app_streams is not None:
                self.app_streams.drop(most.connection)

    @property
    def is_abandoned_full(self) -> bool:
        """Whether as many handlers run on as may."""
        return 0 < self.config.abandoned_handlers <= len(self._abandoned)

    def tell_failure(self, what: str, error: BaseException, context: Context, handler: Any) -> None:
        """Log an error of a handler by its class and place, and pass it to `on_handler_error`."""
        known = self.protocol.commands_by_code.get(context.code)
        # All codes without a command are one cause: an app chooses them.
        cause = f"{what} {'' if known is None else known.name}"
        self._log_failure(cause, what % (f"0x{context.code:04X}" if known is None else known.name), error, handler)
        hook = self.config.on_handler_error
        if hook is None:
            return
        try:
            hook(error, context)
        except Exception as failed:  # noqa: BLE001 - whatever it is, it is the robot's own
            self._log_failure("hook", "`on_handler_error` failed", failed, hook)

    def _log_failure(self, cause: str, what: str, error: BaseException, function: Any) -> None:
        # The error's own text may hold what was received.
        self.log(cause, logging.ERROR, "%s: %s", what, describe(error, function))
        _log.debug("%s: %s", self.protocol.name, what, exc_info=error)

    def abandon(self, task: asyncio.Task[Any], context: Context) -> None:
        """Nobody waits for a handler any more: what only asks is cancelled, what moves something runs to its end."""
        context.abandon()
        if context.effect in (Effect.READ, Effect.CONFIG) or self.config.abandoned_handlers == 0:
            task.cancel()
            return
        self.counters.handlers_abandoned += 1
        self._abandoned.add(task)
        task.add_done_callback(self._abandoned.discard)

    async def push(self, report: Report[Q], message: Q, to: int | None = None) -> list[Acknowledgement]:
        """Send a report to all apps, or to one, until it is acknowledged. Raises `PushError`.

        It is queued before this first waits: to cancel it only means not to hear of the acknowledgements.
        """
        if report.code is None:
            raise ValueError(f"{report.name} has no code yet")
        self.protocol.layout.check_code("code", report.code)
        if to is not None and to not in self._peers:
            raise NoConnectionError(to)
        try:
            prepared = self.encoder.prepare(write_request(self.protocol, report.request, message))
        except BodyError as error:
            raise InvalidReportError(error) from None
        except FrameError as error:
            raise FramePushError(error) from None
        policy = report.ack or self.protocol.defaults.ack
        peers = [one for one in self._peers.values() if to in (None, one.connection)]
        pushes = [
            Push(report.code, _spread(policy, one.connection), prepared, one.connection, self.loop.create_future())
            for one in peers
        ]
        for peer, push in zip(peers, pushes, strict=True):
            peer.push(push)
        return [await asyncio.shield(push.ended) for push in pushes]

    def streams(self) -> AppStreams:
        """The frames of raw bytes that apps send from now on; a later call takes over.

        While nobody takes them, they are dropped and counted; while the receiver is busy, apps are not read.
        """
        if self.app_streams is not None:
            self.app_streams.end()
        self.app_streams = AppStreams(self.queued_bytes, self._read_streams)
        return self.app_streams

    def put_stream(self, frame: AppStream) -> None:
        """Hand on a frame of raw bytes, or drop it while nobody takes them."""
        self.counters.stream_frames_in += 1
        streams = self.app_streams
        if streams is None:
            self.counters.stream_frames_dropped += 1
            return
        streams.put(frame)
        self.look_at_memory(len(frame.data))
        if streams.is_full:
            for peer in self._data_peers.values():
                peer.link.hold("streams")

    def _read_streams(self) -> None:
        if self.app_streams is not None and self.app_streams.is_full:
            return
        for peer in self._data_peers.values():
            peer.link.let_go("streams")

    async def send_stream(self, stream: Stream[B], message_id: int, content: B, to: int | None = None) -> int:
        """Send a frame of one of the robot's streams; all else is as with `send_data`."""
        if stream.code is None:
            raise ValueError(f"{stream.name} has no code yet")
        try:
            data = write_content(stream.body, content)
        except BodyError as error:
            raise InvalidReportError(error) from None
        return await self.send_data(stream.code, message_id, data, to)

    async def send_data(self, code: int, message_id: int, data: bytes, to: int | None = None) -> int:
        """Send a frame of raw bytes to the data connections of one app, or of all. Raises `PushError`.

        Gives how many took it. An app is named by a data connection, or by its command connection: the protocol ties
        the two by nothing but the address, so that is only possible while it is the only app there; otherwise
        `AmbiguousError`, and nothing is sent.
        """
        frame = stream_frame(self.protocol, code, message_id)
        peers = self._data_audience(to)
        try:
            prepared = self.encoder.prepare(frame_bytes(data))
        except FrameError as error:
            raise FramePushError(error) from None
        sending = [self.loop.create_task(one.send(frame, prepared)) for one in peers]
        if not sending:
            return 0
        done, late = await asyncio.wait(sending, timeout=self.config.stall_timeout)
        for task in late:
            task.cancel()
        return sum(task.result() for task in done)

    def _data_audience(self, to: int | None) -> list[DataPeer]:
        if to is None:
            return [*self._data_peers.values()]
        if to in self._data_peers:
            return [self._data_peers[to]]
        app = self._peers.get(to)
        if app is None:
            raise NoConnectionError(to)
        near = [one for one in self._data_peers.values() if one.address == app.address]
        own = [one for one in near if one.owners == {to}]
        if not own:
            raise AmbiguousError(to) if near else NoConnectionError(to)
        return own

    async def run(self) -> None:
        """Wait until the robot has been shut down."""
        await asyncio.shield(self._over)

    async def shutdown(self, grace: float) -> None:
        """Take no more requests, answer those there are within the grace, and end. Never takes longer than that."""
        duration("grace", grace)
        deadline = self.loop.time() + grace
        self._is_stopping = True
        for listening in self._listening:
            listening.close()
        tasks = {task for peer in self._peers.values() for task in peer.tasks} | self._abandoned
        for peer in [*self._peers.values()]:
            peer.drain()
        if tasks:
            await asyncio.wait(tasks, timeout=grace)
            # What they have answered is sent in the next turn.
            await asyncio.sleep(0)
        for peer in [*self._peers.values()]:
            peer.over()
        for data in [*self._data_peers.values()]:
            data.over()
        for task in [*self._abandoned]:
            task.cancel()
        if self.app_streams is not None:
            self.app_streams.end()
        if self._closing:
            await asyncio.wait({one.gone for one in self._closing}, timeout=max(0.0, deadline - self.loop.time()))
            for link in [*self._closing]:
                link.abort()
        if not self._over.done():
            self._over.set_result(None)

    async def __aenter__(self) -> Server:
        """Listen at both ports."""
        await self.bind()
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """End at once."""
        await self.shutdown(0)


def _spread(policy: AckPolicy, connection: int) -> AckPolicy:
    """Waits a little longer by connection, so that repetitions to many apps do not coincide."""
    return replace(policy, timeout=policy.timeout * (1 + (connection % 32) / 256))


def _networks(
    allow: Mapping[str, Any] | None,
) -> list[tuple[ipaddress.IPv4Network | ipaddress.IPv6Network, frozenset[Effect]]] | None:
    """The networks, those first that hold fewest addresses."""
    if allow is None:
        return None
    networks = [(ipaddress.ip_network(network), frozenset(effects)) for network, effects in allow.items()]
    return sorted(networks, key=lambda one: -one[0].prefixlen)
