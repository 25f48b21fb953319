"""The end of a robot under load: requests in handlers get their responses, and nothing takes longer than the grace."""

from __future__ import annotations

import asyncio
import socket
import struct
import unittest
from collections import Counter

import fc_runtime as rt
import sample
from sample import Docking, DockRequest, DockResponse, GetBatteryRequest, GetBatteryResponse, Phase
from virtual import Raw, clocked, limits, serve, until

GET = 0x0100


class Slow(sample.PartialRobot):
    """A robot whose handlers take as long as the test lets them."""

    def __init__(self) -> None:
        self.go_on = asyncio.Event()
        self.begun = self.ended = self.cancelled = 0

    async def get_battery(self, context: rt.Context, request: GetBatteryRequest) -> GetBatteryResponse:
        await self.work()
        return GetBatteryResponse.example()

    async def dock(self, context: rt.Context, request: DockRequest) -> DockResponse:
        await self.work()
        return DockResponse()

    async def work(self) -> None:
        self.begun += 1
        try:
            await self.go_on.wait()
        except asyncio.CancelledError:
            self.cancelled += 1
            raise
        self.ended += 1


async def ends(call: asyncio.Future[GetBatteryResponse]) -> str:
    try:
        await call
    except rt.CallError as error:
        return error.name
    return "success"


