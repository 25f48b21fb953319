"""Handlers that fail, and responses of the wrong type."""

from __future__ import annotations

import asyncio
import functools
import inspect
import json
import logging
import os
import subprocess
import sys
import sysconfig
import unittest
from typing import TYPE_CHECKING, Any

import fc_runtime as rt
import sample
from virtual import Raw, clocked, serve, until

if TYPE_CHECKING:
    from collections.abc import Callable

GET, DOCK, PASSED = 0x0100, 0x0200, 0x0555
HERE = __file__


class Failing(sample.PartialRobot):
    """A robot whose handler comes from the test."""

    def __init__(self, handler: Callable[..., Any]) -> None:
        self.handler = handler

    def handlers_by_code(self) -> dict[int, Any]:
        return {GET: self.handler, DOCK: self.handler}

    def pass_through(self, context: rt.Context, request: rt.RawRequest) -> Any:
        return self.handler(context, request)


def line_of(function: Callable[..., Any], text: str) -> int:
    """Returns the number of a line in this file."""
    lines, first = inspect.getsourcelines(function)
    return first + next(index for index, line in enumerate(lines) if text in line)


async def fails_itself(context: rt.Context, request: Any) -> Any:
    raise LookupError("secret")


async def fails_in_a_helper(context: rt.Context, request: Any) -> Any:
    return helper()


def helper() -> Any:
    return [][0]  # "secret"


async def fails_in_the_library(context: rt.Context, request: Any) -> Any:
    return json.loads('{"secret')


async def fails_in_the_runtime(context: rt.Context, request: Any) -> Any:
    return sample.GetBatteryResponse.from_json('{"secret')


LIBRARY: dict[str, Any] = {}
exec(compile("def divide(): return 1 / 0", sysconfig.get_paths()["purelib"] + "/secret.py", "exec"), LIBRARY)


async def fails_in_a_package(context: rt.Context, request: Any) -> Any:
    return LIBRARY["divide"]()


def fails_before_it_is_awaited(context: rt.Context, request: Any) -> Any:
    raise OSError("secret")


def cannot_be_awaited(context: rt.Context, request: Any) -> Any:
    return sample.GetBatteryResponse.example()


def takes_too_little() -> Any:
    raise AssertionError


class Bad(BaseException):
    pass


async def fails_badly(context: rt.Context, request: Any) -> Any:
    raise Bad("secret")


FAILURES: list[tuple[Callable[..., Any], str, Callable[..., Any], str]] = [
    (fails_itself, "LookupError", fails_itself, "raise"),
    (fails_in_a_helper, "IndexError", helper, "return"),
    (fails_in_the_library, "JSONDecodeError", fails_in_the_library, "return"),
    (fails_in_the_runtime, "BodyError (bad_json)", fails_in_the_runtime, "return"),
    (fails_in_a_package, "ZeroDivisionError", fails_in_a_package, "return"),
    (fails_before_it_is_awaited, "OSError", fails_before_it_is_awaited, "raise"),
    (cannot_be_awaited, "TypeError", cannot_be_awaited, "def"),
    (functools.partial(cannot_be_awaited), "TypeError", cannot_be_awaited, "def"),
    (takes_too_little, "TypeError", takes_too_little, "def"),
    (fails_badly, "Bad", fails_badly, "raise"),
]


