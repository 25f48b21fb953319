"""The client without `async`: from many threads, after its end, and with Ctrl-C."""

from __future__ import annotations

import asyncio
import signal
import threading
import unittest
from concurrent.futures import ThreadPoolExecutor

import fc_runtime as rt
import sample
from sample import DockRequest, GetBatteryRequest, GetBatteryResponse, sync
from virtual import serve

PATIENCE = 20.0


class Robot(sample.PartialRobot):
    """A robot that responds, except to docking, which never ends."""

    async def get_battery(self, context: rt.Context, request: GetBatteryRequest) -> GetBatteryResponse:
        return GetBatteryResponse(level=1, phase=sample.Phase.IDLE, extra=request.extra)

    async def dock(self, context: rt.Context, request: DockRequest) -> sample.DockResponse:
        docking.set()
        await asyncio.Event().wait()
        raise AssertionError


docking = threading.Event()


class Pressed(BaseException):
    """Like `KeyboardInterrupt`, but only for this test."""


class Blocking(unittest.TestCase):
    def setUp(self) -> None:
        docking.clear()
        self.ready = threading.Event()
        self.thread = threading.Thread(target=lambda: asyncio.run(self.serve()))
        self.thread.start()
        self.assertTrue(self.ready.wait(PATIENCE))

    async def serve(self) -> None:
        self.loop, self.over = asyncio.get_running_loop(), asyncio.Event()
        server = await serve(Robot(), handler_timeout=1000)
        host, port = server.command_address
        self.config = rt.ClientConfig(host=host, command_port=port, call_timeout=PATIENCE)
        self.ready.set()
        await self.over.wait()
        await server.shutdown(0)

    def tearDown(self) -> None:
        self.loop.call_soon_threadsafe(self.over.set)
        self.thread.join()

    def test_many_threads_share_a_client(self) -> None:
        with sync.Client(self.config) as client, ThreadPoolExecutor(8) as pool:

            def ask(number: int) -> object:
                return client.get_battery(GetBatteryRequest(extra=rt.Extra({"n": number}))).extra["n"]

            self.assertEqual(list(pool.map(ask, range(200))), list(range(200)))

    def test_closed_client_sends_nothing_and_ends_waits(self) -> None:
        client = sync.Client(self.config)
        with ThreadPoolExecutor(3) as pool:
            calling = pool.submit(client.dock, DockRequest.example())
            reports = client.reports()
            receiving = pool.submit(reports.recv)
            with self.assertRaises(TimeoutError):
                client.closed(0)
            ending = pool.submit(client.closed, PATIENCE)
            self.assertTrue(docking.wait(PATIENCE))
            client.close()
            self.assertIsInstance(calling.exception(PATIENCE), rt.LostError)
            self.assertIsNone(receiving.result(PATIENCE))
            self.assertEqual(ending.result(PATIENCE).kind, rt.LossKind.HERE)
        with self.assertRaises(rt.ClosedError):
            client.get_battery()
        client.close()
        self.assertIsInstance(client.state, rt.Closed)

    def test_missing_robot_is_an_error_and_leaves_no_thread(self) -> None:
        before = threading.active_count()
        with self.assertRaises(rt.ConnectError):
            sync.Client.connect(rt.ClientConfig(host="127.0.0.1", command_port=1))
        self.assertEqual(threading.active_count(), before)

    def test_its_own_thread_must_not_wait_for_itself(self) -> None:
        with sync.Client(self.config) as client:

            async def wrong() -> None:
                client.get_battery()

            with self.assertRaises(RuntimeError):
                client.wait(wrong())

    @unittest.skipUnless(hasattr(signal, "setitimer"), "there are no timers of signals here")
    def test_to_interrupt_a_call_cancels_it(self) -> None:
        def press(*_: object) -> None:
            if docking.is_set():
                signal.setitimer(signal.ITIMER_REAL, 0)
                raise Pressed

        before = signal.signal(signal.SIGALRM, press)
        self.addCleanup(signal.signal, signal.SIGALRM, before)
        with sync.Client(self.config) as client:
            signal.setitimer(signal.ITIMER_REAL, 0.02, 0.02)
            with self.assertRaises(Pressed):
                client.dock(DockRequest.example())

            async def in_flight() -> int:
                await asyncio.sleep(0)
                return client.connection.in_flight

            self.assertEqual(client.wait(in_flight()), 0)
            self.assertEqual(client.get_battery().level, 1)


if __name__ == "__main__":
    unittest.main()