class Shutdown(unittest.TestCase):
    async def client(self, server: rt.Server) -> sample.Client:
        host, port = server.command_address
        _, data_port = server.data_address
        config = rt.ClientConfig(host=host, command_port=port, data_port=data_port, reconnect=None, call_timeout=1000)
        return await sample.Client.connect(config)

    @clocked
    async def test_shutdown_answers_running_calls_only(self) -> None:
        robot = Slow()
        server = await serve(robot, handler_timeout=1000)
        clients = [await self.client(server) for _ in range(4)]
        calls = [asyncio.ensure_future(one.get_battery()) for one in clients for _ in range(50)]
        await until(lambda: robot.begun == 200)
        ending = asyncio.ensure_future(server.shutdown(60))
        await asyncio.sleep(0.01)
        late = asyncio.ensure_future(clients[0].get_battery())
        await asyncio.sleep(0.01)
        robot.go_on.set()
        self.assertEqual(Counter([await ends(one) for one in calls]), {"success": 200})
        self.assertEqual(await ends(late), "lost")
        await ending
        self.assertEqual((robot.begun, robot.ended), (200, 200))
        await server.run()

    @clocked
    async def test_shutdown_ends_at_its_limit(self) -> None:
        robot = Slow()
        server = await serve(robot, handler_timeout=1000)
        client = await self.client(server)
        calls = [asyncio.ensure_future(client.get_battery()) for _ in range(3)]
        motion = client.dock(DockRequest.example())

        async def docks() -> str:
            try:
                await motion
            except rt.CallError as error:
                return error.name
            return "success"

        docking = asyncio.ensure_future(docks())
        await until(lambda: robot.begun == 4)
        loop = asyncio.get_running_loop()
        since = loop.time()
        await server.shutdown(5)
        self.assertTrue(4.9 < loop.time() - since < 6.5)
        self.assertEqual([await ends(one) for one in calls], ["lost"] * 3)
        self.assertEqual(await docking, "lost")
        await asyncio.sleep(0)
        self.assertEqual((robot.ended, robot.cancelled), (0, 4))

    @clocked
    async def test_slow_reader_gets_its_responses(self) -> None:
        class Long(sample.PartialRobot):
            async def get_battery(self, context: rt.Context, request: GetBatteryRequest) -> GetBatteryResponse:
                return GetBatteryResponse(level=1, phase=Phase.IDLE, owner="x" * (8 << 20))

        server = await serve(Long())
        app = await Raw.connect(server.command_address)
        app.writer.transport.pause_reading()  # type: ignore[attr-defined]
        app.writer.write(app.frame(GET, b"{}") * 3)
        await until(lambda: server.counters.calls_succeeded == 3)
        ending = asyncio.ensure_future(server.shutdown(120))
        await asyncio.sleep(5)
        self.assertFalse(ending.done())
        for _ in range(3):
            await asyncio.sleep(5)
            app.writer.transport.resume_reading()  # type: ignore[attr-defined]
            answer = await app.next()
            assert answer is not None
            self.assertGreater(len(answer.data), 8 << 20)
            app.writer.transport.pause_reading()  # type: ignore[attr-defined]
        app.writer.transport.resume_reading()  # type: ignore[attr-defined]
        self.assertTrue(await app.is_closed())
        await ending

    @clocked
    async def test_stalled_apps_delay_no_shutdown(self) -> None:
        server = await serve(sample.ExampleRobot())
        half = await Raw.connect(server.command_address)
        half.writer.write(half.frame(GET, b"{}")[:20])
        deaf = await Raw.connect(server.command_address)
        deaf.writer.transport.pause_reading()  # type: ignore[attr-defined]
        deaf.send(GET, b"{}")
        data = await Raw.connect(server.data_address)
        data.writer.transport.pause_reading()  # type: ignore[attr-defined]
        silent = await Raw.connect(server.command_address)
        await until(lambda: len(server.connections) == 3 and server.counters.data_connections == 1)
        pushing = asyncio.ensure_future(sample.Reporter(server).docking(Docking(phase=Phase.IDLE)))
        sending = asyncio.ensure_future(server.send_data(0x0400, 1, bytes(8 << 20)))
        more = [asyncio.ensure_future(server.send_data(0x0400, 1, bytes(8 << 20))) for _ in range(8)]
        await asyncio.sleep(0.01)
        loop = asyncio.get_running_loop()
        since = loop.time()
        await server.shutdown(3)
        self.assertLess(loop.time() - since, 4)
        self.assertEqual({one.outcome for one in await pushing}, {rt.Outcome.CLOSED})
        await asyncio.wait({sending, *more})
        self.assertIsNotNone(await silent.next(), "the report")
        self.assertTrue(await silent.is_closed())
        self.assertEqual(server.connections, [])
        for app in (half, deaf, data):
            app.writer.transport.abort()

    @clocked
    async def test_shutdown_waits_for_a_detached_motion(self) -> None:
        robot = Slow()
        server = await serve(robot, handler_timeout=1000)
        client = await self.client(server)
        reading = asyncio.ensure_future(client.get_battery())
        docking = asyncio.ensure_future(_dock(client))
        await until(lambda: robot.begun == 2)
        break_off(client)
        self.assertEqual(await ends(reading), "lost")
        self.assertEqual(type(await docking), rt.LostError)
        await until(lambda: robot.cancelled == 1)
        self.assertEqual(server.counters.handlers_abandoned, 1)
        ending = asyncio.ensure_future(server.shutdown(60))
        await asyncio.sleep(1)
        self.assertFalse(ending.done())
        robot.go_on.set()
        await ending
        self.assertEqual((robot.ended, robot.cancelled), (1, 1))

    @clocked
    async def test_no_more_are_begun_than_may_run_on(self) -> None:
        robot = Slow()
        server = await serve(robot, handler_timeout=1, abandoned_handlers=2)
        client = await self.client(server)
        for text, count in (("2002", 1), ("2002", 2), ("too many handlers", 2)):
            with self.assertRaisesRegex(rt.RefusedError, text):
                await client.dock(DockRequest.example())
            self.assertEqual(robot.begun, count)
        self.assertEqual(server.counters.abandoned_reached, 1)
        robot.go_on.set()
        await until(lambda: robot.ended == 2)
        await client.dock(DockRequest.example())
        await server.shutdown(0)
        server = await serve(robot := Slow(), handler_timeout=1, abandoned_handlers=0)
        client = await self.client(server)
        with self.assertRaisesRegex(rt.RefusedError, "2002"):
            await client.dock(DockRequest.example())
        await until(lambda: robot.cancelled == 1)
        await server.shutdown(0)

    @clocked
    async def test_a_handler_that_fails_harms_only_its_own_call(self) -> None:
        class Fails(sample.PartialRobot):
            async def get_battery(self, context: rt.Context, request: GetBatteryRequest) -> GetBatteryResponse:
                if "fail" in request.extra:
                    raise RuntimeError("secret")
                return GetBatteryResponse.example()

            async def dock(self, context: rt.Context, request: DockRequest) -> DockResponse:
                return GetBatteryResponse.example()  # type: ignore[return-value]

        server = await serve(Fails())
        client = await self.client(server)
        failing = GetBatteryRequest(extra=rt.Extra({"fail": True}))
        with self.assertLogs("fc_runtime", "WARNING") as log, self.assertRaisesRegex(rt.RefusedError, "panicked"):
            await client.get_battery(failing)
        self.assertNotIn("secret", str(log.output))
        self.assertIn("RuntimeError", str(log.output))
        self.assertEqual((await client.get_battery()).level, 80)
        self.assertEqual((server.counters.handlers_panicked, server.counters.calls_succeeded), (1, 1))
        with self.assertLogs("fc_runtime", "ERROR") as log:
            for _ in range(50):
                with self.assertRaises(rt.RefusedError):
                    await client.get_battery(failing)
        self.assertLess(len(log.output), 10)
        client.close()
        await server.shutdown(0)

    @clocked
    async def test_a_slow_app_loses_its_own_oldest_reports(self) -> None:
        server = await serve(sample.ExampleRobot(), limits=limits(in_flight=1, queued_reports=2))
        app = await Raw.connect(server.command_address)
        await until(lambda: len(server.connections) == 1)
        reporter = sample.Reporter(server)
        pushes = [asyncio.ensure_future(reporter.docking(Docking(phase=Phase.IDLE, job=number))) for number in range(5)]
        (first,) = await app.frames(1)
        self.assertIn(b'"job":0', first.data)
        outcomes = [asyncio.ensure_future(_outcome(one)) for one in pushes]
        self.assertEqual([await outcomes[1], await outcomes[2]], [rt.Outcome.DROPPED] * 2)
        again = [await app.next() for _ in range(3)]
        self.assertEqual({one.id for one in again if one}, {first.id})
        self.assertEqual(await outcomes[0], rt.Outcome.TIMED_OUT)
        for answer, outcome in ((b'{"resultCode":2003}', "refused"), (b'{"resultCode":"x"}', "invalid")):
            (report,) = await app.frames(1)
            app.answer(report, answer)
            self.assertEqual((await outcomes[3 if outcome == "refused" else 4]).value, outcome)
        counters = server.counters
        self.assertEqual((counters.reports_sent, counters.reports_repeated, counters.reports_dropped), (3, 3, 2))
        await server.shutdown(0)


def break_off(client: sample.Client) -> None:
    """Breaks the connection, as a network does."""
    link = client.connection._link
    assert link is not None and link._transport is not None
    found = link._transport.get_extra_info("socket")
    found.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
    link._transport.abort()


async def _dock(client: sample.Client) -> DockResponse | rt.CallError:
    try:
        return await client.dock(DockRequest.example())
    except rt.CallError as error:
        return error


async def _outcome(push: asyncio.Future[list[rt.Acknowledgement]]) -> rt.Outcome:
    return (await push)[0].outcome


if __name__ == "__main__":
    unittest.main()
