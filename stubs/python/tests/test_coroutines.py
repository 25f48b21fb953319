"""All results to await are coroutines: calls to follow, following, connecting."""

from __future__ import annotations

import asyncio
import collections.abc
import gc
import sys
import threading
import unittest
import warnings
from typing import TYPE_CHECKING, Any

import fc_runtime as rt
import sample
from sample import sync
from virtual import clocked, serve, until

if TYPE_CHECKING:
    from collections.abc import Callable, Coroutine

    Make = Callable[[], Coroutine[Any, Any, Any]]


async def group(work: Coroutine[Any, Any, Any]) -> Any:
    async with asyncio.TaskGroup() as tasks:  # type: ignore[attr-defined, unused-ignore]
        task = tasks.create_task(work)
    return task.result()


async def elsewhere(work: Coroutine[Any, Any, Any]) -> Any:
    """Awaits work as another thread does."""
    return await asyncio.wrap_future(asyncio.run_coroutine_threadsafe(work, asyncio.get_running_loop()))


WAYS: list[Callable[[Coroutine[Any, Any, Any]], Any]] = [
    asyncio.create_task,
    asyncio.ensure_future,
    asyncio.gather,
    asyncio.shield,
    lambda work: asyncio.wait_for(work, 5),
    lambda work: asyncio.get_running_loop().create_task(work),
    elsewhere,
    lambda work: work,
]
if sys.version_info >= (3, 11):
    WAYS.append(group)


class Coroutines(unittest.TestCase):
    async def makes(self, robot: rt.Robot) -> tuple[rt.Server, sample.Client, dict[str, Make]]:
        server = await serve(robot)
        host, port = server.command_address
        config = rt.ClientConfig(host=host, command_port=port)
        client = await sample.Client.connect(config)
        request = sample.DockRequest.example()
        makes: dict[str, Make] = {
            "get_battery": client.get_battery,
            "dock": lambda: client.dock(request),
            "follow": lambda: client.dock(request).follow(),
            "connect": lambda: sample.Client.connect(config),
        }
        return server, client, makes

    @clocked
    async def test_each_works_in_every_way_of_waiting(self) -> None:
        server, client, makes = await self.makes(sample.ExampleRobot(pretend_motion=True))
        for name, make in makes.items():
            for way in WAYS:
                with self.subTest(name, way=way):
                    work = make()
                    self.assertTrue(asyncio.iscoroutine(work))
                    self.assertIsInstance(work, collections.abc.Coroutine)
                    answer = await way(work)
                    (answer,) = answer if isinstance(answer, list) else (answer,)
                    if isinstance(answer, (rt.Following, sample.Client)):
                        answer.close()
        client.close()
        await server.shutdown(0)

    @clocked
    async def test_each_is_awaited_once(self) -> None:
        server, client, makes = await self.makes(sample.ExampleRobot(pretend_motion=True))
        for name, make in makes.items():
            work = make()
            before = server.counters.calls_succeeded
            found = await work
            with self.subTest(name), self.assertRaises(RuntimeError):
                await work
            self.assertEqual(server.counters.calls_succeeded, before + (name != "connect"))
            if isinstance(found, (rt.Following, sample.Client)):
                found.close()
        call = client.dock(sample.DockRequest.example())
        await call
        with self.assertRaises(RuntimeError):
            call.follow()
        client.close()
        await server.shutdown(0)

    @clocked
    async def test_each_that_is_forgotten_warns_and_sends_nothing(self) -> None:
        server, client, makes = await self.makes(sample.ExampleRobot(pretend_motion=True))
        received, connections = server.counters.bytes_in, server.counters.connections
        for name, make in makes.items():
            with self.subTest(name), self.assertWarnsRegex(RuntimeWarning, "was never awaited"):
                make()  # type: ignore[unused-coroutine]
                gc.collect()
            with self.subTest(name), warnings.catch_warnings():
                warnings.simplefilter("error")
                make().close()
                gc.collect()
        await asyncio.sleep(1)
        self.assertEqual((server.counters.bytes_in, server.counters.connections), (received, connections))
        self.assertEqual(client.connection.in_flight, 0)
        client.close()
        await server.shutdown(0)

    @clocked
    async def test_each_can_be_cancelled(self) -> None:
        class Hangs(sample.PartialRobot):
            begun = 0

            async def get_battery(self, context: rt.Context, request: Any) -> Any:
                self.begun += 1
                await asyncio.Event().wait()

            async def dock(self, context: rt.Context, request: Any) -> Any:
                self.begun += 1
                await asyncio.Event().wait()

        robot = Hangs()
        server, client, makes = await self.makes(robot)
        for name in ("get_battery", "dock", "follow"):
            begun = robot.begun
            task = asyncio.create_task(makes[name]())
            self.assertIn("pending", repr(task))
            await until(lambda begun=begun: robot.begun > begun)  # type: ignore[misc]
            task.cancel()
            with self.subTest(name), self.assertRaises(asyncio.CancelledError):
                await task
            self.assertEqual(client.connection.in_flight, 0)
        client.close()
        await server.shutdown(0)

    def test_the_client_without_async_waits_for_them(self) -> None:
        ready, over = threading.Event(), threading.Event()
        addresses: list[tuple[str, int]] = []

        async def robot() -> None:
            server = await serve(sample.ExampleRobot(pretend_motion=True))
            addresses.append(server.command_address)
            ready.set()
            await asyncio.to_thread(over.wait)
            await server.shutdown(0)

        thread = threading.Thread(target=lambda: asyncio.run(robot()))
        thread.start()
        self.assertTrue(ready.wait(20))
        ((host, port),) = addresses
        with sync.Client(rt.ClientConfig(host=host, command_port=port)) as client:
            calls = sample.Client(client.connection)
            self.assertEqual(client.wait(calls.dock(sample.DockRequest.example())), sample.DockResponse(job=7))
        over.set()
        thread.join()


if __name__ == "__main__":
    unittest.main()
