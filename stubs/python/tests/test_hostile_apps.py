"""A robot among apps that send garbage, stall, do not read, or come in crowds."""

from __future__ import annotations

import asyncio
import unittest
from dataclasses import replace
from typing import Any

import fc_runtime as rt
import sample
from virtual import Raw, clocked, limits, serve, until

GET, DOCK = 0x0100, 0x0200


class Hangs(sample.PartialRobot):
    """A robot whose docking never ends."""

    async def get_battery(self, context: rt.Context, request: sample.GetBatteryRequest) -> sample.GetBatteryResponse:
        return sample.GetBatteryResponse.example()

    async def dock(self, context: rt.Context, request: sample.DockRequest) -> sample.DockResponse:
        await asyncio.Event().wait()
        raise AssertionError


class Hostile(unittest.TestCase):
    async def lives(self, app: Raw) -> None:
        app.send(GET, b"{}", 77)
        answer = await app.next()
        assert answer is not None
        self.assertEqual(answer.id.id, 77)
        self.assertIn(b"1001", answer.data)

    @clocked
    async def test_wrong_head_or_length_closes_only_its_connection(self) -> None:
        server = await serve(Hangs())
        quiet = await Raw.connect(server.command_address)
        for garbage in (b"GET / HTTP/1.1\r\n\r\n", b"\xfc\xaa" + bytes(33), b"\xfc\xaa" + b"\xff" * 33):
            app = await Raw.connect(server.command_address)
            app.writer.write(garbage)
            self.assertTrue(await app.is_closed())
        await self.lives(quiet)
        self.assertEqual(server.counters.bad_frames, 3)
        await server.shutdown(0)

    @clocked
    async def test_invalid_frame_of_known_length_is_answered(self) -> None:
        server = await serve(Hangs())
        app = await Raw.connect(server.command_address)
        good = app.frame(GET, b'{"a":1}')
        reserved, unknown, encoding, digest = (bytearray(good) for _ in range(4))
        reserved[2], unknown[2], encoding[9] = 2, 9, 7
        digest[-1] ^= 1
        app.writer.write(reserved + unknown + encoding + digest)
        # The response to a reserved kind has that kind.
        app.decoder = rt.Decoder(replace(sample.SAMPLE, reserved_kinds=frozenset(), report=9, stream=2))
        for answer in await app.frames(4):
            self.assertIn(b"2001", answer.data)
        await self.lives(app)
        await server.shutdown(0)

    @clocked
    async def test_unreadable_bodies_are_answered(self) -> None:
        server = await serve(Hangs())
        app = await Raw.connect(server.command_address)
        bodies = [b"[" * 100_000, b'{"a":' + b"[" * 100_000, b"\xff", b"{", b'{"a":NaN}', b"[]"]
        for body in bodies:
            app.send(GET, body)
        for answer in await app.frames(len(bodies)):
            self.assertIn(b"2003", answer.data)
        await self.lives(app)
        self.assertEqual(server.counters.calls_invalid, len(bodies))
        await server.shutdown(0)

    @clocked
    async def test_unsolicited_responses_are_ignored(self) -> None:
        server = await serve(Hangs())
        app = await Raw.connect(server.command_address)
        for number in range(20):
            app.send(GET, b'{"resultCode":1001}', number, response=True)
        await self.lives(app)
        await server.shutdown(0)

    @clocked
    async def test_frames_may_come_in_single_bytes_and_in_one_piece(self) -> None:
        server = await serve(Hangs())
        app = await Raw.connect(server.command_address)
        for byte in app.frame(GET, b"{}"):
            app.writer.write(bytes([byte]))
            await app.writer.drain()
        self.assertEqual(len(await app.frames(1)), 1)
        app.writer.write(b"".join(app.frame(GET, b"{}", number) for number in range(200)))
        self.assertEqual({one.id.id for one in await app.frames(200)}, set(range(200)))
        await server.shutdown(0)

    @clocked
    async def test_a_bomb_is_refused(self) -> None:
        server = await serve(Hangs())
        app = await Raw.connect(server.command_address)
        plain = b'{"a":"' + bytes([97]) * (8 << 20) + b'"}'
        packed = rt.Encoder(sample.SAMPLE, compress=rt.Gzip(level=9)).encode(rt.FrameId(False, 1, GET, 3), plain)
        self.assertLess(len(packed), 20_000)
        app.writer.write(packed)
        (answer,) = await app.frames(1)
        self.assertIn(b"2001", answer.data)
        await self.lives(app)
        await server.shutdown(0)

    async def ends_after(self, begin: bytes, drop: bytes, each: float, late: int = 1, **config: Any) -> float:
        """Returns the time until a connection is closed that sends `begin`, and then `drop` every `each` seconds."""
        server = await serve(Hangs(), **config)
        loop = asyncio.get_running_loop()
        app = await Raw.connect(server.command_address)
        app.writer.write(begin)
        since = loop.time()
        closed = asyncio.ensure_future(app.is_closed())
        while not closed.done():
            await asyncio.wait({closed}, timeout=each)
            if drop:
                app.writer.write(drop)
        took = loop.time() - since
        self.assertEqual(server.counters.connections_timed_out, late)
        await server.shutdown(0)
        return took

    @clocked
    async def test_a_header_in_drops_is_not_waited_for(self) -> None:
        took = await self.ends_after(b"\xfc\xaa", b"\x01", 1.0)
        self.assertTrue(4.9 < took < 7, took)

    @clocked
    async def test_stalled_or_trickling_body_times_out(self) -> None:
        app = Raw.__new__(Raw)
        app.encoder = rt.Encoder(sample.SAMPLE)
        begin = app.frame(GET, bytes(100_000))[:100]
        took = await self.ends_after(begin, b"", 1.0)
        self.assertTrue(29.9 < took < 32, took)
        took = await self.ends_after(begin, b"x", 1.0)
        self.assertTrue(29.9 < took < 32, took)
        # At the least rate the frame is completed in the end.
        took = await self.ends_after(begin, bytes(1100), 1.0, late=0)
        self.assertGreater(took, 80)

    @clocked
    async def test_silence_ends_a_connection_if_it_is_to(self) -> None:
        took = await self.ends_after(b"", b"", 1.0, idle_timeout=7.0)
        self.assertTrue(6.9 < took < 9, took)

    @clocked
    async def test_an_app_that_does_not_read_is_neither_read_nor_kept(self) -> None:
        server = await serve(Large(), limits=limits(in_flight=8))
        app = await Raw.connect(server.command_address)
        app.writer.transport.pause_reading()  # type: ignore[attr-defined]
        request = app.frame(GET, b"{}")
        for _ in range(10_000):
            app.writer.write(request)
        await until(lambda: server.counters.calls_succeeded > 0)
        for _ in range(1000):
            await asyncio.sleep(0)
        self.assertLess(server.counters.calls_succeeded, 200)
        self.assertLess(server.memory, 64 << 20)
        await until_closed(server)
        self.assertEqual(server.counters.connections_timed_out, 1)
        app.writer.transport.abort()
        await server.shutdown(0)

    @clocked
    async def test_requests_before_invalid_bytes_are_answered(self) -> None:
        server = await serve(Hangs())
        app = await Raw.connect(server.command_address)
        # Enough bytes that the robot has not read all of them when it closes.
        app.writer.write(app.frame(GET, b"{}", 5) + b"garbage" * 500_000)
        (answer,) = await app.frames(1)
        self.assertEqual(answer.id.id, 5)
        self.assertTrue(await app.is_closed())
        await server.shutdown(0)

    @clocked
    async def test_slow_reader_gets_all_and_silent_reader_is_closed(self) -> None:
        server = await serve(Large(), limits=limits(in_flight=8))
        apps = [await Raw.connect(server.command_address) for _ in range(2)]
        for app in apps:
            app.writer.transport.pause_reading()  # type: ignore[attr-defined]
            app.writer.write(app.frame(GET, b"{}") * 40)
            app.writer.write_eof()
        slow, deaf = apps
        await until(lambda: server.counters.calls_succeeded >= 16)
        for _ in range(40):
            await asyncio.sleep(3)
            slow.writer.transport.resume_reading()  # type: ignore[attr-defined]
            self.assertIsNotNone(await slow.next())
            slow.writer.transport.pause_reading()  # type: ignore[attr-defined]
        await until_closed(server)
        deaf.writer.transport.resume_reading()  # type: ignore[attr-defined]
        answers = 0
        while await deaf.next() is not None:
            answers += 1
        self.assertLess(answers, 40)
        await server.shutdown(0)

    @clocked
    async def test_connections_take_turns(self) -> None:
        server = await serve(Hangs(), limits=limits(in_flight=10_000))
        busy = await Raw.connect(server.command_address)
        modest = await Raw.connect(server.command_address)
        await self.lives(modest)
        # All of it has arrived before the robot reads any.
        busy.writer.write(busy.frame(GET, b"{}") * 5000)
        modest.send(GET, b"{}", 9)
        busy.writer.write_eof()
        (answer,) = await modest.frames(1)
        self.assertEqual(answer.id.id, 9)
        self.assertLess(server.counters.calls_succeeded, 2500)
        # An app that has ended sending gets responses up to its last request.
        self.assertEqual(len(await busy.frames(5000)), 5000)
        self.assertTrue(await busy.is_closed())
        await server.shutdown(0)

    @clocked
    async def test_useless_work_is_slowed_down(self) -> None:
        server = await serve(Hangs())
        app = await Raw.connect(server.command_address)
        loop = asyncio.get_running_loop()
        for number, paced in ((250, False), (1000, True)):
            since = loop.time()
            app.writer.write(app.frame(0x0999, b"{}") * number)
            await app.frames(number)
            self.assertEqual(server.counters.connections_paced > 0, paced)
            if paced:
                self.assertGreater(loop.time() - since, 0.5)
        await server.shutdown(0)

    @clocked
    async def test_connection_with_most_memory_is_closed(self) -> None:
        server = await serve(Hangs(), memory=4 << 20)
        modest = await Raw.connect(server.command_address)
        await self.lives(modest)
        greedy = await Raw.connect(server.command_address)
        greedy.writer.write(greedy.frame(GET, bytes(8 << 20))[:-1])
        self.assertTrue(await greedy.is_closed())
        await self.lives(modest)
        self.assertEqual(server.counters.connections_evicted, 1)
        await server.shutdown(0)

    @clocked
    async def test_address_limit_holds_and_silent_ones_give_way(self) -> None:
        server = await serve(Hangs(), connections_per_address=3)
        speaking = [await Raw.connect(server.command_address) for _ in range(2)]
        for app in speaking:
            await self.lives(app)
        silent = await Raw.connect(server.command_address)
        newcomer = await Raw.connect(server.command_address)
        self.assertTrue(await silent.is_closed())
        await self.lives(newcomer)
        refused = await Raw.connect(server.command_address)
        self.assertTrue(await refused.is_closed())
        counters = server.counters
        self.assertEqual((counters.connections_displaced, counters.connections_refused), (1, 1))
        await server.shutdown(0)

    @clocked
    async def test_at_most_so_many_connections_in_all(self) -> None:
        server = await serve(Hangs(), limits=limits(connections=2))
        apps = [await Raw.connect(server.command_address) for _ in range(2)]
        for app in apps:
            await self.lives(app)
        refused = await Raw.connect(server.command_address)
        self.assertTrue(await refused.is_closed())
        apps[0].close()
        await until(lambda: len(server.connections) == 1)
        await self.lives(await Raw.connect(server.command_address))
        await server.shutdown(0)

    @clocked
    async def test_forbidden_address_cannot_connect_or_move(self) -> None:
        server = await serve(Hangs(), allow={"10.0.0.0/8": set(rt.Effect)})
        for address in (server.command_address, server.data_address):
            app = await Raw.connect(address)
            self.assertTrue(await app.is_closed())
        self.assertEqual(server.counters.connections_forbidden, 2)
        await server.shutdown(0)
        server = await serve(Hangs(), allow={"127.0.0.0/8": [rt.Effect.READ], "0.0.0.0/0": set(rt.Effect)})
        app = await Raw.connect(server.command_address)
        await self.lives(app)
        app.send(DOCK, b'{"dock":"A"}')
        (answer,) = await app.frames(1)
        self.assertIn(b"not allowed", answer.data)
        self.assertEqual(server.counters.calls_forbidden, 1)
        await server.shutdown(0)


class Large(sample.PartialRobot):
    """A robot with long responses."""

    async def get_battery(self, context: rt.Context, request: sample.GetBatteryRequest) -> sample.GetBatteryResponse:
        return sample.GetBatteryResponse(level=1, phase=sample.Phase.IDLE, owner="x" * (256 << 10))


async def until_closed(server: rt.Server) -> None:
    while server.connections:
        await asyncio.sleep(1)


if __name__ == "__main__":
    unittest.main()
