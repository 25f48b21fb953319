"""An app's connection to a robot: calls, reports, losses and reconnecting."""

from __future__ import annotations

import asyncio
import logging
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final, TypeVar

from .backoff import Tries
from .calls import (
    BusyError,
    CallError,
    CallTimeoutError,
    ClosedError,
    ConnectError,
    FrameCallError,
    InvalidRequestError,
    InvalidResponseError,
    Loss,
    LossKind,
    LostError,
    NotConnectedError,
    Refusal,
    RefusedError,
)
from .codec import codec_of
from .config import ClientConfig, first_id_now
from .document import Json, parse_body
from .ended import EndedCall
from .enveloped import read_request, read_response, write_raw_request, write_request, write_response
from .errors import BodyError, FrameError
from .frame import Decoder, Encoder, Frame, FrameId, Prepared
from .life import Life
from .link import Link, Patience, dialled
from .operations import AckPolicy, Effect
from .receivers import RawReport, Receiver
from .session import BusyFault, Incoming, Session
from .settings import duration, flag, or_none
from .states import ClientCounters, Closed, Connected, Connecting, ConnectionState
from .thin import Thin
from .thrown import describe

if TYPE_CHECKING:
    from collections.abc import AsyncIterator, Callable, Coroutine

    from .link import Dial
    from .message import Message
    from .operations import Command
    from .protocol import Protocol, ResultText

R = TypeVar("R", bound="Message")
Q = TypeVar("Q", bound="Message")
T = TypeVar("T")

_log: Final = logging.getLogger(__name__)
# Most unsent bytes up to which reports are acknowledged.
_ACKNOWLEDGE_UP_TO: Final = 256 * 1024
_check_timeout: Final = or_none(duration)


@dataclass(frozen=True, slots=True)
class RawResponse:
    """A response without types."""

    refusal: Refusal | None
    """The refusal; `None` for success."""
    json: Json
    """All keys, including those of the envelope."""


@dataclass(slots=True, eq=False)
class _Flight:
    """A call in flight."""

    answer: asyncio.Future[bytes]
    prepared: Prepared
    write: Callable[[], bytes]
    repeat: bool
    sent: bool = False
    waits: bool = True


