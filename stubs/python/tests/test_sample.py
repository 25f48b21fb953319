"""A generated package over TCP: calls, reports, following, refusals, with and without `async`."""

from __future__ import annotations

import asyncio
import unittest
from typing import Any

import fc_runtime as rt
import sample
from sample import Docking, DockRequest, DockResponse, GetBatteryResponse, Phase, sync
from support import AsyncCase

PATIENCE = 20.0


class Docks(sample.PartialRobot):
    """A robot that docks, and numbers each movement."""

    def __init__(self) -> None:
        self.jobs = 4
        self.phase: Phase | rt.Unknown[int] = Phase.IDLE

    async def dock(self, context: rt.Context, request: DockRequest) -> DockResponse:
        if not sample.operations.DOCK.accepted_in(self.phase):
            raise sample.DockError.NO_DOCK.refusal()
        self.jobs += 1
        return DockResponse(job=self.jobs)


class Sample(AsyncCase):
    async def serve(self, robot: rt.Robot) -> rt.Server:
        server = rt.Server(robot, rt.ServerConfig(address="127.0.0.1", command_port=0, data_port=0))
        await server.bind()
        self.address = server.command_address
        return server

    @property
    def config(self) -> rt.ClientConfig:
        host, port = self.address
        return rt.ClientConfig(host=host, command_port=port, call_timeout=PATIENCE)

    async def test_commands_are_answered_with_examples(self) -> None:
        server = await self.serve(sample.ExampleRobot(pretend_motion=True))
        async with sample.Client.connect(self.config) as client:
            self.assertEqual(await client.get_battery(), GetBatteryResponse.example())
            self.assertEqual((await client.dock(DockRequest.example())).job, 7)
            self.assertNotIn("owner", repr(GetBatteryResponse(level=1, phase=Phase.IDLE, owner="me")))
        await server.shutdown(0)

    async def test_omitted_command_is_refused_declared_error_has_name(self) -> None:
        robot = Docks()
        robot.phase = Phase.DRIVING
        server = await self.serve(robot)
        async with sample.Client.connect(self.config) as client:
            with self.assertRaises(rt.RefusedError) as left_out:
                await client.get_battery()
            self.assertIn("not implemented", left_out.exception.refusal.text)
            self.assertIsNone(left_out.exception.declared(sample.DockError))
            with self.assertRaises(rt.CallError) as declared:
                await client.dock(DockRequest.example())
            self.assertEqual(declared.exception.declared(sample.DockError), sample.DockError.NO_DOCK)
        await server.shutdown(0)
        with self.assertRaises(TypeError):
            sample.Robot()  # type: ignore[abstract]

    async def test_a_movement_is_followed_to_its_end_and_no_other(self) -> None:
        server = await self.serve(Docks())
        reporter = sample.Reporter(server)
        async with sample.Client.connect(self.config) as client, client.reports() as reports:
            first = await client.dock(DockRequest.example()).follow()
            second = await client.dock(DockRequest.example()).follow()
            self.assertEqual((first.answer.job, second.answer.job), (5, 6))
            told = [
                Docking(phase=Phase.DRIVING, job=5),
                Docking(phase=Phase.IDLE, job=6),
                # It skips a state.
                Docking(phase=Phase.CHARGING, job=6),
                Docking(phase=Phase.FAILED, job=5, cause="lost"),
            ]
            for report in told:
                (acknowledged,) = await reporter.docking(report)
                self.assertEqual(acknowledged.outcome, rt.Outcome.ACKNOWLEDGED)
            self.assertEqual([event async for event in first], [rt.Going(told[0]), rt.Failed(told[3])])
            self.assertEqual([event async for event in second], [rt.Going(told[1]), rt.Ended(told[2])])
            self.assertEqual(client.counters.reports_out_of_order, 1)
            self.assertEqual([await reports.recv() for _ in told], told)
        await server.shutdown(0)

    async def test_the_client_without_async_does_the_same(self) -> None:
        server = await self.serve(Docks())
        reporter = sample.Reporter(server)
        begun = asyncio.Event()
        loop = asyncio.get_running_loop()
        told = [Docking(phase=Phase.DRIVING, job=5), Docking(phase=Phase.CHARGING, job=5)]

        def app() -> None:
            with sync.Client.connect(self.config) as client, client.reports() as reports:
                self.assertEqual(client.state, rt.Connected(1))
                with client.follow_dock(DockRequest.example()) as following:
                    loop.call_soon_threadsafe(begun.set)
                    self.assertEqual(list(following), [rt.Going(told[0]), rt.Ended(told[1])])
                self.assertEqual([reports.recv(PATIENCE), reports.recv(PATIENCE)], told)
                with self.assertRaises(TimeoutError):
                    reports.recv(0)
                with self.assertRaises(rt.RefusedError):
                    client.get_battery()

        running = asyncio.ensure_future(asyncio.to_thread(app))
        await asyncio.wait_for(begun.wait(), PATIENCE)
        for report in told:
            await reporter.docking(report)
        await running
        await server.shutdown(0)

    def test_misspelt_handlers_are_errors_and_helpers_are_not(self) -> None:
        async def handler(self: Any, context: rt.Context, request: Any) -> None: ...

        async def helper(self: Any) -> None: ...

        def robot(**methods: Any) -> None:
            type("Misspelt", (sample.PartialRobot,), methods)

        for name, right in (
            ("get_batery", "get_battery"),
            ("getBattery", "get_battery"),
            ("docks", "dock"),
            ("pass_throgh", "pass_through"),
            ("unknwon", "unknown"),
        ):
            with self.subTest(name), self.assertRaisesRegex(TypeError, f"no handler `{right}`, and `{name}` is none"):
                robot(**{name: handler})
        robot(get_batery=helper, _get_batery=handler, charge=handler)
        robot(dock=handler, docks=handler)

    def test_error_states_the_expectation_not_the_value(self) -> None:
        for text in ('{"level":1234,"phase":0}', '{"level":123.4,"phase":0}', '{"level":"1234","phase":0}'):
            with self.assertRaises(rt.BodyError) as caught:
                GetBatteryResponse.from_json(text)
            self.assertNotIn("1234", str(caught.exception))
            self.assertTrue(str(caught.exception).startswith("`level`: "), caught.exception)

    def test_a_condition_that_does_not_hold_is_told(self) -> None:
        with self.assertRaises(rt.ConditionError) as missing:
            Docking(phase=Phase.FAILED).checked()
        self.assertEqual(missing.exception.kind, rt.ConditionErrorKind.MISSING)
        with self.assertRaises(rt.ConditionError) as unasked:
            Docking(phase=Phase.IDLE, cause="").checked()
        self.assertEqual(unasked.exception.kind, rt.ConditionErrorKind.UNASKED)


if __name__ == "__main__":
    unittest.main()
