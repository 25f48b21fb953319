"""Following a command to its end, over TCP: losses, failures, reports of other calls, and early reports."""

from __future__ import annotations

import asyncio
import unittest
from dataclasses import replace
from typing import Any

import fc_runtime as rt
import sample
from sample import Docking, DockRequest, Phase
from virtual import Listener, Raw, clocked

DOCK, DOCKING = 0x0200, 0x0300


class Following(unittest.TestCase):
    async def meet(self, **config: Any) -> tuple[Listener, sample.Client, Raw]:
        listener = Listener()
        self.port = await listener.listen()
        settings: dict[str, Any] = {"reconnect": rt.Backoff(first=0.01, longest=0.01), **config}
        client = await sample.Client.connect(
            rt.ClientConfig(host="127.0.0.1", command_port=self.port, first_id=1, **settings)
        )
        return listener, client, await listener.accept()

    async def begun(self, client: sample.Client, robot: Raw, job: int = 7) -> rt.Following[Any, Docking]:
        calling = asyncio.ensure_future(_follow(client))
        (request,) = await robot.frames(1)
        self.assertEqual(request.id.code, DOCK)
        robot.answer(request, b'{"resultCode":1001,"job":%d}' % job)
        return await calling

    async def report(self, robot: Raw, message_id: int, body: bytes) -> bytes:
        robot.send(DOCKING, body, message_id, kind=3)
        (answer,) = await robot.frames(1)
        return answer.data

    @clocked
    async def test_a_process_is_followed_from_its_start_to_its_end(self) -> None:
        listener, client, robot = await self.meet()
        following = await self.begun(client, robot)
        for number, phase in enumerate((0, 1, 1, 2)):
            self.assertIn(b"1001", await self.report(robot, number, b'{"phase":%d,"job":7}' % phase))
        events = [event async for event in following]
        self.assertEqual([type(event) for event in events], [rt.Going, rt.Going, rt.Going, rt.Ended])
        self.assertIsNone(await following.recv())
        self.assertEqual(client.counters.reports_out_of_order, 0)
        # It takes no more reports, and there is no other receiver.
        robot.send(DOCKING, b'{"phase":1,"job":7}', 9, kind=3)
        calling = asyncio.ensure_future(client.get_battery())
        (request,) = await robot.frames(1)
        self.assertEqual(request.id.code, 0x0100)
        self.assertEqual(client.counters.reports_refused, 1)
        calling.cancel()
        client.close()
        listener.close()

    @clocked
    async def test_a_report_before_the_answer_is_not_lost(self) -> None:
        listener, client, robot = await self.meet()
        calling = asyncio.ensure_future(_follow(client))
        (request,) = await robot.frames(1)
        await self.report(robot, 1, b'{"phase":1}')
        robot.answer(request, b'{"resultCode":1001}')
        following = await calling
        self.assertEqual(await following.recv(), rt.Going(Docking(phase=Phase.DRIVING)))
        client.close()
        listener.close()

    @clocked
    async def test_following_continues_after_a_lost_connection(self) -> None:
        listener, client, robot = await self.meet()
        following = await self.begun(client, robot)
        await self.report(robot, 1, b'{"phase":1,"job":7}')
        robot.close()
        robot = await listener.accept()
        await self.report(robot, 1, b'{"phase":2,"job":7}')
        events = [event async for event in following]
        self.assertEqual([type(event) for event in events], [rt.Going, rt.Interrupted, rt.Resumed, rt.Ended])
        client.close()
        listener.close()

    @clocked
    async def test_failure_ends_following_and_disorder_is_counted(self) -> None:
        listener, client, robot = await self.meet()
        following = await self.begun(client, robot)
        for number, phase in enumerate((1, 0, 77, 9)):
            await self.report(robot, number, b'{"phase":%d,"job":7}' % phase)
        events = [event async for event in following]
        self.assertEqual([type(event) for event in events], [rt.Going, rt.Going, rt.Going, rt.Failed])
        # Only the change from driving to idle counts: the spec does not restrict the others.
        self.assertEqual(client.counters.reports_out_of_order, 1)
        client.close()
        listener.close()

    @clocked
    async def test_missed_reports_are_told_in_order(self) -> None:
        limits = replace(sample.SAMPLE.defaults.limits, queued_reports=2)
        listener, client, robot = await self.meet(limits=limits)
        following = await self.begun(client, robot)
        async with client.reports() as reports:
            for number in range(4):
                await self.report(robot, number, b'{"phase":1,"job":7}')
                self.assertIsNotNone(await reports.recv())
        events = [await following.recv() for _ in range(3)]
        going = rt.Going(Docking(phase=Phase.DRIVING, job=7))
        self.assertEqual(events, [going, going, rt.Missed(2)])
        self.assertEqual(client.counters.reports_missed, 2)
        client.close()
        listener.close()

    @clocked
    async def test_reports_of_another_call_are_not_delivered(self) -> None:
        listener, client, robot = await self.meet()
        first = await self.begun(client, robot, 7)
        second = await self.begun(client, robot, 8)
        await self.report(robot, 1, b'{"phase":2,"job":8}')
        await self.report(robot, 2, b'{"phase":2,"job":7}')
        self.assertEqual(await first.recv(), rt.Ended(Docking(phase=Phase.CHARGING, job=7)))
        self.assertEqual(await second.recv(), rt.Ended(Docking(phase=Phase.CHARGING, job=8)))
        client.close()
        listener.close()

    @clocked
    async def test_a_connection_that_is_closed_ends_it_with_an_error(self) -> None:
        listener, client, robot = await self.meet()
        following = await self.begun(client, robot)
        waiting = asyncio.ensure_future(following.recv())
        await asyncio.sleep(0)
        client.close()
        with self.assertRaises(rt.FollowClosedError) as closed:
            await waiting
        self.assertEqual((closed.exception.name, closed.exception.loss.name), ("closed", "closed_here"))
        self.assertIsNone(await following.recv())
        listener.close()

    @clocked
    async def test_refused_or_cancelled_call_is_not_followed(self) -> None:
        listener, client, robot = await self.meet()
        calling = asyncio.ensure_future(_follow(client))
        (request,) = await robot.frames(1)
        robot.answer(request, b'{"resultCode":3001}')
        with self.assertRaises(rt.RefusedError) as refused:
            await calling
        self.assertEqual(refused.exception.declared(sample.DockError), sample.DockError.NO_DOCK)
        calling = asyncio.ensure_future(_follow(client))
        await robot.frames(1)
        calling.cancel()
        await asyncio.wait({calling})
        robot.send(DOCKING, b'{"phase":1}', 9, kind=3)
        robot.send(0x0100, b"{}", 10)
        # The reports after it have been refused, and so have those before it.
        await robot.frames(1)
        async with client.reports() as reports:
            await self.report(robot, 10, b'{"phase":0}')
            self.assertEqual(await reports.recv(), Docking(phase=Phase.IDLE))
        self.assertEqual(client.counters.reports_refused, 1)
        client.close()
        listener.close()

    @clocked
    async def test_which_report_to_follow_has_to_be_clear(self) -> None:
        listener, client, _ = await self.meet()
        other = replace(sample.operations.DOCKING, name="other")
        with self.assertRaises(ValueError):
            client.dock(DockRequest.example()).follow(other)
        client.close()
        listener.close()


async def _follow(client: sample.Client) -> rt.Following[Any, Docking]:
    return await client.dock(DockRequest.example(), timeout=60).follow()


if __name__ == "__main__":
    unittest.main()