class Connection:
    """A connection of one protocol. It belongs to the event loop that it is created in."""

    def __init__(self, protocol: Protocol, config: ClientConfig | None = None, dial: Dial | None = None) -> None:
        """Creates the connection without connecting: see `connect` and `connect_lazy`."""
        config = config or ClientConfig()
        self.protocol: Final = protocol
        self.config: Final = config
        self.limits: Final = config.limits or protocol.defaults.limits
        self.counters: Final = ClientCounters()
        self.address: Final = (
            config.host or protocol.host,
            protocol.command_port if config.command_port is None else config.command_port,
        )
        self._loop: Final = asyncio.get_running_loop()
        self._dial: Final[Dial] = dial or self._tcp
        first_id = first_id_now() if config.first_id is None else config.first_id
        self._session: Final[Session[_Flight]] = Session(protocol, self.limits, protocol.defaults.ack, first_id)
        self._encoder: Final = Encoder(protocol, self.limits, compress=config.gzip)
        self._receivers: Final[list[Receiver]] = []
        self.life: Final = Life()
        self._beats: Final[dict[int, float]] = {}
        self._lines: Final[dict[str, Thin]] = {}
        self._link: Link | None = None
        self._last: Link | None = None
        self._timer: asyncio.TimerHandle | None = None
        self._lost: asyncio.Future[bool] | None = None
        self._driver: asyncio.Task[None] | None = None

    async def _tcp(self, factory: Callable[[], asyncio.Protocol]) -> tuple[asyncio.BaseTransport, asyncio.BaseProtocol]:
        host, port = self.address
        return await self._loop.create_connection(factory, host, port, ssl=self.config.ssl)

    @property
    def _where(self) -> str:
        return ":".join(map(str, self.address))

    def _say(self, cause: str, level: int, text: str, *values: object) -> None:
        """Writes a line of the log, unless this cause has had many."""
        held = self._lines.setdefault(cause, Thin()).line(self._loop.time())
        if held is not None:
            _log.log(level, "%s: " + text + "%s", self.protocol.name, *values, held)

    def out_of_order(self, report: str) -> None:
        """Counts a report that came out of order."""
        self.counters.reports_out_of_order += 1
        self._say("order", logging.INFO, "%s came out of order", report)

    async def connect(self) -> None:
        """Connects, and connects again after each loss. Raises `ConnectError` if the first attempt fails."""
        loss = await self._attempt()
        if loss is not None:
            self.life.turn(Closed(0, loss))
            raise ConnectError(self._where, loss)
        self._driver = self._loop.create_task(self._drive())

    def connect_lazy(self) -> None:
        """Connects in the background. Calls made meanwhile wait within their timeout."""
        self._driver = self._loop.create_task(self._drive())

    @property
    def state(self) -> ConnectionState:
        """The present state of the connection."""
        return self.life.state

    @property
    def call_timeout(self) -> float:
        """Time a call waits for its response by default."""
        configured = self.config.call_timeout
        return self.protocol.defaults.call_timeout if configured is None else configured

    @property
    def in_flight(self) -> int:
        """Number of calls in flight."""
        return self._session.in_flight

    async def states(self) -> AsyncIterator[ConnectionState]:
        """Yields the present state, then each change; `Closed` is the last. A slow reader gets the latest."""
        async for state in self.life.states():
            yield state

    async def closed(self) -> Loss:
        """Waits until the connection has ended for good. Returns the reason."""
        return await self.life.closed()

    def close(self) -> None:
        """Closes the connection for good. Calls in flight end as lost."""
        if isinstance(self.life.state, Closed):
            return
        link, self._link = self._link, None
        self._down(Loss(LossKind.HERE), for_good=True)
        if link is not None:
            link.close()
        if self._driver is not None:
            self._driver.cancel()

    async def gone(self) -> None:
        """After `close()`, waits until the sent bytes are out, at most for a second, and closes the transport."""
        if self._last is not None:
            await asyncio.wait({self._last.gone}, timeout=1)
            self._last.abort()

    async def _attempt(self) -> Loss | None:
        """Tries to connect once. Returns the loss if that fails."""
        link = Link(
            Decoder(self.protocol, self.limits, verify_digest=self.config.verify_digest, resync=self.config.resync),
            Patience(stall=self.config.stall_timeout, earns=True, keepalive=self.config.keepalive),
            self._arrive,
            self._arrive_broken,
            self._ended,
            on_bytes=self.counters.count_bytes,
        )
        self._lost = self._loop.create_future()
        loss = await dialled(self._dial, link, self.config.connect_timeout)
        if loss is not None:
            return loss
        if isinstance(self.life.state, Closed):
            link.close()
            return self.life.state.why
        self._up(link)
        return None

    async def _drive(self) -> None:
        """Keeps the connection up: connects, and reconnects after each loss as configured."""
        tries = Tries(self.config.reconnect)
        if self._link is not None:
            # The first attempt was made before.
            tries.next()
        why = Loss(LossKind.NOT_YET)
        try:
            while True:
                if self._link is not None and self._lost is not None:
                    tries.connected(is_used=await self._lost)
                    why = self.life.state.why if isinstance(self.life.state, Connecting) else why
                wait = tries.next()
                if wait is None:
                    break
                await asyncio.sleep(wait)
                loss = await self._attempt()
                if loss is not None:
                    why = loss
                    tries.failed()
                    self.life.turn(Connecting(self.life.state.connects, loss))
                    self._say("cannot connect", logging.WARNING, "cannot connect to %s: %s", self._where, loss)
            self._say("given up", logging.WARNING, "%s is given up: %s", self._where, why)
            self._down(why, for_good=True)
        finally:
            # The event loop may end before the connection does.
            self._down(Loss(LossKind.ENDED), for_good=True)

    def _up(self, link: Link) -> None:
        self._link = self._last = link
        self.life.turn(Connected(self.life.state.connects + 1))
        text = "connected to %s" if self.life.state.connects == 1 else "connected again to %s"
        self._say("connected", logging.INFO, text, self._where)
        self._session.reconnected()
        self._beats.clear()
        for receiver in self._receivers:
            if self.life.state.connects > 1:
                receiver.connected()
        for frame, flight in self._session.requests():
            if not flight.waits:
                continue
            # A call is repeated only once, however often the connection is lost.
            flight.repeat = flight.repeat and not flight.sent
            # The envelope has the time of sending, so it is written again.
            flight.prepared = self._encoder.prepare(flight.write())
            self._send(frame, flight)

    def _ended(self, link: Link, why: str, error: Exception | None) -> None:
        if self._link is not link:
            return
        kind = {
            "closed": LossKind.CLOSED if link.is_heard else LossKind.UNHEARD,
            "broken": LossKind.BROKEN if link.is_heard else LossKind.UNHEARD,
        }.get(why) or LossKind(why)
        detail = str(error) if isinstance(error, (FrameError, TimeoutError)) else type(error).__name__ if error else ""
        if why == "frame":
            self.counters.bad_frames += 1
        self._link = None
        loss = Loss(kind, detail)
        self._say("lost", logging.WARNING, "lost %s: %s", self._where, loss)
        link.close(at_once=True)
        gives_up = self.config.reconnect is None
        self._down(loss, for_good=gives_up)
        if self._lost is not None and not self._lost.done():
            self._lost.set_result(link.is_heard)

    def _down(self, loss: Loss, *, for_good: bool) -> None:
        """Ends the calls that must not be sent twice. The others wait for the next connection."""
        if isinstance(self.life.state, Closed):
            return
        if not for_good and isinstance(self.life.state, Connected):
            for receiver in self._receivers:
                receiver.lost(loss)
        connects = self.life.state.connects
        self.life.turn(Closed(connects, loss) if for_good else Connecting(connects, loss))

        def ends(_: FrameId, flight: _Flight) -> bool:
            if not flight.waits and flight.repeat:
                flight.waits = True
            return for_good or not flight.waits

        for _, flight in self._session.end_if(ends):
            self._fail(flight, LostError(loss) if flight.sent else ClosedError(loss))
        if for_good:
            for receiver in self._receivers:
                receiver.end()

    @staticmethod
    def _fail(flight: _Flight, error: CallError) -> None:
        if not flight.answer.done():
            flight.answer.set_exception(error)

    def _send(self, frame: FrameId, flight: _Flight) -> None:
        if self._link is None:
            return
        flight.sent, flight.waits = True, False
        self._link.send(self._encoder.frame(frame, flight.prepared))

    def _arm(self) -> None:
        due = self._session.next_due
        if due is None or (self._timer is not None and not self._timer.cancelled() and self._timer.when() <= due):
            return
        if self._timer is not None:
            self._timer.cancel()
        self._timer = self._loop.call_at(due, self._tick)

    def _tick(self) -> None:
        self._timer = None
        while due := self._session.due(self._loop.time()):
            flight, state = due.token, self.life.state
            self.counters.timeouts += 1
            if isinstance(state, Connected):
                self._fail(flight, CallTimeoutError())
            elif flight.sent:
                self._fail(flight, LostError(state.why))
            else:
                error = ClosedError if isinstance(state, Closed) else NotConnectedError
                self._fail(flight, error(state.why))
        self._arm()

    async def call(
        self,
        command: Command[Q, R],
        request: Message | None = None,
        *,
        timeout: float | None = None,
        repeat: bool | None = None,
    ) -> R:
        """Calls a command, and waits for its response. Raises `CallError`.

        `repeat` sends the call again if the connection is lost before its response comes. By default only commands with
        the effect `read` are repeated. Cancelling the waiting task frees the call's place, but the robot still handles
        a request that was sent.
        """
        if command.code is None:
            raise ValueError(f"{command.name} has no code yet")
        repeats = command.effect is Effect.READ if repeat is None else repeat
        return await self._told(command.code, self._call(command, command.code, request, timeout, repeats=repeats))

    async def _call(
        self, command: Command[Q, R], code: int, request: Message | None, timeout: float | None, *, repeats: bool
    ) -> R:
        asked = self.asked(command, request)
        answer = await self._fly(
            code, lambda: write_request(self.protocol, command.request, asked), timeout, repeat=repeats
        )
        try:
            response = read_response(self.protocol, command.response, answer, self.limits)
        except Refusal as refusal:
            raise RefusedError(refusal) from None
        except BodyError as error:
            raise InvalidResponseError(error) from None
        assert response is not None
        return response

    def asked(self, command: Command[Q, R], request: Message | None) -> Message:
        """Returns the request of a call; one without keys for `None`. Raises `InvalidRequestError`."""
        if request is not None:
            return request
        try:
            return codec_of(command.request).empty()
        except BodyError as error:
            raise InvalidRequestError(error) from None

    async def call_raw(
        self, code: int, body: Json | None = None, *, timeout: float | None = None, repeat: bool = False
    ) -> RawResponse:
        """Calls any code with an object of the request's keys. An absent envelope is added.

        A result other than success is not an error: the response has it. Raises `CallError`.
        """
        return await self._told(code, self._call_raw(code, body, timeout, repeat=repeat))

    async def _call_raw(self, code: int, body: Json | None, timeout: float | None, *, repeat: bool) -> RawResponse:
        answer = await self._fly(code, lambda: write_raw_request(self.protocol, body), timeout, repeat=repeat)
        refusal: Refusal | None = None
        try:
            read_response(self.protocol, None, answer, self.limits)
        except Refusal as refused:
            refusal = refused
        except BodyError as error:
            raise InvalidResponseError(error) from None
        entries = parse_body(answer, self.limits.json_depth, self.limits.json_values)
        return RawResponse(refusal, Json.of_tree(entries))

    async def _told(self, code: int, call: Coroutine[Any, Any, T]) -> T:
        """Waits for a call, and tells `on_call` its end."""
        hook = self.config.on_call
        if hook is None:
            return await call
        since, result = self._loop.time(), None
        try:
            answer = await call
            result = "success"
        except CallError as error:
            result = error.name
            raise
        except asyncio.CancelledError:
            result = "dropped"
            raise
        finally:
            if result is not None:
                known = self.protocol.commands_by_code.get(code)
                ended = EndedCall("unknown" if known is None else known.name, result, self._loop.time() - since)
                try:
                    hook(ended)
                except Exception as failed:  # noqa: BLE001 - whatever it is, it is the app's own
                    self._say("on_call", logging.ERROR, "`on_call` failed: %s", describe(failed, hook))
        return answer

    async def _fly(self, code: int, write: Callable[[], bytes], timeout: float | None, *, repeat: bool) -> bytes:
        """Sends a request, and waits for the bytes of the response. Raises `CallError`."""
        self.protocol.layout.check_code("code", code)
        _check_timeout("timeout", timeout)
        flag("repeat", repeat)
        state = self.life.state
        if isinstance(state, Closed):
            raise ClosedError(state.why)
        try:
            prepared = self._encoder.prepare(write())
        except BodyError as error:
            raise InvalidRequestError(error) from None
        except FrameError as error:
            raise FrameCallError(error) from None
        policy = AckPolicy(timeout=self.call_timeout if timeout is None else timeout, retries=0)
        flight = _Flight(self._loop.create_future(), prepared, write, repeat)
        try:
            frame = self._session.open(self.protocol.command, code, policy, self._loop.time(), flight)
        except BusyFault:
            raise BusyError from None
        self._send(frame, flight)
        self._arm()
        try:
            return await flight.answer
        finally:
            self._session.cancel(frame)

    def receiver(self, codes: frozenset[int] | None = None) -> Receiver:
        """Returns a receiver for the reports of these codes from now on; `None` for all of them."""
        most = self.config.queued_bytes
        limit = self.limits.inflated_bytes if most is None else most
        receiver = Receiver(self.limits.queued_reports, limit, codes)
        if isinstance(self.life.state, Closed):
            receiver.end()
        self._receivers.append(receiver)
        return receiver

    def leave(self, receiver: Receiver) -> None:
        """Removes a receiver."""
        receiver.end()
        if receiver in self._receivers:
            self._receivers.remove(receiver)

    def read_report(self, raw: RawReport, cls: type[R]) -> R:
        """Reads a report with its type. Raises `BodyError`."""
        return read_request(self.protocol, cls, raw.data, self.limits)[1]

    def _arrive_broken(self, _: Link, error: FrameError) -> None:
        self.counters.bad_frames += 1
        frame = error.frame
        assert frame is not None
        if not frame.response:
            self._answer(frame, self.protocol.results.protocol)
            return
        meaning, flight = self._session.receive(frame, None, self._loop.time())
        if meaning is Incoming.ANSWER and flight is not None:
            self.counters.answers += 1
            self._fail(flight, FrameCallError(error))
        else:
            self.counters.late_answers += 1

    def _arrive(self, _: Link, frame: Frame) -> None:
        now, results = self._loop.time(), self.protocol.results
        if not frame.id.response and frame.id.kind == self.protocol.report:
            error = self._check_report(frame)
            if error is not None:
                self.counters.reports_invalid += 1
                self._answer(frame.id, type(results.invalid)(results.invalid.code, f"{results.invalid.text}: {error}"))
                return
        meaning, flight = self._session.receive(frame.id, frame.fingerprint, now)
        if meaning is Incoming.ANSWER and flight is not None:
            self.counters.answers += 1
            if not flight.answer.done():
                flight.answer.set_result(frame.data)
        elif meaning is Incoming.LATE:
            self.counters.late_answers += 1
        elif meaning is Incoming.REPORT:
            self._report(frame, now)
        elif meaning is Incoming.REPEATED:
            self.counters.repeated_reports += 1
            self._answer(frame.id, results.success)
        else:
            # Apps handle no commands, and streams use the data port.
            self._answer(frame.id, results.protocol)

    def _check_report(self, frame: Frame) -> BodyError | None:
        known = self.protocol.reports_by_code.get(frame.id.code)
        try:
            if known is not None:
                read_request(self.protocol, known.request, frame.data, self.limits)
            else:
                parse_body(frame.data, self.limits.json_depth, self.limits.json_values)
        except BodyError as error:
            return error
        return None

    def _report(self, frame: Frame, now: float) -> None:
        code = frame.id.code
        known = self.protocol.reports_by_code.get(code)
        if known is not None and known.cadence is not None and known.cadence.every is not None:
            before = self._beats.get(code)
            self._beats[code] = now
            if before is not None and now - before > 1.5 * known.cadence.every:
                self.counters.reports_late += 1
                self._say("late", logging.WARNING, "%s came %.3g s after the last", known.name, now - before)
        report = RawReport(code, frame.id.id, frame.data)
        wanting = [one for one in self._receivers if one.is_for(code)]
        taking = [one for one in wanting if one.has_room(len(frame.data))]
        has_room = self._link is not None and self._link.unsent < _ACKNOWLEDGE_UP_TO
        if not taking or not has_room:
            self.counters.reports_refused += 1
            return
        for receiver in wanting:
            if receiver in taking:
                receiver.put(report)
            else:
                receiver.miss()
                self.counters.reports_missed += 1
        self.counters.reports += 1
        self._session.handed_on(frame.id, frame.fingerprint, now)
        self._answer(frame.id, self.protocol.results.success)

    def _answer(self, frame: FrameId, result: ResultText) -> None:
        can_say = result.code == self.protocol.results.success.code or self.protocol.has_result
        if self._link is None or not can_say or self._link.unsent >= _ACKNOWLEDGE_UP_TO:
            return
        data = write_response(self.protocol, result)
        self._link.send(self._encoder.encode(frame.answer(), data))
