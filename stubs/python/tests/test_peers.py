"""The session scripts of level `peer`, against the whole client and robot, over a pipe and with a virtual clock."""

from __future__ import annotations

import asyncio
import json
import unittest
from dataclasses import dataclass, field, replace
from typing import Annotated, Any

import fc_runtime as rt
from fc_runtime import calls, connection, server
from fc_runtime.config import Backoff, ClientConfig, ServerConfig
from fc_runtime.receivers import RawReport, Receiver
from support import LIMITS, PROTOCOL, ROOT, holds, load

FOR_EVER = 365 * 24 * 60 * 60.0


@dataclass(slots=True, kw_only=True)
class Text(rt.Message):
    text: Annotated[str, rt.Key("text")]
    extra: rt.Extra = field(default_factory=rt.Extra)


@dataclass(slots=True, kw_only=True)
class Metres(rt.Message):
    metres: Annotated[rt.I32, rt.Key("metres")]
    extra: rt.Extra = field(default_factory=rt.Extra)


@dataclass(slots=True, kw_only=True)
class Empty(rt.Message):
    extra: rt.Extra = field(default_factory=rt.Extra)


READ = rt.Command(name="read", code=100, zh="", en="", request=Text, response=Empty, effect=rt.Effect.READ)
GO = rt.Command(name="go", code=200, zh="", en="", request=Metres, response=Empty, effect=rt.Effect.MOTION)
MOVED = rt.Report(name="moved", code=300, zh="", en="", request=Metres, response=Empty)
TOY = replace(
    PROTOCOL,
    commands=(READ, GO),
    reports=(MOVED,),
    defaults=replace(PROTOCOL.defaults, limits=replace(LIMITS, in_flight=64)),
)
KINDS = {"command": TOY.command, "report": TOY.report, "stream": TOY.stream}
RESULTS = {"success": 1001, "protocol": 2001, "timeout": 2002, "invalid": 2003, "expired": 2004}


class Loop(asyncio.SelectorEventLoop):
    """An event loop whose clock only the script advances."""

    now = 0.0

    def time(self) -> float:
        return self.now


class Pipe(asyncio.Transport):
    """The transport of the peer under test; the runner is at its other end."""

    def __init__(self, protocol: asyncio.Protocol) -> None:
        super().__init__()
        self.protocol = protocol
        self.decoder = rt.Decoder(TOY)
        self.is_closed = self.is_lost = False
        protocol.connection_made(self)

    def get_extra_info(self, name: str, default: Any = None) -> Any:
        return ("pipe", 0) if name == "peername" else default

    def write(self, data: Any) -> None:
        if not self.is_lost:
            self.decoder.push(bytes(data))

    def get_write_buffer_size(self) -> int:
        return 0

    def is_closing(self) -> bool:
        return self.is_closed

    def close(self) -> None:
        if not self.is_closed:
            self.is_closed = True
            asyncio.get_running_loop().call_soon(self.protocol.connection_lost, None)

    abort = close

    def can_write_eof(self) -> bool:
        return False

    def pause_reading(self) -> None:
        pass

    def resume_reading(self) -> None:
        pass

    def lose(self) -> None:
        self.is_lost = True
        self.protocol.eof_received()


