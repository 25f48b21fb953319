"""A robot: takes commands, answers them in tasks of their own, and pushes reports until they are acknowledged."""

from __future__ import annotations

import asyncio
import itertools
import logging
import time
from collections import deque
from dataclasses import dataclass, replace
from enum import Enum
from typing import TYPE_CHECKING, Final, TypeVar

from .calls import Refusal
from .config import ServerConfig, first_id_now
from .enveloped import read_request, read_response, write_request, write_response
from .errors import BodyError, FrameError
from .frame import Decoder, Encoder, Frame, FrameId, Prepared
from .link import Link
from .operations import AckPolicy, Effect
from .protocol import ResultText
from .session import Incoming, Session

if TYPE_CHECKING:
    from .message import Message
    from .operations import Report, Stream
    from .protocol import Protocol
    from .robot import Handler, Robot

Q = TypeVar("Q", bound="Message")
B = TypeVar("B", bound="Message | bytes")

_log: Final = logging.getLogger(__name__)


class Outcome(str, Enum):
    """What has become of a report on its way to one app."""

    ACKNOWLEDGED = "acknowledged"
    """The app has it."""
    REFUSED = "refused"
    """The app has refused it."""
    INVALID = "invalid"
    """The app's answer is no acknowledgement."""
    TIMED_OUT = "timed_out"
    """No acknowledgement came, for all repetitions."""
    DROPPED = "dropped"
    """It made way before it was sent: the app is slow."""
    CLOSED = "closed"
    """The connection ended first."""


@dataclass(frozen=True, slots=True)
class Acknowledgement:
    """What has become of a report on its way to one app."""

    connection: int
    """The app's connection."""
    outcome: Outcome
    """What has become of it."""


class Context:
    """Which request a handler is working on."""

    __slots__ = ("_abandoned", "address", "code", "connection", "id")

    def __init__(self, connection: int, address: str, code: int, message_id: int) -> None:
        """Of one request."""
        self.connection: Final = connection
        """The app's connection."""
        self.address: Final = address
        """The app's address."""
        self.code: Final = code
        """Command code."""
        self.id: Final = message_id
        """Message id."""
        self._abandoned = asyncio.Event()

    @property
    def is_abandoned(self) -> bool:
        """Whether nobody waits for the result any more."""
        return self._abandoned.is_set()

    async def abandoned(self) -> None:
        """Wait until nobody waits for the result any more."""
        await self._abandoned.wait()

    def abandon(self) -> None:
        """Nobody waits for the result any more."""
        self._abandoned.set()


@dataclass(slots=True)
class ServerCounters:
    """What has happened since the robot was made."""

    connections: int = 0
    """Connections taken."""
    connections_refused: int = 0
    """Connections closed at once, for there are too many."""
    bad_frames: int = 0
    """Frames that cannot be read."""
    calls: int = 0
    """Requests answered."""
    calls_timed_out: int = 0
    """Requests whose handler gave no result in time."""
    calls_not_implemented: int = 0
    """Requests that the robot does not implement."""
    handlers_panicked: int = 0
    """Handlers that raised something other than a refusal."""
    handlers_abandoned: int = 0
    """Handlers that ran on without anybody waiting for their result."""
    in_flight_reached: int = 0
    """How often a connection was not read, for it has too many requests in flight."""
    reports_sent: int = 0
    """Reports sent for the first time."""
    reports_repeated: int = 0
    """Reports sent again."""
    reports_acknowledged: int = 0
    """Reports acknowledged."""
    reports_dropped: int = 0
    """Reports that made way before they were sent."""


@dataclass(slots=True, eq=False)
class _Push:
    code: int
    policy: AckPolicy
    prepared: Prepared
    outcome: asyncio.Future[Outcome]

    def end(self, outcome: Outcome) -> None:
        if not self.outcome.done():
            self.outcome.set_result(outcome)


