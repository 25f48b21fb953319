"""An app whose robot sends garbage, stalls, closes, lies about lengths, or floods it."""

from __future__ import annotations

import asyncio
import unittest
from dataclasses import replace
from typing import Any

import fc_runtime as rt
import sample
from sample import Docking, Phase
from virtual import Listener, Raw, clocked, limits

GET, DOCKING = 0x0100, 0x0300


class Robots(unittest.TestCase):
    async def meet(self, **config: Any) -> tuple[Listener, sample.Client, Raw]:
        listener = Listener()
        settings: dict[str, Any] = {"reconnect": None, "call_timeout": 1000.0, "first_id": 1, **config}
        client = await sample.Client.connect(
            rt.ClientConfig(host="127.0.0.1", command_port=await listener.listen(), **settings)
        )
        return listener, client, await listener.accept()

    async def lost(self, data: bytes, *, heard: bool = False, closes: bool = False) -> tuple[str, str, float]:
        """Returns the error of a call, its loss and its time, if the robot responds with these bytes."""
        listener, client, robot = await self.meet()
        loop = asyncio.get_running_loop()
        if heard:
            robot.send(GET, b'{"resultCode":1001}', 99, response=True)
        calling = asyncio.ensure_future(client.get_battery())
        await robot.frames(1)
        since = loop.time()
        robot.writer.write(data)
        if closes:
            robot.close()
        with self.assertRaises(rt.LostError) as caught:
            await calling
        robot.close()
        listener.close()
        return caught.exception.name, caught.exception.loss.name, loop.time() - since

    @clocked
    async def test_a_call_says_why_the_connection_was_lost(self) -> None:
        frame = Raw.__new__(Raw)
        frame.encoder = rt.Encoder(sample.SAMPLE)
        whole = frame.frame(GET, b'{"resultCode":1001}', response=True)
        self.assertEqual((await self.lost(b"HTTP/1.1 200 OK\r\n\r\n"))[1], "bad_head")
        self.assertEqual((await self.lost(whole[:11] + b"\xff\xff\xff\xff" + whole[15:]))[1], "frame_too_long")
        self.assertEqual((await self.lost(whole[:11] + bytes(4) + whole[15:]))[1], "short_frame")
        self.assertEqual((await self.lost(whole[:20], closes=True))[1], "truncated")
        self.assertEqual((await self.lost(b"", closes=True))[1], "closed_unheard")
        self.assertEqual((await self.lost(b"", closes=True, heard=True))[1], "closed_by_robot")
        name, why, took = await self.lost(whole[:20])
        self.assertEqual((name, why), ("lost", "stalled"))
        self.assertTrue(9.9 < took < 11, took)

    @clocked
    async def test_swallowed_responses_time_out(self) -> None:
        listener, client, robot = await self.meet()
        loop = asyncio.get_running_loop()
        calling = asyncio.ensure_future(client.get_battery())
        (request,) = await robot.frames(1)
        answer = robot.encoder.encode(request.id.answer(), b'{"resultCode":1001}')
        # It claims a million bytes, and valid frames follow.
        robot.writer.write(answer[:11] + (1_000_000).to_bytes(4, "big") + answer[15:])
        since = loop.time()
        while not calling.done():
            await asyncio.wait({calling}, timeout=1)
            robot.writer.write(answer)
        with self.assertRaises(rt.LostError) as caught:
            await calling
        self.assertEqual(caught.exception.loss.kind, rt.LossKind.STALLED)
        self.assertLess(loop.time() - since, 12)
        robot.close()
        listener.close()

    @clocked
    async def test_a_broken_answer_ends_its_call_alone(self) -> None:
        listener, client, robot = await self.meet()
        first = asyncio.ensure_future(client.get_battery())
        second = asyncio.ensure_future(client.get_battery())
        one, two = await robot.frames(2)
        broken = bytearray(robot.encoder.encode(one.id.answer(), b'{"resultCode":1001}'))
        broken[-1] ^= 1
        robot.writer.write(bytes(broken))
        robot.answer(two, b'{"resultCode":1001,"level":1,"phase":0}')
        with self.assertRaises(rt.FrameCallError) as caught:
            await first
        self.assertEqual(caught.exception.error.name, "bad_digest")
        self.assertEqual((await second).level, 1)
        third = asyncio.ensure_future(client.get_battery())
        (three,) = await robot.frames(1)
        robot.answer(three, b'{"resultCode":1001,"level":[' + b"[" * 100_000)
        with self.assertRaises(rt.InvalidResponseError) as deep:
            await third
        self.assertEqual(deep.exception.error.name, "too_deep")
        self.assertEqual(client.counters.bad_frames, 1)
        client.close()
        listener.close()

    @clocked
    async def test_flood_of_reports_is_bounded_and_repeated(self) -> None:
        listener, client, robot = await self.meet(limits=limits(queued_reports=5))
        reports = client.reports()
        for number in range(20):
            robot.send(DOCKING, b'{"phase":1}', number, kind=3)
        self.assertEqual([one.id.id for one in await robot.frames(5)], [0, 1, 2, 3, 4])
        calling = asyncio.ensure_future(client.get_battery())
        (request,) = await robot.frames(1)
        robot.answer(request, b'{"resultCode":1001,"level":1,"phase":0}')
        await calling
        self.assertEqual((client.counters.reports, client.counters.reports_refused), (5, 15))
        for _ in range(5):
            self.assertEqual(await reports.recv(), Docking(phase=Phase.DRIVING))
        robot.send(DOCKING, b'{"phase":1}', 7, kind=3)
        robot.send(DOCKING, b'{"phase":1}', 4, kind=3)
        self.assertEqual([one.id.id for one in await robot.frames(2)], [7, 4])
        self.assertEqual(client.counters.repeated_reports, 1)
        client.close()
        listener.close()

    @clocked
    async def test_unreadable_report_is_refused(self) -> None:
        listener, client, robot = await self.meet()
        reports = client.reports()
        robot.send(DOCKING, b'{"phase":"x"}', 1, kind=3)
        robot.send(DOCKING, b"{", 2, kind=3)
        robot.send(0x0999, b'{"new":1}', 3, kind=3)
        robot.send(GET, b"{}", 4)
        answers = await robot.frames(4)
        self.assertEqual([b"2003" in one.data for one in answers], [True, True, False, False])
        self.assertIn(b"1001", answers[2].data)
        self.assertIn(b"2001", answers[3].data)
        unknown = await reports.recv()
        assert isinstance(unknown, rt.RawReport)
        self.assertEqual((unknown.code, unknown.data), (0x0999, b'{"new":1}'))
        self.assertNotIn("new", repr(unknown))
        self.assertEqual(client.counters.reports_invalid, 2)
        client.close()
        self.assertIsNone(await reports.recv())
        listener.close()

    @clocked
    async def test_too_many_bytes_are_refused(self) -> None:
        listener, client, robot = await self.meet(queued_bytes=30)
        reports = client.reports()
        for number in range(3):
            robot.send(DOCKING, b'{"phase":1}', number, kind=3)
        self.assertEqual([one.id.id for one in await robot.frames(2)], [0, 1])
        await reports.recv()
        robot.send(DOCKING, b'{"phase":1}', 2, kind=3)
        self.assertEqual([one.id.id for one in await robot.frames(1)], [2])
        client.close()
        listener.close()

    @clocked
    async def test_call_limit_is_busy_and_cancelling_makes_room(self) -> None:
        listener, client, robot = await self.meet(limits=limits(in_flight=2))
        first, second = (asyncio.ensure_future(client.get_battery()) for _ in range(2))
        await robot.frames(2)
        with self.assertRaises(rt.BusyError):
            await client.get_battery()
        first.cancel()
        await asyncio.wait({first})
        third = asyncio.ensure_future(client.get_battery())
        self.assertEqual(len(await robot.frames(1)), 1)
        client.close()
        for call in (second, third):
            with self.assertRaises(rt.LostError):
                await call
        listener.close()

    @clocked
    async def test_a_robot_that_does_not_read_loses_its_app(self) -> None:
        listener, client, robot = await self.meet()
        robot.writer.transport.pause_reading()  # type: ignore[attr-defined]
        request = sample.GetBatteryRequest(extra=rt.Extra({"note": "x" * (8 << 20)}))
        calls = [asyncio.ensure_future(client.get_battery(request)) for _ in range(2)]
        for call in calls:
            with self.assertRaises(rt.LostError) as caught:
                await call
            self.assertEqual(caught.exception.loss.kind, rt.LossKind.UNREAD)
        robot.writer.transport.abort()
        listener.close()

    @clocked
    async def test_late_report_is_counted_and_delivered(self) -> None:
        class Beats(sample.Client):
            protocol = replace(
                sample.SAMPLE, reports=(replace(sample.operations.DOCKING, cadence=rt.Cadence(every=1.0)),)
            )

        listener = Listener()
        port = await listener.listen()
        config = rt.ClientConfig(host="127.0.0.1", command_port=port, reconnect=rt.Backoff(first=0, longest=0))
        client = await Beats.connect(config)
        robot = await listener.accept()
        reports = client.reports()
        with self.assertLogs("fc_runtime", "WARNING") as log:
            for number, wait in enumerate((0.0, 1.4, 1.6, 1.0, 9.0)):
                await asyncio.sleep(wait)
                robot.send(DOCKING, b'{"phase":1}', number, kind=3)
                self.assertIn(b"1001", (await robot.frames(1))[0].data)
            self.assertEqual((client.counters.reports, client.counters.reports_late), (5, 2))
            # The first report over another connection is not late.
            robot.close()
            robot = await listener.accept()
            await asyncio.sleep(9)
            robot.send(DOCKING, b'{"phase":1}', 9, kind=3)
            await robot.frames(1)
        self.assertEqual((client.counters.reports, client.counters.reports_late), (6, 2))
        self.assertEqual([("lost" in line, "after the last" in line) for line in log.output].count((False, True)), 2)
        self.assertEqual([await reports.recv() for _ in range(6)], [Docking(phase=Phase.DRIVING)] * 6)
        client.close()
        listener.close()

    @clocked
    async def test_a_flood_does_not_flood_the_log(self) -> None:
        listener, client, robot = await self.meet(reconnect=rt.Backoff(first=0.01, longest=1))
        with self.assertLogs("fc_runtime", "INFO") as log:
            for number in range(51):
                if number == 50:
                    await asyncio.sleep(120)
                robot.writer.write(b"garbage, and more of it than a header has")
                await robot.is_closed()
                if number < 50:
                    robot = await listener.accept()
            listener.close()
            await asyncio.sleep(600)
        lost = [line for line in log.output if "lost" in line]
        self.assertLess(len(lost), 12)
        self.assertIn("held", lost[-1])
        self.assertLess(len([line for line in log.output if "cannot connect" in line]), 60)
        client.close()

    @clocked
    async def test_attempts_are_given_up_as_configured(self) -> None:
        listener, client, robot = await self.meet(reconnect=rt.Backoff(first=0.1, longest=1, attempts=3))
        listener.close()
        robot.close()
        loss = await client.closed()
        self.assertEqual(loss.kind, rt.LossKind.UNREACHABLE)
        with self.assertRaises(rt.ClosedError):
            await client.get_battery()


if __name__ == "__main__":
    unittest.main()
