"""A client and a robot over TCP on this machine, with the sample protocol."""

from __future__ import annotations

import asyncio
import logging
import shutil
import socket
import ssl
import struct
import tempfile
import unittest
from dataclasses import dataclass, field, replace
from typing import Annotated, Any

import fc_runtime as rt
from fc_runtime import calls, connection, server, states
from fc_runtime.config import ClientConfig, ServerConfig
from fc_runtime.receivers import RawReport
from support import PROTOCOL, AsyncCase

PATIENCE = 20.0


@dataclass(slots=True, kw_only=True)
class Say(rt.Message):
    text: Annotated[str, rt.Key("text", length=(0, 5))]
    extra: rt.Extra = field(default_factory=rt.Extra)


@dataclass(slots=True, kw_only=True)
class Moved(rt.Message):
    metres: Annotated[rt.I32, rt.Key("metres")]
    extra: rt.Extra = field(default_factory=rt.Extra)


READ = rt.Command(name="read", code=100, zh="", en="", request=Say, response=Say, effect=rt.Effect.READ)
GO = rt.Command(name="go", code=200, zh="", en="", request=Moved, response=Moved, effect=rt.Effect.MOTION)
MOVED = rt.Report(name="moved", code=300, zh="", en="", request=Moved, response=Moved)
TOY = replace(PROTOCOL, commands=(READ, GO), reports=(MOVED,))


