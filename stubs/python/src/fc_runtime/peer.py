"""One app's connection to the command port of a robot."""

from __future__ import annotations

import asyncio
import logging
import time
from collections import deque
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Final

from .calls import Refusal
from .config import first_id_now
from .context import Context
from .document import parse_body
from .enveloped import read_request, read_response, write_raw_response, write_response
from .errors import BodyError, FrameError
from .frame import Decoder, FrameId
from .link import Link
from .operations import Effect
from .pace import Pace
from .protocol import ResultText
from .pushes import Outcome
from .robot import RawRequest
from .session import Incoming, Session
from .thin import Thin

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable

    from .frame import Frame
    from .operations import Command
    from .pushes import Push
    from .server import Server

_log: Final = logging.getLogger(__name__)


@dataclass(slots=True, eq=False)
class _Work:
    """A request in a handler."""

    frame: FrameId
    context: Context
    command: Command[Any, Any] | None
    handler: Callable[[Context, Any], Awaitable[Any]]
    size: int
    since: float
    due: float
    task: asyncio.Task[None] | None = None


class Peer:
    """One app's connection."""

    def __init__(self, server: Server, connection: int) -> None:
        """Creates a connection of a robot, with this number."""
        config, protocol, limits = server.config, server.protocol, server.limits
        first_id = first_id_now() if config.first_id is None else config.first_id
        self.server: Final = server
        self.connection: Final = connection
        self.address = ""
        """The app's address."""
        self.effects: frozenset[Effect] = frozenset(Effect)
        """Effects of the commands that the address may call."""
        self._session: Final[Session[Push]] = Session(protocol, limits, protocol.defaults.ack, first_id)
        self._queue: Final[deque[Push]] = deque()
        self._queued_bytes = 0
        # In their order of beginning.
        self._works: Final[dict[_Work, None]] = {}
        self._bodies = 0
        self._is_deaf = False
        self._is_over = False
        self._timer: asyncio.TimerHandle | None = None
        self._late_timer: asyncio.TimerHandle | None = None
        self._pace: Final = Pace()
        self._lines: Final = Thin()
        decoder = Decoder(protocol, limits, verify_digest=config.verify_digest, resync=config.resync)
        self.link: Final = Link(
            decoder,
            server.patience,
            self._arrive,
            self._arrive_broken,
            self._ended,
            on_made=self._made,
            on_bytes=server.count_bytes,
            is_idle=self._is_idle,
            reads_when_full=False,
        )

    def _made(self, link: Link) -> None:
        self.address = link.peer
        self.server.admit(self)

    def _is_idle(self) -> bool:
        return not self._works and self._session.in_flight == 0

    @property
    def is_heard(self) -> bool:
        """`True` if bytes have been received over it."""
        return self.link.received > 0

    @property
    def held(self) -> int:
        """Bytes held for it."""
        return self.link.held + self._bodies + self._queued_bytes

    @property
    def tasks(self) -> set[asyncio.Task[None]]:
        """Handlers whose results are awaited."""
        return {work.task for work in self._works if work.task is not None}

    def _arrive(self, _: Link, frame: Frame) -> None:
        results = self.server.protocol.results
        if self._is_deaf:
            return
        meaning, push = self._session.receive(frame.id, frame.fingerprint, self.server.loop.time())
        if meaning is Incoming.COMMAND:
            self._begin(frame)
        elif meaning is Incoming.ANSWER and push is not None:
            self._acknowledged(push, frame)
        elif meaning is Incoming.LATE:
            self._rest(unusable=1)
        else:
            # Robots receive no reports, and streams use the data port.
            self._refuse(frame.id, results.protocol)
        surplus = self.link.surplus
        if surplus:
            self._rest(surplus=surplus)

    def _arrive_broken(self, _: Link, error: FrameError) -> None:
        server = self.server
        server.counters.bad_frames += 1
        held = self._lines.line(server.loop.time())
        if held is not None:
            _log.warning("%s: %s sent a bad frame: %s%s", server.protocol.name, self.address, error, held)
        assert error.frame is not None
        if error.frame.response:
            self._rest(unusable=1)
        else:
            self._refuse(error.frame, server.protocol.results.protocol)

    def _rest(self, unusable: int = 0, surplus: int = 0) -> None:
        """Stops reading for a while if there were too many useless frames."""
        loop = self.server.loop
        rest = self._pace.owe(unusable, surplus, loop.time())
        if rest > 0 and not self._is_over:
            self.server.counters.connections_paced += 1
            self.link.hold("pace")
            loop.call_later(rest, self.link.let_go, "pace")

    def _begin(self, frame: Frame) -> None:
        """Passes a request to its handler, or refuses it."""
        server, results, code = self.server, self.server.protocol.results, frame.id.code
        command = server.protocol.commands_by_code.get(code)
        raw_handler = server.robot.raw_handler(code) if command is None else None
        effect = Effect.UNKNOWN if command is None else command.effect
        if command is None and raw_handler is None:
            self._refuse(frame.id, results.protocol)
            return
        if effect not in self.effects:
            server.counters.calls_forbidden += 1
            self._refuse(frame.id, because(results.protocol, "not allowed from this address"))
            return
        try:
            at, request = self._read(command, frame)
        except BodyError as error:
            self._refuse(frame.id, because(results.invalid, error))
            return
        if server.max_age is not None and at is not None and time.time() - at / 1000 > server.max_age:
            self._refuse(frame.id, results.expired)
            return
        handler = server.handlers.get(code) if command is not None else raw_handler
        if handler is None:
            assert command is not None
            server.counters.calls_not_implemented += 1
            server.log("not implemented", logging.WARNING, "%s is not implemented", command.name)
            self._answer(frame.id, because(results.protocol, "not implemented"))
            return
        if effect in (Effect.MOTION, Effect.UNKNOWN) and server.is_abandoned_full:
            server.counters.abandoned_reached += 1
            self._answer(frame.id, because(results.protocol, "too many handlers are still at work"))
            return
        context = Context(self.connection, self.address, code, frame.id.id, effect, at)
        now = server.loop.time()
        due = now + server.handler_timeout
        work = _Work(frame.id, context, command, handler, len(frame.data), now, due)
        self._works[work] = None
        self._bodies += work.size
        work.task = server.loop.create_task(self._handle(work, request))
        if self._late_timer is None:
            self._late_timer = server.loop.call_at(work.due, self._look_for_late)
        if len(self._works) >= server.limits.in_flight:
            server.counters.in_flight_reached += 1
            self.link.hold("in flight")

    def _read(self, command: Command[Any, Any] | None, frame: Frame) -> tuple[int | None, Any]:
        server = self.server
        if command is None:
            parse_body(frame.data, server.limits.json_depth, server.limits.json_values)
            return None, RawRequest(frame.id.code, frame.id.id, frame.data)
        return read_request(server.protocol, command.request, frame.data, server.limits)

    def _forget(self, work: _Work) -> bool:
        """Removes a handler. Returns `False` if its result was no longer awaited."""
        if work not in self._works:
            return False
        del self._works[work]
        self._bodies -= work.size
        return True

    def _look_for_late(self) -> None:
        """Abandons handlers that take too long. All have the same timeout, so they expire in their order."""
        self._late_timer = None
        now = self.server.loop.time()
        for work in [*self._works]:
            if work.due > now:
                self._late_timer = self.server.loop.call_at(work.due, self._look_for_late)
                break
            if self._abandon(work):
                self._answer(work.frame, self.server.protocol.results.timeout, since=work.since)
                self._go_on()

    def _abandon(self, work: _Work) -> bool:
        """Abandons a handler. Returns `False` if its result was no longer awaited."""
        is_waited_for = self._forget(work)
        if is_waited_for and work.task is not None:
            self.server.abandon(work.task, work.context)
        return is_waited_for

    async def _handle(self, work: _Work, request: Any) -> None:
        """Runs the handler, and responds with its result if that is still awaited."""
        server, results = self.server, self.server.protocol.results
        try:
            response = await work.handler(work.context, request)
        except Refusal as refusal:
            if self._forget(work):
                self._answer(work.frame, ResultText(refusal.code, refusal.text), is_refusal=True, since=work.since)
                self._go_on()
            return
        except asyncio.CancelledError:
            if self._forget(work):
                self._answer(work.frame, because(results.protocol, "the handler was cancelled"), since=work.since)
                self._go_on()
            raise
        except (KeyboardInterrupt, SystemExit):
            raise
        except BaseException as error:  # noqa: BLE001 - whatever it is, it is the robot's own
            server.counters.handlers_panicked += 1
            server.tell_failure("the handler of %s failed", error, work.context, work.handler)
            if self._forget(work):
                self._answer(work.frame, because(results.protocol, "the handler panicked"), since=work.since)
                self._go_on()
            return
        if not self._forget(work):
            return
        try:
            self._send(work.frame, self._write(work.command, response))
            server.counters.calls_succeeded += 1
            server.call_ended(work.frame.code, "success", work.since)
        except (BodyError, FrameError) as error:
            server.tell_failure("the response to %s breaks the spec", error, work.context, work.handler)
            self._answer(work.frame, results.protocol, since=work.since)
        self._go_on()

    def _write(self, command: Command[Any, Any] | None, response: Any) -> bytes:
        """Returns the bytes of a response. Raises `BodyError`."""
        protocol = self.server.protocol
        if command is None:
            return write_raw_response(protocol, protocol.results.success, response)
        return write_response(protocol, protocol.results.success, command.response, response)

    def _go_on(self) -> None:
        if not self._is_deaf and len(self._works) < self.server.limits.in_flight:
            self.link.let_go("in flight")
        self._end_if_drained()

    def _refuse(self, frame: FrameId, result: ResultText) -> None:
        """Refuses a request that cannot be used."""
        self._answer(frame, result)
        self._rest(unusable=1)

    def _answer(
        self, frame: FrameId, result: ResultText, *, is_refusal: bool = False, since: float | None = None
    ) -> None:
        """Responds with a result other than success. The request came at `since`, or now."""
        server = self.server
        protocol, counters = server.protocol, server.counters
        if is_refusal and result.code != protocol.results.protocol.code:
            counters.calls_refused += 1
            ended = "refused"
        elif result.code == protocol.results.timeout.code:
            counters.calls_timed_out += 1
            ended = "timeout"
        elif result.code == protocol.results.invalid.code:
            counters.calls_invalid += 1
            ended = "invalid"
        elif result.code == protocol.results.expired.code:
            counters.calls_expired += 1
            ended = "expired"
        else:
            counters.calls_protocol += 1
            ended = "protocol"
        if protocol.has_result:
            try:
                self._send(frame, write_response(protocol, result))
            except FrameError as error:
                # Even that does not fit into a frame: the app gets no response, and its call ends by timeout.
                server.log("no answer", logging.ERROR, "no answer fits into a frame: %s", error)
        server.call_ended(frame.code, ended, server.loop.time() if since is None else since)

    def _send(self, frame: FrameId, data: bytes) -> None:
        if not self._is_over:
            self.link.send(self.server.encoder.encode(frame.answer(), data))

    def _acknowledged(self, push: Push, frame: Frame) -> None:
        counters = self.server.counters
        self._queued_bytes -= push.size
        try:
            read_response(self.server.protocol, None, frame.data, self.server.limits)
        except Refusal as refusal:
            counters.reports_refused += 1
            push.end(Outcome.REFUSED, refusal)
        except BodyError as error:
            push.end(Outcome.INVALID, error)
        else:
            counters.reports_acknowledged += 1
            push.end(Outcome.ACKNOWLEDGED)
        self._pump()

    def push(self, push: Push) -> None:
        """Queues a report, in place of the oldest unsent ones if the queue is full."""
        if self._is_over:
            push.end(Outcome.CLOSED)
            return
        self._queue.append(push)
        self._queued_bytes += push.size
        self.server.look_at_memory(push.size)
        self._pump()
        while self._queue and (
            len(self._queue) > self.server.limits.queued_reports or self._queued_bytes > self.server.queued_bytes
        ):
            dropped = self._queue.popleft()
            self._queued_bytes -= dropped.size
            self.server.counters.reports_dropped += 1
            dropped.end(Outcome.DROPPED)

    def _pump(self) -> None:
        """Sends reports that are due again, and new ones as far as there is room."""
        now, counters = self.server.loop.time(), self.server.counters
        if self._is_over:
            return
        while due := self._session.due(now):
            if due.again:
                counters.reports_repeated += 1
                self.link.send(self.server.encoder.frame(due.frame, due.token.prepared))
            else:
                counters.reports_timed_out += 1
                self._queued_bytes -= due.token.size
                due.token.end(Outcome.TIMED_OUT)
        while self._queue and not self._session.is_full and not self._is_deaf and not self.link.is_full:
            push = self._queue.popleft()
            frame = self._session.open(self.server.protocol.report, push.code, push.policy, now, push)
            counters.reports_sent += 1
            self.link.send(self.server.encoder.frame(frame, push.prepared))
        due_at = self._session.next_due
        if due_at is None and self._queue:
            # The app does not read: check again later.
            due_at = now + self.server.protocol.defaults.ack.timeout
        if self._timer is not None:
            self._timer.cancel()
        self._timer = None if due_at is None else self.server.loop.call_at(due_at, self._pump)

    def _ended(self, _: Link, why: str, error: Exception | None) -> None:
        """Stops reading. Running requests still get their responses, unless sending is not possible either."""
        self._is_deaf = True
        server = self.server
        if why in ("stalled", "idle", "unread"):
            server.counters.connections_timed_out += 1
        if why == "frame":
            server.counters.bad_frames += 1
        server.log_end(self.connection, self.address, "command", f"{why}: {error}" if error else why)
        if why in ("broken", "unread", "idle"):
            self.over(at_once=why != "idle")
        else:
            self._end_if_drained()

    def drain(self) -> None:
        """Takes no more requests, and ends once the present ones have their responses."""
        self._is_deaf = True
        self.link.hold("drain")
        self._end_if_drained()

    def _end_if_drained(self) -> None:
        if self._is_deaf and not self._works and not self._is_over:
            self.over()

    def over(self, *, at_once: bool = False) -> None:
        """Ends the connection, with all that only it has waited for."""
        if self._is_over:
            return
        self._is_over = True
        for timer in (self._timer, self._late_timer):
            if timer is not None:
                timer.cancel()
        for work in [*self._works]:
            self._abandon(work)
        for _, push in self._session.end_if(_all):
            push.end(Outcome.CLOSED)
        while self._queue:
            self._queue.popleft().end(Outcome.CLOSED)
        self._queued_bytes = 0
        self.link.close(at_once=at_once)
        self.server.gone(self)


def _all(_: FrameId, __: Push) -> bool:
    return True


def because(result: ResultText, why: object) -> ResultText:
    """Returns a result with a reason."""
    return replace(result, text=f"{result.text}: {why}")