class Run:
    """One script."""

    def __init__(self, loop: Loop, given: dict[str, Any]) -> None:
        self.loop, self.given, self.is_app = loop, given, given["side"] == "app"
        self.pipe: Pipe | None = None
        self.requests: list[tuple[str, int, rt.FrameId | None]] = []
        self.arrived: list[tuple[str, rt.FrameId, dict[str, Any]]] = []
        self.got: list[Any] = []
        self.tasks: dict[str, asyncio.Task[None]] = {}
        self.handlers: dict[str, asyncio.Future[str]] = {}
        self.dialled: asyncio.Queue[None] = asyncio.Queue()
        self.receivers: list[Receiver] = []

    async def begin(self) -> None:
        given = self.given
        limits = replace(
            TOY.defaults.limits,
            in_flight=given.get("in_flight", 64),
            queued_reports=given.get("queued_reports", 16),
        )
        if self.is_app:
            config = ClientConfig(
                limits=limits,
                call_timeout=given.get("call_timeout", 3000) / 1000,
                connect_timeout=FOR_EVER,
                reconnect=Backoff(first=0, longest=0),
                first_id=given["first_id"],
            )
            self.app = connection.Connection(TOY, config, self.dial)
            self.dialled.put_nowait(None)
            await self.app.connect()
            self.receivers = [self.app.receiver() for _ in range(given.get("receivers", 1))]
            self.tasks[""] = self.loop.create_task(self.watch())
            await self.settle()
            self.got.clear()
        else:
            config_ = ServerConfig(
                limits=limits,
                handler_timeout=given.get("handler_timeout", 2000) / 1000,
                first_id=given["first_id"],
            )
            self.robot = server.Server(rt.Handlers(TOY, {100: self.handle, 200: self.handle}), config_)
            self.pipe = Pipe(self.robot.accept())

    async def dial(self, factory: Any) -> Any:
        await self.dialled.get()
        self.pipe = Pipe(factory())
        return self.pipe, self.pipe.protocol

    async def watch(self) -> None:
        names = {"Connected": "connected", "Connecting": "connecting", "Closed": "closed"}
        async for state in self.app.states():
            self.got.append(names[type(state).__name__])

    async def handle(self, context: rt.Context, _: Any) -> Any:
        name = self.name_of(context.code, context.id) or ""
        self.got.append({"handles": name})
        self.handlers[name] = self.loop.create_future()
        result = await self.handlers[name]
        if result != "success":
            raise calls.Refusal(RESULTS[result], "as the script says")
        return Empty()

    def name_of(self, code: int, message_id: int, body: dict[str, Any] | None = None) -> str | None:
        name: str
        for name, frame, sent in reversed(self.arrived):
            if (frame.code, frame.id) == (code, message_id) and (body is None or body == sent):
                return name
        return None

    async def settle(self) -> None:
        for _ in range(50):
            await asyncio.sleep(0)

    async def step(self, step: dict[str, Any]) -> None:
        if "receive" in step:
            self.receive(step["receive"])
        elif "advance" in step:
            self.loop.now += step["advance"] / 1000
        elif "lose" in step:
            assert self.pipe is not None
            self.pipe.lose()
            self.pipe = None
        elif "reconnect" in step:
            if self.is_app:
                self.dialled.put_nowait(None)
            else:
                self.pipe = Pipe(self.robot.accept())
        elif "call" in step or "report" in step:
            self.open(step.get("call") or step["report"])
        elif "cancel" in step:
            self.tasks[step["cancel"]].cancel()
        elif "take" in step:
            event = self.receivers[0].take()
            while event is not None and not isinstance(event, RawReport):
                event = self.receivers[0].take()
            if event is not None:
                self.got.append({"hands_on": self.name_of(event.code, event.id, json.loads(event.data))})
        elif "finish" in step:
            handler = self.handlers.pop(step["finish"]["handler_of"])
            if handler.done():
                pass
            elif "fails" in step["finish"]:
                handler.set_exception(ValueError("as the script says"))
            else:
                handler.set_result(step["finish"]["result"])
        elif "close" in step:
            self.app.close()
        else:
            self.tasks["shutdown"] = self.loop.create_task(self.shut(step["shutdown"]["grace"] / 1000))
        await self.settle()
        self.drain()
        await self.settle()
        self.drain()

    async def shut(self, grace: float) -> None:
        await self.robot.shutdown(grace)
        self.got.append("over")

    def open(self, said: dict[str, Any]) -> None:
        number, code = len(self.requests), said["code"]
        self.requests.append((said["as"], code, None))
        run = self.call if self.is_app else self.push
        self.tasks[said["as"]] = self.loop.create_task(run(number, said))

    async def call(self, number: int, said: dict[str, Any]) -> None:
        timeout = said["timeout"] / 1000 if "timeout" in said else None
        request = Text(text=str(number)) if said["code"] == 100 else Metres(metres=number)
        command: Any = READ if said["code"] == 100 else GO
        try:
            await self.app.call(command, request, timeout=timeout, repeat=said.get("repeat"))
            ended = "success"
        except calls.CallError as error:
            ended = error.name
        self.got.append({"ends": {"as": said["as"], "with": ended}})

    async def push(self, number: int, said: dict[str, Any]) -> None:
        ended = await self.robot.push(MOVED, Metres(metres=number))
        self.got.append({"ends": {"as": said["as"], "with": ended[0].outcome.value if ended else "nobody"}})

    def receive(self, said: dict[str, Any]) -> None:
        answered = None
        if "answer_to" in said:
            answered = next(frame for name, _, frame in reversed(self.requests) if name == said["answer_to"])
            assert answered is not None, "it has not been sent"
        frame = rt.FrameId(
            answered is not None,
            KINDS[said["kind"]] if "kind" in said or answered is None else answered.kind,
            said["code"] if "code" in said or answered is None else answered.code,
            said["id"] if "id" in said or answered is None else answered.id,
        )
        body: dict[str, Any]
        if frame.response:
            body = {"resultCode": RESULTS[said.get("result", "success")]}
            broken: dict[str, Any] = {"resultCode": "x"}
        else:
            body = {"text": ""} if frame.code == 100 else {"metres": 1}
            broken = {"text": 1, "metres": ""}
        if said.get("broken"):
            body = broken
        if "data" in said:
            body["data"] = said["data"]
        self.arrived.append((said.get("as", ""), frame, body))
        assert self.pipe is not None
        self.pipe.protocol.data_received(rt.Encoder(TOY).encode(frame, json.dumps(body).encode()))

    def drain(self) -> None:
        """Collects the frames that the peer under test has sent."""
        while self.pipe is not None:
            frame = self.pipe.decoder.next()
            if frame is None:
                if self.pipe.is_closed:
                    self.got.append("closes")
                    self.pipe = None
                return
            body = json.loads(frame.data)
            if frame.id.response:
                result = next(name for name, code in RESULTS.items() if code == body["resultCode"])
                to = self.name_of(frame.id.code, frame.id.id)
                self.got.append({"answers": {"to": to, "result": result}})
                continue
            number = int(body["text"] if "text" in body else body["metres"])
            name, code, before = self.requests[number]
            assert before in (None, frame.id), f"{name} is sent as {frame.id}"
            assert frame.id.code == code
            verb = "sends" if before is None else "again"
            self.requests[number] = (name, code, frame.id)
            self.got.append({verb: {"as": name, "id": frame.id.id}})

    async def run(self, steps: list[dict[str, Any]]) -> None:
        await self.begin()
        for number, step in enumerate(steps, 1):
            await self.step(step)
            got, self.got = self.got, []
            expected = [self.filled(event) for event in step.get("expect", [])]
            assert sorted(map(json.dumps, got)) == sorted(map(json.dumps, expected)), (number, step, got)
            in_flight = step.get("then", {}).get("in_flight")
            if in_flight is not None:
                assert self.app.in_flight == in_flight, (number, step, self.app.in_flight)
        for task in asyncio.all_tasks(self.loop) - {asyncio.current_task(self.loop)}:
            task.cancel()

    def filled(self, event: Any) -> Any:
        """Returns an expected event with the id of its request."""
        for kind in {"sends", "again"}.intersection(event if isinstance(event, dict) else ()):
            name = event[kind]["as"]
            frame = next((frame for one, _, frame in reversed(self.requests) if one == name), None)
            return {kind: {"as": name, "id": None if frame is None else frame.id, **event[kind]}}
        return event


class Peers(unittest.TestCase):
    def test_every_script(self) -> None:
        scripts = 0
        for path in sorted((ROOT / "conformance/sessions").glob("*.json")):
            contents = load(f"conformance/sessions/{path.name}")
            if contents["level"] != "peer":
                continue
            for script in contents["scripts"]:
                with self.subTest(path.name, script=script["name"]):
                    loop = Loop()
                    try:
                        loop.run_until_complete(Run(loop, script["given"]).run(script["steps"]))
                    finally:
                        loop.close()
                    scripts += 1
                    holds("peer")
        self.assertGreaterEqual(scripts, 50)


if __name__ == "__main__":
    unittest.main()