class _Peer:
    """One app's connection."""

    def __init__(self, server: Server, connection: int) -> None:
        config, protocol, limits = server.config, server.protocol, server.limits
        first_id = first_id_now() if config.first_id is None else config.first_id
        self.server: Final = server
        self.connection: Final = connection
        self.session: Final[Session[_Push]] = Session(protocol, limits, protocol.defaults.ack, first_id)
        self.queue: Final[deque[_Push]] = deque()
        self.handlers: Final[dict[asyncio.Task[Message], tuple[Context, Effect]]] = {}
        self.waiting: Final[set[asyncio.Task[None]]] = set()
        self.is_deaf = False
        self.is_over = False
        self.timer: asyncio.TimerHandle | None = None
        decoder = Decoder(protocol, limits, verify_digest=config.verify_digest, resync=config.resync)
        self.link: Final = Link(
            decoder, config.stall_timeout, config.keepalive, self.arrive, self.arrive_broken, self.ended
        )

    def arrive(self, _: Link, frame: Frame) -> None:
        protocol, results = self.server.protocol, self.server.protocol.results
        if self.is_deaf:
            return
        meaning, push = self.session.receive(frame.id, frame.fingerprint, self.server.loop.time())
        if meaning is Incoming.COMMAND:
            task = self.server.loop.create_task(self.handle(frame))
            self.waiting.add(task)
            task.add_done_callback(self.handled)
            if len(self.waiting) >= self.server.limits.in_flight:
                self.server.counters.in_flight_reached += 1
                self.link.pause()
        elif meaning is Incoming.ANSWER and push is not None:
            try:
                read_response(protocol, None, frame.data, self.server.limits)
            except Refusal:
                push.end(Outcome.REFUSED)
            except BodyError:
                push.end(Outcome.INVALID)
            else:
                self.server.counters.reports_acknowledged += 1
                push.end(Outcome.ACKNOWLEDGED)
            self.pump()
        elif meaning is not Incoming.LATE:
            # Robots take no reports, and streams have a port of their own.
            self.answer(frame.id, results.protocol)

    def arrive_broken(self, _: Link, error: FrameError) -> None:
        self.server.counters.bad_frames += 1
        assert error.frame is not None
        if not error.frame.response:
            self.answer(error.frame, self.server.protocol.results.protocol)

    def handled(self, task: asyncio.Task[None]) -> None:
        self.waiting.discard(task)
        if not self.is_deaf and len(self.waiting) < self.server.limits.in_flight:
            self.link.resume()
        self.end_if_drained()

    async def handle(self, frame: Frame) -> None:
        """Answer a request."""
        server, results = self.server, self.server.protocol.results
        code = frame.id.code
        command, handler = server.protocol.commands_by_code.get(code), server.handlers.get(code)
        if command is None:
            self.answer(frame.id, results.protocol)
            return
        try:
            at, request = read_request(server.protocol, command.request, frame.data, server.limits)
        except BodyError as error:
            self.answer(frame.id, _because(results.invalid, error))
            return
        max_age = server.protocol.defaults.max_age
        if max_age is not None and at is not None and time.time() - at / 1000 > max_age:
            self.answer(frame.id, results.expired)
            return
        if handler is None:
            server.counters.calls_not_implemented += 1
            _log.warning("%s: %s is not implemented", server.protocol.name, command.name)
            self.answer(frame.id, _because(results.protocol, "not implemented"))
            return
        context = Context(self.connection, self.link.peer, code, frame.id.id)
        task = server.loop.create_task(_run(handler, context, request))
        self.handlers[task] = context, command.effect
        done, _ = await asyncio.wait({task}, timeout=server.handler_timeout)
        self.handlers.pop(task, None)
        if not done:
            server.counters.calls_timed_out += 1
            server.abandon(task, context, command.effect)
            self.answer(frame.id, results.timeout)
            return
        try:
            response = task.result()
            self.answer(frame.id, results.success, response)
        except Refusal as refusal:
            self.answer(frame.id, ResultText(refusal.code, refusal.text))
        except (BodyError, FrameError) as error:
            _log.error("%s: the response to %s breaks the spec: %s", server.protocol.name, command.name, error.name)  # noqa: TRY400
            self.answer(frame.id, results.protocol)
        except (Exception, asyncio.CancelledError):
            if not self.is_over:
                server.counters.handlers_panicked += 1
                _log.exception("%s: the handler of %s failed", server.protocol.name, command.name)
                self.answer(frame.id, _because(results.protocol, "the handler panicked"))

    def answer(self, frame: FrameId, result: ResultText, message: Message | None = None) -> None:
        """Send a response."""
        protocol = self.server.protocol
        if self.is_over or (message is None and not protocol.has_result):
            return
        data = write_response(protocol, result, message)
        self.link.send(self.server.encoder.encode(frame.answer(), data))
        self.server.counters.calls += 1

    def push(self, push: _Push) -> None:
        """Queue a report; the oldest ones make way."""
        if self.is_over:
            push.end(Outcome.CLOSED)
            return
        self.queue.append(push)
        self.pump()
        while len(self.queue) > self.server.limits.queued_reports:
            self.queue.popleft().end(Outcome.DROPPED)
            self.server.counters.reports_dropped += 1

    def pump(self) -> None:
        """Send reports again that are due, and those that have room now."""
        now, counters = self.server.loop.time(), self.server.counters
        if self.is_over:
            return
        while due := self.session.due(now):
            if due.again:
                counters.reports_repeated += 1
                self.link.send(self.server.encoder.frame(due.frame, due.token.prepared))
            else:
                due.token.end(Outcome.TIMED_OUT)
        while self.queue and not self.session.is_full and not self.is_deaf:
            push = self.queue.popleft()
            frame = self.session.open(self.server.protocol.report, push.code, push.policy, now, push)
            counters.reports_sent += 1
            self.link.send(self.server.encoder.frame(frame, push.prepared))
        due_at = self.session.next_due
        if self.timer is not None:
            self.timer.cancel()
        self.timer = None if due_at is None else self.server.loop.call_at(due_at, self.pump)

    def ended(self, _: Link, why: str, __: Exception | None) -> None:
        """Read no more; what is being handled is answered first, unless nothing can be sent either."""
        self.is_deaf = True
        if why in ("broken", "unread"):
            self.over()
        else:
            self.end_if_drained()

    def drain(self) -> None:
        """Take no more requests, and end when those there are have been answered."""
        self.is_deaf = True
        self.link.pause()
        self.end_if_drained()

    def end_if_drained(self) -> None:
        if self.is_deaf and not self.waiting and not self.is_over:
            self.over()

    def over(self) -> None:
        """End the connection, and with it what only it has waited for."""
        if self.is_over:
            return
        self.is_over = True
        if self.timer is not None:
            self.timer.cancel()
        for task, (context, effect) in self.handlers.items():
            self.server.abandon(task, context, effect)
        for waiting in self.waiting:
            waiting.cancel()
        for _, push in self.session.end_if(_all):
            push.end(Outcome.CLOSED)
        while self.queue:
            self.queue.popleft().end(Outcome.CLOSED)
        self.link.close()
        self.server.gone(self)


