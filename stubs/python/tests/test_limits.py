"""Every limit of messages one below, at and one beyond it."""

from __future__ import annotations

import asyncio
import unittest

import fc_runtime as rt
import sample
from sample import GetBatteryRequest, GetBatteryResponse
from virtual import Raw, clocked, limits, serve, until

GET = 0x0100
HEADER = 35


class Limits(unittest.TestCase):
    async def answer(self, body: bytes, compress: rt.Gzip | None = None, **limited: int) -> bytes:
        """Returns the response of a robot with these limits; `b""` if it closes the connection."""
        server = await serve(sample.ExampleRobot(), limits=limits(**limited))
        app = await Raw.connect(server.command_address)
        encoder = rt.Encoder(sample.SAMPLE, compress=compress)
        app.writer.write(encoder.encode(rt.FrameId(False, 1, GET, 1), body))
        answer = await app.next()
        await server.shutdown(0)
        return b"" if answer is None else answer.data

    @clocked
    async def test_frame_bytes(self) -> None:
        for length, is_taken in ((299, True), (300, True), (301, False)):
            body = b'{"a":"' + b"x" * (length - HEADER - 8) + b'"}'
            self.assertEqual(len(body) + HEADER, length)
            self.assertEqual(b"1001" in await self.answer(body, frame_bytes=300), is_taken)
            if not is_taken:
                self.assertEqual(await self.answer(body, frame_bytes=300), b"")

    @clocked
    async def test_inflated_bytes_and_ratio(self) -> None:
        for length, is_taken in ((4999, True), (5000, True), (5001, False)):
            body = b'{"a":"' + b"x" * (length - 8) + b'"}'
            answer = await self.answer(body, rt.Gzip(from_bytes=0), inflated_bytes=5000)
            self.assertEqual(b"1001" in answer, is_taken)
        body = b'{"a":"' + b"x" * (2 << 20) + b'"}'
        self.assertIn(b"1001", await self.answer(body, rt.Gzip(level=9), inflate_ratio=1100))
        self.assertIn(b"2001", await self.answer(body, rt.Gzip(level=9), inflate_ratio=900))

    @clocked
    async def test_json_depth_and_values(self) -> None:
        for depth, is_taken in ((9, True), (10, True), (11, False)):
            body = b'{"a":' + b"[" * (depth - 1) + b"]" * (depth - 1) + b"}"
            answer = await self.answer(body, json_depth=10)
            self.assertEqual((b"1001" in answer, b"too_deep" in answer), (is_taken, not is_taken))
        for values, is_taken in ((9, True), (10, True), (11, False)):
            body = b'{"a":[' + b",".join([b"1"] * (values - 1)) + b"]}"
            answer = await self.answer(body, json_values=10)
            self.assertEqual((b"1001" in answer, b"too_many_values" in answer), (is_taken, not is_taken))

    @clocked
    async def test_in_flight_at_the_robot(self) -> None:
        class Waits(sample.PartialRobot):
            begun = 0

            async def get_battery(self, context: rt.Context, request: GetBatteryRequest) -> GetBatteryResponse:
                self.begun += 1
                await go_on.wait()
                return GetBatteryResponse.example()

        go_on = asyncio.Event()
        robot = Waits()
        server = await serve(robot, limits=limits(in_flight=3), handler_timeout=1000)
        app = await Raw.connect(server.command_address)
        for number in range(5):
            app.send(GET, b"{}", number)
        await until(lambda: robot.begun == 3)
        await asyncio.sleep(1)
        self.assertEqual((robot.begun, server.counters.in_flight_reached), (3, 1))
        go_on.set()
        self.assertEqual({one.id.id for one in await app.frames(5)}, set(range(5)))
        await server.shutdown(0)

    @clocked
    async def test_handler_and_call_time(self) -> None:
        class Waits(sample.PartialRobot):
            async def get_battery(self, context: rt.Context, request: GetBatteryRequest) -> GetBatteryResponse:
                await asyncio.sleep(2)
                return GetBatteryResponse.example()

        for handler_timeout, call_timeout, expected in ((2.5, 3, "success"), (1.5, 3, "refused"), (3, 1, "timeout")):
            server = await serve(Waits(), handler_timeout=handler_timeout)
            host, port = server.command_address
            config = rt.ClientConfig(host=host, command_port=port, call_timeout=call_timeout)
            async with sample.Client.connect(config) as client:
                try:
                    await client.get_battery()
                    name = "success"
                except rt.CallError as error:
                    name = error.name
                self.assertEqual(name, expected)
            self.assertEqual(server.counters.calls_timed_out, int(expected == "refused"))
            await server.shutdown(0)

    @clocked
    async def test_an_old_request_has_expired(self) -> None:
        server = await serve(sample.ExampleRobot(), max_age=10)
        app = await Raw.connect(server.command_address)
        app.send(GET, b'{"cmdTime":1}')
        app.send(GET, b"{}")
        old, ageless = await app.frames(2)
        self.assertIn(b"2004", old.data)
        self.assertIn(b"1001", ageless.data)
        self.assertEqual(server.counters.calls_expired, 1)
        await server.shutdown(0)

    @clocked
    async def test_passed_through_and_unknown_codes(self) -> None:
        class Passes(sample.PartialRobot):
            async def pass_through(self, context: rt.Context, request: rt.RawRequest) -> rt.Json:
                return rt.Json.of({"code": request.code, "resultCode": 5})

        class Knows(Passes):
            async def unknown(self, context: rt.Context, request: rt.RawRequest) -> rt.Json:
                raise rt.Refusal(7, "seven")

        for robot, unknown in ((Passes(), b"2001"), (Knows(), b'"resultCode":7')):
            server = await serve(robot)
            app = await Raw.connect(server.command_address)
            app.send(0x0555, b'{"a":1}')
            app.send(0x0999, b"{}")
            answers = {one.id.code: one.data for one in await app.frames(2)}
            self.assertIn(b'"code":1365', answers[0x0555])
            self.assertIn(b'"resultCode":1001', answers[0x0555])
            self.assertIn(unknown, answers[0x0999])
            self.assertEqual(server.counters.calls_refused, int(b"7" in unknown))
            await server.shutdown(0)


if __name__ == "__main__":
    unittest.main()
