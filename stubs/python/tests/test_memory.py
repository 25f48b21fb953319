"""Memory that an app can make a robot hold: bytes that it sends, and responses that it does not read."""

from __future__ import annotations

import asyncio
import unittest
from typing import Any

import fc_runtime as rt
import sample
from virtual import Raw, clocked, limits, serve, until

GET = 0x0100
STREAM = sample.SAMPLE.stream
# More than one read of a socket returns.
MANY = 20_000
# On a busy machine, sending all of it may take longer than the robot's default timeouts.
PATIENT = {"header_timeout": 3600, "stall_timeout": 3600}


class Memory(unittest.TestCase):
    @clocked
    async def test_frames_that_wait_are_not_read(self) -> None:
        server = await serve(sample.ExampleRobot(), limits=limits(in_flight=10_000), **PATIENT)
        app = await Raw.connect(server.command_address)
        app.writer.write(app.frame(GET, b"{}") * MANY)
        most = 0
        loop = asyncio.get_running_loop()

        def look() -> None:
            nonlocal most
            most = max(most, server.memory)
            loop.call_soon(look)

        look()
        for _ in range(MANY):
            self.assertIsNotNone(await app.next())
        # One chunk of received bytes, and responses up to the limit of a transport.
        self.assertLess(most, 600_000)
        await server.shutdown(0)

    @clocked
    async def test_an_app_that_never_reads_is_not_read(self) -> None:
        server = await serve(sample.ExampleRobot(), **PATIENT)
        app = await Raw.connect(server.command_address)
        app.writer.transport.pause_reading()  # type: ignore[attr-defined]
        app.writer.write(app.frame(GET, b"{}") * MANY * 40)
        await until(lambda: server.memory > 0)
        read = -1
        while read != server.counters.bytes_in:
            read = server.counters.bytes_in
            for _ in range(200):
                await asyncio.sleep(0)
                self.assertLess(server.memory, 600_000)
        # Most of it is still on the app's side.
        self.assertGreater(app.writer.transport.get_write_buffer_size(), 5 << 20)
        app.writer.transport.abort()
        await server.shutdown(0)

    @clocked
    async def test_answers_made_at_a_time_count_before_they_are_sent(self) -> None:
        go_on = asyncio.Event()

        class Large(sample.PartialRobot):
            begun = 0

            async def get_battery(self, context: rt.Context, request: Any) -> sample.GetBatteryResponse:
                self.begun += 1
                await go_on.wait()
                return sample.GetBatteryResponse(level=1, phase=sample.Phase.IDLE, owner="x" * (1 << 20))

        robot = Large()
        server = await serve(robot, memory=16 << 20, limits=limits(in_flight=64))
        modest = await Raw.connect(server.command_address)
        modest.send(GET, b"{}")
        greedy = await Raw.connect(server.command_address)
        greedy.writer.transport.pause_reading()  # type: ignore[attr-defined]
        greedy.writer.write(greedy.frame(GET, b"{}") * 63)
        await until(lambda: robot.begun == 64)
        most = 0
        loop = asyncio.get_running_loop()

        def look() -> None:
            nonlocal most
            most = max(most, server.memory)
            loop.call_soon(look)

        look()
        go_on.set()
        answer = await modest.next()
        assert answer is not None
        self.assertGreater(len(answer.data), 1 << 20)
        await until(lambda: server.counters.connections_evicted == 1)
        self.assertLess(most, 16 << 20)
        greedy.writer.transport.abort()
        await server.shutdown(0)

    @clocked
    async def test_waiting_stream_frames_stay_few(self) -> None:
        server = await serve(sample.ExampleRobot(), connections_per_address=64)
        from_apps = server.streams()
        for number in range(20):
            app = await Raw.connect(server.data_address)
            app.send(0x0401, bytes(1 << 20), number, STREAM)
            app.writer.write_eof()
            if number < 3:
                # The connection is closed, and its frame is dropped.
                self.assertTrue(await app.is_closed())
        await until(lambda: server.counters.data_connections == 20)
        await asyncio.sleep(1)
        self.assertEqual(server.counters.stream_frames_in, 4)
        self.assertLess(server.memory, 12 << 20)
        frames = [await from_apps.recv() for _ in range(20)]
        self.assertEqual({one.id for one in frames if one is not None}, set(range(20)))
        await server.shutdown(0)

    @clocked
    async def test_stream_frames_count_as_memory_of_their_sender(self) -> None:
        server = await serve(sample.ExampleRobot(), memory=16 << 20, queued_bytes=64 << 20)
        from_apps = server.streams()
        modest = await Raw.connect(server.data_address)
        modest.send(0x0401, b"modest", 1, STREAM)
        await until(lambda: server.counters.stream_frames_in == 1)
        bomb = await Raw.connect(server.data_address)
        encoder = rt.Encoder(sample.SAMPLE, compress=rt.Gzip(level=9))
        bomb.writer.write(encoder.encode(rt.FrameId(False, STREAM, 0x0401, 2), bytes(8 << 20)))
        await until(lambda: server.counters.stream_frames_in == 2)
        self.assertGreater(server.memory, 8 << 20)
        bomb.writer.write(encoder.encode(rt.FrameId(False, STREAM, 0x0401, 3), bytes(8 << 20)))
        self.assertTrue(await bomb.is_closed())
        self.assertEqual(server.counters.connections_evicted, 1)
        self.assertLess(server.memory, 1 << 20)
        frame = await from_apps.recv()
        assert frame is not None
        self.assertEqual(frame.data, b"modest")
        modest.send(0x0401, b"again", 4, STREAM)
        frame = await from_apps.recv()
        assert frame is not None
        self.assertEqual(frame.data, b"again")
        await server.shutdown(0)

    @clocked
    async def test_one_long_frame_of_a_stream_fills_the_queue(self) -> None:
        server = await serve(sample.ExampleRobot(), queued_bytes=1 << 20)
        from_apps = server.streams()
        app = await Raw.connect(server.data_address)
        for number in range(3):
            app.send(0x0401, bytes(1 << 20), number, STREAM)
        await until(lambda: server.counters.stream_frames_in == 1)
        await asyncio.sleep(1)
        self.assertEqual(server.counters.stream_frames_in, 1)
        for number in range(3):
            frame = await from_apps.recv()
            assert frame is not None
            self.assertEqual(frame.id, number)
        await server.shutdown(0)

    @clocked
    async def test_unread_responses_count_at_once(self) -> None:
        server = await serve(sample.ExampleRobot(), memory=16 << 20)
        deaf = await Raw.connect(server.command_address)
        deaf.writer.transport.pause_reading()  # type: ignore[attr-defined]
        data = await Raw.connect(server.data_address)
        data.writer.transport.pause_reading()  # type: ignore[attr-defined]
        await until(lambda: (server.counters.connections, server.counters.data_connections) == (1, 1))
        sending = [asyncio.ensure_future(server.send_data(1, 1, bytes(6 << 20))) for _ in range(8)]
        await until(lambda: server.counters.connections_evicted == 1)
        await asyncio.wait(sending)
        report = sample.Docking(phase=sample.Phase.IDLE, extra=rt.Extra({"note": "x" * (6 << 20)}))
        pushing = [asyncio.ensure_future(sample.Reporter(server).docking(report)) for _ in range(4)]
        await until(lambda: server.counters.connections_evicted == 2)
        await asyncio.wait(pushing)
        for app in (deaf, data):
            app.writer.transport.abort()
        await server.shutdown(0)


if __name__ == "__main__":
    unittest.main()