class Network(AsyncCase):
    async def robot(
        self,
        handlers: dict[int, rt.Handler],
        port: int = 0,
        handler_timeout: float | None = None,
        **limits: Any,
    ) -> server.Server:
        config = replace(rt_server_config(port, **limits), handler_timeout=handler_timeout)
        robot = server.Server(rt.Handlers(TOY, handlers), config)
        await robot.bind()
        self.address = robot.command_address
        return robot

    async def client(self, **config: Any) -> connection.Connection:
        host, port = self.address
        client = connection.Connection(TOY, ClientConfig(host=host, command_port=port, **config))
        await client.connect()
        self.addCleanup(client.close)
        return client

    async def test_a_call_is_answered(self) -> None:
        robot = await self.robot({100: echo})
        client = await self.client()
        extra = rt.Extra({"note": [1, None]})
        answer = await client.call(READ, Say(text="hi", extra=extra))
        self.assertEqual(answer, Say(text="hi", extra=extra))
        many = await asyncio.gather(*(client.call(READ, Say(text=str(n))) for n in range(200)))
        self.assertEqual([one.text for one in many], [str(n) for n in range(200)])
        self.assertEqual(client.counters.bytes_in, robot.counters.bytes_out)
        self.assertEqual(client.counters.bytes_out, robot.counters.bytes_in)
        await robot.shutdown(0)

    async def test_a_handler_knows_address_and_time_of_the_request(self) -> None:
        contexts: list[rt.Context] = []

        async def handler(context: rt.Context, request: Say) -> Say:
            contexts.append(context)
            return request

        robot = await self.robot({100: handler})
        client = await self.client()
        await client.call(READ, Say(text="hi"))
        (context,) = contexts
        self.assertEqual(context.address, "127.0.0.1")
        self.assertIsInstance(context.time_ms, int)
        await robot.shutdown(0)

    async def test_errors_have_their_names(self) -> None:
        async def refuse(_: rt.Context, __: Say) -> Say:
            raise calls.Refusal(3001, "not now")

        robot = await self.robot({100: refuse}, in_flight=1)
        client = await self.client()
        self.assertEqual(await name_of(client.call(READ, Say(text="hi"))), "refused")
        self.assertEqual(await name_of(client.call(READ, Say(text="too long"))), "invalid_request")
        with self.assertRaises(calls.RefusedError) as caught:
            await client.call(GO, Moved(metres=1))
        self.assertEqual(caught.exception.refusal.code, 2001)
        self.assertIn("not implemented", caught.exception.refusal.text)
        await robot.shutdown(0)
        client.close()
        self.assertEqual(await name_of(client.call(READ, Say(text="hi"))), "closed")

    async def test_close_during_a_failed_attempt_is_honoured(self) -> None:
        dialled: asyncio.Queue[asyncio.Future[Any]] = asyncio.Queue()

        def dial(_: Any) -> asyncio.Future[Any]:
            attempt: asyncio.Future[Any] = asyncio.get_running_loop().create_future()
            dialled.put_nowait(attempt)
            return attempt

        before = asyncio.all_tasks()
        client = connection.Connection(TOY, ClientConfig(reconnect=rt.Backoff(first=0.0)), dial)
        client.connect_lazy()
        (await asyncio.wait_for(dialled.get(), PATIENCE)).set_exception(OSError())
        client.close()
        _, going_on = await asyncio.wait(asyncio.all_tasks() - before, timeout=PATIENCE)
        self.assertEqual(going_on, set())

    async def test_any_failed_attempt_is_a_connect_error(self) -> None:
        # Neither can be encoded as a host name.
        for host in ("x" * 64 + ".example", "a..b"):
            with self.subTest(host=host), self.assertRaises(rt.ConnectError) as caught:
                await connection.Connection(TOY, ClientConfig(host=host)).connect()
            self.assertIs(caught.exception.loss.kind, rt.LossKind.UNREACHABLE)

        async def dial(_: Any) -> Any:
            raise LookupError("no proxy")

        with self.assertRaisesRegex(rt.ConnectError, "unreachable: LookupError"):
            await connection.Connection(TOY, ClientConfig(), dial).connect()
        lazy = connection.Connection(TOY, ClientConfig(reconnect=rt.Backoff(first=0.0, attempts=2)), dial)
        lazy.connect_lazy()
        self.assertEqual((await asyncio.wait_for(lazy.closed(), PATIENCE)).detail, "LookupError")

    async def test_raw_call_sends_given_keys_and_returns_all(self) -> None:
        robot = await self.robot({100: echo})
        client = await self.client()
        answer = await client.call_raw(100, rt.Json('{"text":"a","n":1e2}'))
        self.assertIsNone(answer.refusal)
        self.assertIn('"resultCode":1001', answer.json.text)
        self.assertTrue(answer.json.text.endswith('"text":"a","n":1e2}'), answer.json.text)
        refused = await client.call_raw(100)
        assert refused.refusal is not None
        self.assertEqual(refused.refusal.code, 2003)
        self.assertEqual(await name_of(client.call_raw(100, rt.Json("[]"))), "invalid_request")
        await robot.shutdown(0)

    async def test_a_report_is_acknowledged_once_and_handed_on(self) -> None:
        robot = await self.robot({100: echo})
        client = await self.client()
        receiver = client.receiver()
        await client.call(READ, Say(text="hi"))
        (outcome,) = await asyncio.wait_for(robot.push(MOVED, Moved(metres=7)), PATIENCE)
        self.assertEqual(outcome.outcome, rt.Outcome.ACKNOWLEDGED)
        event = await asyncio.wait_for(receiver.next(), PATIENCE)
        assert isinstance(event, RawReport)
        self.assertEqual(client.read_report(event, Moved), Moved(metres=7))
        await robot.shutdown(0)

    async def test_read_is_sent_again_after_a_loss_motion_is_not(self) -> None:
        begun: asyncio.Queue[str] = asyncio.Queue()

        async def hang(context: rt.Context, _: Any) -> Any:
            await begun.put(str(context.code))
            await asyncio.Event().wait()

        robot = await self.robot({100: hang, 200: hang})
        client = await self.client(call_timeout=PATIENCE)
        read = asyncio.ensure_future(client.call(READ, Say(text="hi")))
        motion = asyncio.ensure_future(client.call(GO, Moved(metres=1)))
        self.assertEqual({await begun.get(), await begun.get()}, {"100", "200"})
        port = self.address[1]
        await robot.shutdown(0)
        self.assertEqual(await name_of(motion), "lost")
        robot = await self.robot({100: echo}, port)
        self.assertEqual((await read).text, "hi")
        self.assertEqual(client.state, states.Connected(2))
        await robot.shutdown(0)

    async def test_a_cancelled_call_frees_its_place(self) -> None:
        async def hang(_: rt.Context, __: Any) -> Any:
            await asyncio.Event().wait()

        robot = await self.robot({100: hang})
        client = await self.client()
        call = asyncio.ensure_future(client.call(READ, Say(text="hi")))
        await asyncio.sleep(0)
        self.assertEqual(client.in_flight, 1)
        call.cancel()
        with self.assertRaises(asyncio.CancelledError):
            await call
        self.assertEqual(client.in_flight, 0)
        await robot.shutdown(0)

    async def test_a_robot_that_ends_answers_what_it_has_begun(self) -> None:
        begun, go_on = asyncio.Event(), asyncio.Event()

        async def slow(_: rt.Context, request: Say) -> Say:
            begun.set()
            await go_on.wait()
            return request

        robot = await self.robot({100: slow})
        client = await self.client()
        call = asyncio.ensure_future(client.call(READ, Say(text="hi"), repeat=False))
        await begun.wait()
        ending = asyncio.ensure_future(robot.shutdown(PATIENCE))
        await asyncio.sleep(0)
        go_on.set()
        self.assertEqual((await call).text, "hi")
        await ending

    async def test_motion_outlives_its_connection_and_read_ends(self) -> None:
        go_on, ended = asyncio.Event(), asyncio.Event()
        abandoned: list[int] = []
        cancelled: list[int] = []

        async def work(context: rt.Context, request: Any) -> Any:
            try:
                await context.abandoned()
                abandoned.append(context.code)
                await go_on.wait()
            except asyncio.CancelledError:
                cancelled.append(context.code)
                raise
            ended.set()
            return request

        robot = await self.robot({100: work, 200: work}, handler_timeout=0.0)
        client = await self.client()
        for call in (client.call(READ, Say(text="hi")), client.call(GO, Moved(metres=1))):
            with self.assertRaises(calls.RefusedError) as caught:
                await call
            self.assertEqual(caught.exception.refusal.code, 2002)
        go_on.set()
        await asyncio.wait_for(ended.wait(), PATIENCE)
        self.assertEqual((abandoned, cancelled), ([200], [100]))
        self.assertEqual(robot.counters.handlers_abandoned, 1)
        await robot.shutdown(0)

    async def test_garbage_ends_its_own_connection_alone(self) -> None:
        robot = await self.robot({100: echo})
        client = await self.client()
        reader, writer = await asyncio.open_connection(*self.address)
        writer.write(b"GET / HTTP/1.1\r\n\r\n")
        self.assertEqual(await asyncio.wait_for(reader.read(), PATIENCE), b"")
        writer.close()
        self.assertEqual((await client.call(READ, Say(text="hi"))).text, "hi")
        await robot.shutdown(0)

    async def test_reset_connection_delays_no_shutdown(self) -> None:
        robot = await self.robot({100: echo})
        with socket.create_connection(self.address) as app:
            while robot.counters.connections == 0:
                await asyncio.sleep(0)
            app.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        # The robot has not noticed the reset yet.
        await asyncio.wait_for(robot.shutdown(0), PATIENCE)

    async def test_deep_body_is_refused_and_connection_stays(self) -> None:
        robot = await self.robot({100: echo})
        client = await self.client()
        body = b'{"text":' + b"[" * 100_000
        deep = await client._fly(100, lambda: body, None, repeat=False)
        self.assertIn(b"too_deep", deep)
        self.assertEqual((await client.call(READ, Say(text="hi"))).text, "hi")
        await robot.shutdown(0)

    @unittest.skipUnless(shutil.which("openssl"), "there is no openssl here to make a certificate with")
    async def test_over_tls_it_is_the_same(self) -> None:
        # The failed handshake is a line of asyncio's log.
        log = logging.getLogger("asyncio")
        self.addCleanup(log.setLevel, log.level)
        log.setLevel(logging.CRITICAL)
        with tempfile.TemporaryDirectory() as folder:
            key, certificate = f"{folder}/key.pem", f"{folder}/certificate.pem"
            make = ["openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-keyout", key, "-out", certificate]
            about = ["-subj", "/CN=localhost", "-addext", "subjectAltName=IP:127.0.0.1", "-days", "2"]
            done = await asyncio.create_subprocess_exec(*make, *about, stderr=asyncio.subprocess.DEVNULL)
            self.assertEqual(await done.wait(), 0)
            serving = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
            serving.load_cert_chain(certificate, key)
            trusting = ssl.create_default_context(cafile=certificate)
        robot = server.Server(rt.Handlers(TOY, {100: echo}), replace(rt_server_config(0), ssl=serving))
        await robot.bind()
        self.address = robot.command_address
        client = await self.client(ssl=trusting, data_port=robot.data_address[1])
        self.assertEqual((await client.call(READ, Say(text="hi"))).text, "hi")
        data = rt.DataConnection(client)
        await data.connected()
        await robot.send_data(1, 2, bytes(1 << 20))
        self.assertEqual(len((await data.recv()).data), 1 << 20)
        with self.assertRaises(rt.ConnectError):
            await self.client(ssl=ssl.create_default_context())
        client.close()
        await robot.shutdown(0)

    async def test_with_gzip_both_ways_it_is_the_same(self) -> None:
        always = rt.Gzip(from_bytes=0)
        long = rt.Extra({"note": "x" * 100_000})
        robot = server.Server(rt.Handlers(TOY, {100: echo}), replace(rt_server_config(0), gzip=always))
        await robot.bind()
        self.address = robot.command_address
        client = await self.client(gzip=always, data_port=robot.data_address[1])
        answer = await client.call(READ, Say(text="hi", extra=long))
        self.assertEqual(answer, Say(text="hi", extra=long))
        receiver = client.receiver()
        (outcome,) = await robot.push(MOVED, Moved(metres=1, extra=long))
        self.assertEqual(outcome.outcome, rt.Outcome.ACKNOWLEDGED)
        event = await receiver.next()
        assert isinstance(event, RawReport)
        self.assertEqual(client.read_report(event, Moved).extra, long)
        data = rt.DataConnection(client)
        await data.connected()
        blank = bytes(4 << 20)
        await robot.send_data(1, 2, blank)
        self.assertEqual((await data.recv()).data, blank)
        from_apps = robot.streams()
        await data.send(1, 3, blank)
        sent = await from_apps.recv()
        assert sent is not None
        self.assertEqual(sent.data, blank)
        # All of that took few bytes on the wire.
        self.assertLess(robot.counters.bytes_in + robot.counters.bytes_out, 100_000)
        client.close()
        await robot.shutdown(0)

    async def test_states_end_with_closed(self) -> None:
        robot = await self.robot({100: echo})
        client = await self.client()
        changes = client.states()
        self.assertEqual(await anext(changes), states.Connected(1))
        client.close()
        self.assertEqual([type(state) async for state in changes], [states.Closed])
        self.assertEqual((await client.closed()).kind, calls.LossKind.HERE)
        await robot.shutdown(0)


def rt_server_config(port: int, **limits: Any) -> Any:
    changed = replace(TOY.defaults.limits, **limits)
    return ServerConfig(address="127.0.0.1", command_port=port, data_port=0, limits=changed)


async def echo(_: rt.Context, request: Any) -> Any:
    return request


async def name_of(call: Any) -> str:
    try:
        await call
    except calls.CallError as error:
        return error.name
    return "success"


if __name__ == "__main__":
    unittest.main()