def _all(_: FrameId, __: _Push) -> bool:
    return True


async def _run(handler: Handler, context: Context, request: Message) -> Message:
    return await handler(context, request)


def _because(result: ResultText, why: object) -> ResultText:
    return replace(result, text=f"{result.text}: {why}")


class Server:
    """A robot's command port. Belongs to the event loop in which it is made."""

    def __init__(self, robot: Robot, config: ServerConfig | None = None) -> None:
        """Of a robot; what it does not implement is refused."""
        protocol = robot.protocol
        self.protocol: Final[Protocol] = protocol
        self.handlers: Final = robot.handlers_by_code()
        self.config: Final = config or ServerConfig()
        self.limits: Final = self.config.limits or protocol.defaults.limits
        self.counters: Final = ServerCounters()
        self.encoder: Final = Encoder(protocol, self.limits, compress=self.config.gzip)
        self.loop: Final = asyncio.get_running_loop()
        timeout = self.config.handler_timeout
        self.handler_timeout: Final = protocol.defaults.handler_timeout if timeout is None else timeout
        self._ids: Final = itertools.count(1)
        self._peers: Final[dict[int, _Peer]] = {}
        self._abandoned: Final[set[asyncio.Task[Message]]] = set()
        self._listening: asyncio.Server | None = None
        self._drained: asyncio.Event = asyncio.Event()

    async def bind(self) -> tuple[str, int]:
        """Listen. Gives the address and port."""
        config = self.config
        port = self.protocol.command_port if config.command_port is None else config.command_port
        self._listening = await self.loop.create_server(self.accept, config.address, port)
        address: tuple[str, int] = self._listening.sockets[0].getsockname()[:2]
        return address

    def accept(self) -> asyncio.Protocol:
        """Make the protocol of a new connection: for `loop.create_server`, and for pipes."""
        if len(self._peers) >= self.limits.connections or self._drained.is_set():
            self.counters.connections_refused += 1
            return _Refused()
        peer = _Peer(self, next(self._ids))
        self._peers[peer.connection] = peer
        self.counters.connections += 1
        return peer.link

    @property
    def connections(self) -> list[int]:
        """The apps that are connected."""
        return sorted(self._peers)

    def gone(self, peer: _Peer) -> None:
        """Forget a connection that has ended."""
        self._peers.pop(peer.connection, None)

    def abandon(self, task: asyncio.Task[Message], context: Context, effect: Effect) -> None:
        """Nobody waits for a handler any more: what only asks is cancelled, what moves something runs to its end."""
        context.abandon()
        if effect in (Effect.READ, Effect.CONFIG):
            task.cancel()
            return
        self.counters.handlers_abandoned += 1
        self._abandoned.add(task)
        task.add_done_callback(self._abandoned.discard)

    async def push(self, report: Report[Q], message: Q, connection: int | None = None) -> list[Acknowledgement]:
        """Send a report to all apps, or to one, until it is acknowledged. Raises `BodyError` and `FrameError`."""
        if report.code is None:
            raise ValueError(f"{report.name} has no code yet")
        if connection is not None and connection not in self._peers:
            raise LookupError(f"there is no connection {connection}")
        prepared = self.encoder.prepare(write_request(self.protocol, message))
        peers = [one for one in self._peers.values() if connection in (None, one.connection)]
        policy = report.ack or self.protocol.defaults.ack
        pushes = [
            _Push(report.code, _spread(policy, peer.connection), prepared, self.loop.create_future()) for peer in peers
        ]
        for peer, push in zip(peers, pushes, strict=True):
            peer.push(push)
        return [Acknowledgement(peer.connection, await push.outcome) for peer, push in zip(peers, pushes, strict=True)]

    async def send_stream(self, stream: Stream[B], message_id: int, content: B, to: int | None = None) -> int:
        """Send a frame of one of the robot's streams. Gives how many data connections took it."""
        raise NotImplementedError

    async def shutdown(self, grace: float) -> None:
        """Take no more requests, answer those there are within the grace, and end."""
        self._drained.set()
        if self._listening is not None:
            self._listening.close()
        for peer in [*self._peers.values()]:
            peer.drain()
        waiting = {task for peer in self._peers.values() for task in peer.waiting} | self._abandoned
        if waiting:
            await asyncio.wait(waiting, timeout=grace)
        for peer in [*self._peers.values()]:
            peer.over()
        for task in [*self._abandoned]:
            task.cancel()


class _Refused(asyncio.Protocol):
    """A connection too many."""

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        transport.close()


def _spread(policy: AckPolicy, connection: int) -> AckPolicy:
    """Waits a little longer by connection, so that repetitions to many apps do not coincide."""
    return replace(policy, timeout=policy.timeout * (1 + (connection % 32) / 256))
