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
from .ended import EndedCall
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
# Bytes received or sent between two checks of the memory limit.
_LOOK_EACH: Final = 256 * 1024


class _Member(Interface):
    """A connection to one of the ports."""

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
    """Serves a robot at its command port and its data port. It belongs to the event loop that it is created in."""

    def __init__(self, robot: Robot, config: ServerConfig | None = None) -> None:
        """Creates the server of a robot. Commands that the robot does not implement are refused."""
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
        """Listens on both ports; then see `command_address` and `data_address`."""
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
        """Address that it listens on for commands."""
        return self._address(0)

    @property
    def data_address(self) -> tuple[str, int]:
        """Address that it listens on for data connections."""
        return self._address(1)

    def _address(self, index: int) -> tuple[str, int]:
        address: tuple[str, int] = self._listening[index].sockets[0].getsockname()[:2]
        return address

    def accept(self) -> asyncio.Protocol:
        """Creates the asyncio protocol of a new command connection: for `loop.create_server`, TLS and pipes."""
        return Peer(self, next(self._ids)).link

    def accept_data(self) -> asyncio.Protocol:
        """Creates the asyncio protocol of a new data connection."""
        return DataPeer(self, next(self._ids)).link

    @property
    def connections(self) -> list[tuple[int, str]]:
        """The connected apps, with their addresses."""
        return sorted((one.connection, one.address) for one in self._peers.values())

    @property
    def memory(self) -> int:
        """Bytes held for apps at present."""
        streams = 0 if self.app_streams is None else self.app_streams.held()
        return sum(one.held for one in self._members()) + streams

    def _held_by(self, one: _Member) -> int:
        """Returns the bytes held for one connection."""
        return one.held + (0 if self.app_streams is None else self.app_streams.held(one.connection))

    def _members(self) -> list[_Member]:
        return [*self._peers.values(), *self._data_peers.values()]

    def log(self, cause: str, level: int, text: str, *values: object) -> None:
        """Writes a line of the log, unless this cause has had many."""
        held = self._lines.setdefault(cause, Thin()).line(self.loop.time())
        if held is not None:
            _log.log(level, "%s: " + text + "%s", self.protocol.name, *values, held)

    def log_end(self, connection: int, address: str, port: str, reason: str) -> None:
        """Logs the end of a connection."""
        self.log(
            "ended", logging.INFO, "connection %d from %s ended at the %s port: %s", connection, address, port, reason
        )

    def admit(self, peer: Peer) -> None:
        """Adds a command connection, or closes it if its address is not allowed or there are too many."""
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
        """Adds a data connection, or closes it if its address is not allowed or there are too many."""
        if self._effects(peer.address) is None:
            peer.over(at_once=True)
            return
        # A data connection that only receives counts as active if its address also sends commands.
        speakers = {one.address for one in self._peers.values() if one.is_heard}
        if not self._admit(self._data_peers, peer, lambda one: not one.is_heard and one.address not in speakers):
            return
        self.counters.data_connections += 1
        if self.app_streams is not None and self.app_streams.is_full:
            peer.link.hold("streams")
        peer.owners.update(one.connection for one in self._peers.values() if one.address == peer.address)

    def _effects(self, address: str) -> frozenset[Effect] | None:
        """Returns the effects allowed from an address; `None` if it may not connect."""
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
        """Removes a command connection that has ended."""
        self._peers.pop(peer.connection, None)
        self._close(peer.link)

    def gone_data(self, peer: DataPeer) -> None:
        """Removes a data connection that has ended."""
        self._data_peers.pop(peer.connection, None)
        self._close(peer.link)

    def _close(self, link: Link) -> None:
        if not link.gone.done():
            self._closing.add(link)
            link.gone.add_done_callback(lambda _: self._closing.discard(link))

    def count_bytes(self, received: int, sent: int) -> None:
        """Counts bytes received or sent, and checks the memory limit now and then."""
        self.counters.bytes_in += received
        self.counters.bytes_out += sent
        self.look_at_memory(received + sent)

    def look_at_memory(self, more: int) -> None:
        """Notes that more bytes may be held, and checks the memory limit now and then."""
        self._looked += more
        if self._looked < _LOOK_EACH:
            return
        self._looked = 0
        # An eighth is reserved for requests and responses being handled.
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
        """`True` if the most abandoned handlers run."""
        return 0 < self.config.abandoned_handlers <= len(self._abandoned)

    def tell_failure(self, what: str, error: BaseException, context: Context, handler: Any) -> None:
        """Logs an error of a handler by its class and place, and passes it to `on_handler_error`."""
        known = self.protocol.commands_by_code.get(context.code)
        # All codes without a command count as one cause, since apps choose them.
        cause = f"{what} {'' if known is None else known.name}"
        self._log_failure(cause, what % (f"0x{context.code:04X}" if known is None else known.name), error, handler)
        hook = self.config.on_handler_error
        if hook is None:
            return
        try:
            hook(error, context)
        except Exception as failed:  # noqa: BLE001 - whatever it is, it is the robot's own
            self._log_failure("hook", "`on_handler_error` failed", failed, hook)

    def call_ended(self, code: int, result: str, since: float) -> None:
        """Tells `on_call` that a call has ended which came at `since`."""
        hook = self.config.on_call
        if hook is None:
            return
        known = self.protocol.commands_by_code.get(code)
        call = EndedCall("unknown" if known is None else known.name, result, self.loop.time() - since)
        try:
            hook(call)
        except Exception as failed:  # noqa: BLE001 - whatever it is, it is the robot's own
            self._log_failure("on_call", "`on_call` failed", failed, hook)

    def _log_failure(self, cause: str, what: str, error: BaseException, function: Any) -> None:
        # The error's text may quote received data.
        self.log(cause, logging.ERROR, "%s: %s", what, describe(error, function))
        _log.debug("%s: %s", self.protocol.name, what, exc_info=error)

    def abandon(self, task: asyncio.Task[Any], context: Context) -> None:
        """Abandons a handler. It is cancelled for the effects `read` and `config`, or if none may run on. Others run to
        their end.
        """
        context.abandon()
        if context.effect in (Effect.READ, Effect.CONFIG) or self.config.abandoned_handlers == 0:
            task.cancel()
            return
        self.counters.handlers_abandoned += 1
        self._abandoned.add(task)
        task.add_done_callback(self._abandoned.discard)

    async def push(self, report: Report[Q], message: Q, to: int | None = None) -> list[Acknowledgement]:
        """Sends a report to all apps, or to one, until it is acknowledged. Raises `PushError`.

        The report is queued before the first wait. Cancelling the call only loses the acknowledgements.
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
        """Returns the frames of raw bytes that apps send from now on. A later call takes over.

        Without a receiver, frames are dropped and counted. While the receiver is busy, nothing is read from apps.
        """
        if self.app_streams is not None:
            self.app_streams.end()
        self.app_streams = AppStreams(self.queued_bytes, self._read_streams)
        return self.app_streams

    def put_stream(self, frame: AppStream) -> None:
        """Delivers a frame of raw bytes, or drops it without a receiver."""
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
        """Sends a frame of a robot's stream, as `send_data` does."""
        if stream.code is None:
            raise ValueError(f"{stream.name} has no code yet")
        try:
            data = write_content(stream.body, content)
        except BodyError as error:
            raise InvalidReportError(error) from None
        return await self.send_data(stream.code, message_id, data, to)

    async def send_data(self, code: int, message_id: int, data: bytes, to: int | None = None) -> int:
        """Sends a frame of raw bytes to the data connections of one app, or of all. Raises `PushError`.

        Returns the number of connections that took it. `to` is a data connection or a command connection. Only the
        address ties the two together. If several apps share it, nothing is sent, with `AmbiguousError`.
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
        """Waits until the robot has been shut down."""
        await asyncio.shield(self._over)

    async def shutdown(self, grace: float) -> None:
        """Ends the robot: takes no more requests and responds to the present ones. Returns after `grace` seconds at the
        latest.
        """
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
            # Their responses are sent in the next turn.
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
        """Listens on both ports."""
        await self.bind()
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Ends at once."""
        await self.shutdown(0)


def _spread(policy: AckPolicy, connection: int) -> AckPolicy:
    """Lengthens the wait a little by connection, so that repetitions to many apps do not coincide."""
    return replace(policy, timeout=policy.timeout * (1 + (connection % 32) / 256))


def _networks(
    allow: Mapping[str, Any] | None,
) -> list[tuple[ipaddress.IPv4Network | ipaddress.IPv6Network, frozenset[Effect]]] | None:
    """Returns the networks, smallest first."""
    if allow is None:
        return None
    networks = [(ipaddress.ip_network(network), frozenset(effects)) for network, effects in allow.items()]
    return sorted(networks, key=lambda one: -one[0].prefixlen)