class Handlers(unittest.TestCase):
    async def failed(
        self, handler: Callable[..., Any], body: bytes = b"{}", code: int = GET
    ) -> tuple[bytes, list[logging.LogRecord], list[tuple[BaseException, rt.Context]], rt.ServerCounters]:
        """Returns the response to a call, and the errors that the robot's programmer gets."""
        errors: list[tuple[BaseException, rt.Context]] = []
        server = await serve(Failing(handler), on_handler_error=lambda *of: errors.append(of))
        app = await Raw.connect(server.command_address)
        with self.assertLogs("fc_runtime", "ERROR") as log:
            app.send(code, body, 7)
            answer = await app.next()
        assert answer is not None
        app.send(0x0999, b"{}")
        self.assertIsNotNone(await app.next(), "the connection lives")
        await server.shutdown(0)
        return answer.data, log.records, errors, server.counters

    @clocked
    async def test_error_class_and_line_are_logged_and_hooked(self) -> None:
        for handler, name, place, text in FAILURES:
            with self.subTest(handler=handler):
                answer, lines, errors, counters = await self.failed(handler)
                self.assertIn(b"2001", answer)
                self.assertIn(b"the handler panicked", answer)
                self.assertEqual(counters.handlers_panicked, 1)
                expected = f"the handler of get_battery failed: {name} at {HERE}:{line_of(place, text)} in "
                (line,) = [one.getMessage() for one in lines]
                self.assertIn(expected, line)
                self.assertNotIn("secret", line)
                ((error, context),) = errors
                self.assertEqual(type(error).__name__, name.partition(" ")[0])
                self.assertEqual((context.code, context.id), (GET, 7))

    @clocked
    async def test_errors_of_the_hook_harm_nothing(self) -> None:
        def hook(error: BaseException, context: rt.Context) -> None:
            raise KeyError("secret")

        server = await serve(Failing(fails_itself), on_handler_error=hook)
        app = await Raw.connect(server.command_address)
        with self.assertLogs("fc_runtime", "ERROR") as log:
            app.send(GET, b"{}")
            answer = await app.next()
        assert answer is not None
        self.assertIn(b"2001", answer.data)
        self.assertIn(f"`on_handler_error` failed: KeyError at {HERE}:{line_of(hook, 'raise')}", log.output[1])
        self.assertNotIn("secret", str(log.output))
        await server.shutdown(0)

    @clocked
    async def test_many_failures_are_few_lines_and_all_reach_the_hook(self) -> None:
        errors: list[BaseException] = []
        server = await serve(Failing(fails_itself), on_handler_error=lambda error, _: errors.append(error))
        app = await Raw.connect(server.command_address)
        with self.assertLogs("fc_runtime", "ERROR") as log:
            for number in range(50):
                app.send(GET, b"{}", number)
            await app.frames(50)
            # Another command has a separate limit of lines.
            app.send(DOCK, b'{"dock":"A"}')
            await app.next()
        self.assertEqual((len(log.output), len(errors)), (6, 51))
        await server.shutdown(0)

    @clocked
    async def test_failures_after_the_timeout_are_told_too(self) -> None:
        async def fails_late(context: rt.Context, request: Any) -> Any:
            try:
                await context.abandoned()
                await asyncio.sleep(1)
            finally:
                raise LookupError

        async def refuses_late(context: rt.Context, request: Any) -> Any:
            await context.abandoned()
            raise rt.Refusal(3001, "not now")

        for handler, count in ((fails_late, 2), (refuses_late, 0)):
            errors: list[BaseException] = []
            server = await serve(
                Failing(handler), handler_timeout=1, on_handler_error=lambda error, _, to=errors: to.append(error)
            )
            app = await Raw.connect(server.command_address)
            with self.assertLogs("fc_runtime", "ERROR") if count else self.assertNoLogs("fc_runtime", "WARNING") as log:
                app.send(GET, b"{}", 1)
                app.send(DOCK, b'{"dock":"A"}', 2)
                for answer in await app.frames(2):
                    self.assertIn(b"2002", answer.data)
                await asyncio.sleep(5)
            self.assertEqual((len(errors), server.counters.handlers_panicked), (count, count))
            if log is not None:
                self.assertEqual(str(log.output).count("failed: LookupError at"), count)
            await server.shutdown(0)

    @clocked
    async def test_wrong_responses_are_not_sent(self) -> None:
        wrong: list[tuple[int, Any, str]] = [
            (GET, None, "wrong_type"),
            (GET, sample.DockResponse(), "wrong_type"),
            (GET, {"level": 1}, "wrong_type"),
            (GET, rt.Json('{"level":1}'), "wrong_type"),
            (GET, sample.GetBatteryResponse, "wrong_type"),
            (GET, sample.GetBatteryResponse(level=101, phase=sample.Phase.IDLE), "out_of_range"),
            (DOCK, None, "wrong_type"),
            (DOCK, sample.DockRequest.example(), "wrong_type"),
            (PASSED, None, "wrong_type"),
            (PASSED, {"a": 1}, "wrong_type"),
            (PASSED, sample.DockResponse(), "wrong_type"),
            (PASSED, rt.Json("[1]"), "not_an_object"),
            (PASSED, rt.Json("null"), "not_an_object"),
        ]
        for code, response, name in wrong:

            async def answers(context: rt.Context, request: Any, response: Any = response) -> Any:
                return response

            with self.subTest(code=code, response=response):
                answer, lines, errors, counters = await self.failed(answers, b'{"dock":"A"}', code)
                self.assertIn(b"2001", answer)
                self.assertEqual((counters.calls_succeeded, counters.handlers_panicked), (0, 0))
                (line,) = [one.getMessage() for one in lines]
                self.assertIn(f"breaks the spec: BodyError ({name}", line)
                place = Failing.pass_through if code == PASSED else answers
                self.assertIn(f") at {HERE}:{line_of(place, 'def')} in ", line)
                ((error, _),) = errors
                assert isinstance(error, rt.BodyError)
                self.assertEqual(error.name, name)

    @clocked
    async def test_wrong_requests_are_not_sent(self) -> None:
        server = await serve(sample.ExampleRobot(pretend_motion=True))
        host, port = server.command_address
        async with sample.Client.connect(rt.ClientConfig(host=host, command_port=port)) as client:
            wrong: list[tuple[Callable[[Any], Any], Any, str]] = [
                (client.get_battery, sample.DockRequest.example(), "wrong_type"),
                (client.get_battery, {}, "wrong_type"),
                (client.get_battery, sample.GetBatteryRequest, "wrong_type"),
                (client.dock, sample.GetBatteryRequest(), "wrong_type"),
                (client.dock, "A", "wrong_type"),
                (client.dock, None, "missing_field"),
                (lambda of: client.dock(of).follow(), sample.DockResponse(), "wrong_type"),
                (lambda body: client.connection.call_raw(GET, body), {"a": 1}, "wrong_type"),
                (lambda body: client.connection.call_raw(GET, body), rt.Json("[]"), "not_an_object"),
            ]
            for call, request, name in wrong:
                with self.subTest(request=request), self.assertRaises(rt.InvalidRequestError) as refused:
                    await call(request)
                self.assertEqual((refused.exception.name, refused.exception.error.name), ("invalid_request", name))
            self.assertEqual(client.connection.in_flight, 0)
        self.assertEqual(server.counters.bytes_in, 0)
        await server.shutdown(0)

    @clocked
    async def test_wrong_reports_and_streams_are_not_sent(self) -> None:
        server = await serve(sample.ExampleRobot())
        host, port = server.command_address
        config = rt.ClientConfig(host=host, command_port=port, data_port=server.data_address[1])
        async with sample.Client.connect(config) as client, client.reports() as reports:
            data = client.data()
            await data.connected()
            await until(lambda: server.counters.data_connections == 1)
            reporter, streamer = sample.Reporter(server), sample.Streamer(server)
            wrong: list[Any] = [None, sample.DockResponse(), {}, "text", rt.Json("{}")]
            for content in wrong:
                for sending in (reporter.docking(content), streamer.send_scan(1, content)):
                    with self.subTest(content=content), self.assertRaises(rt.InvalidReportError) as refused:
                        await sending
                    self.assertEqual(refused.exception.error.name, "wrong_type")
                with self.subTest(content=content), self.assertRaises(rt.DataInvalidError) as invalid:
                    await sample.Streams(data).send_firmware(1, content)
                self.assertEqual(invalid.exception.error.name, "wrong_type")
            self.assertEqual((server.counters.bytes_in, server.counters.bytes_out), (0, 0))
            pushing = asyncio.ensure_future(reporter.docking(sample.Docking(phase=sample.Phase.IDLE)))
            self.assertIsInstance(await reports.recv(), sample.Docking)
            await pushing
        await server.shutdown(0)

    @clocked
    async def test_extra_that_is_none_is_not_sent(self) -> None:
        response = sample.DockResponse(extra={"note": 1})  # type: ignore[arg-type]
        with self.assertRaises(rt.BodyError) as refused:
            response.to_json()
        self.assertEqual((refused.exception.name, refused.exception.path), ("wrong_type", ""))

    def test_errors_are_printed_without_logging_settings(self) -> None:
        program = """
import asyncio, sys
import fc_runtime as rt
import sample

class Robot(sample.PartialRobot):
    async def get_battery(self, context, request):
        raise LookupError("secret")

async def main():
    async with rt.Server(Robot(), rt.ServerConfig(address="127.0.0.1", command_port=0, data_port=0)) as server:
        host, port = server.command_address
        async with sample.Client.connect(rt.ClientConfig(host=host, command_port=port)) as client:
            try:
                await client.get_battery()
            except rt.RefusedError:
                pass

asyncio.run(main())
"""
        # The modules of these tests, found in any folder.
        environment = os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)}
        command = [sys.executable, "-c", program]
        done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=60, check=True)
        self.assertIn("the handler of get_battery failed: LookupError at <string>:8 in get_battery", done.stderr)
        self.assertNotIn("secret", done.stderr)


if __name__ == "__main__":
    unittest.main()
