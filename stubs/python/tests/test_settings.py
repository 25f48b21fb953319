"""Wrong values of every setting and call option: each is refused where it is given."""

from __future__ import annotations

import asyncio
import math
import unittest
from dataclasses import fields, replace
from typing import Any

import fc_runtime as rt
import sample
from virtual import Raw, clocked, limits, serve

NO_NUMBERS: list[Any] = ["5", b"5", [5], True, None, 1j]
NO_DURATIONS: list[Any] = [math.nan, math.inf, -math.inf, -0.1, -1, 10**400]
NO_INTEGERS: list[Any] = [math.nan, 1.0, "1", True, None, -1]
NO_PORTS: list[Any] = [*NO_INTEGERS, 65_536, 99_999]
NO_FLAGS: list[Any] = [0, 1, "no", None]
NO_HOSTS: list[Any] = ["", " ", "\t", "a\0b", 5, b"127.0.0.1", ("127.0.0.1",)]

DURATIONS = {
    rt.Backoff: {"first", "longest"},
    rt.ClientConfig: {"connect_timeout", "call_timeout", "keepalive", "stall_timeout"},
    rt.ServerConfig: {
        "handler_timeout",
        "max_age",
        "header_timeout",
        "stall_timeout",
        "idle_timeout",
        "keepalive",
    },
    rt.AckPolicy: {"timeout"},
}
INTEGERS = {
    rt.Backoff: {"attempts"},
    rt.ClientConfig: {"queued_bytes", "first_id"},
    rt.ServerConfig: {
        "queued_bytes",
        "connections_per_address",
        "abandoned_handlers",
        "memory",
        "first_id",
        "least_rate",
    },
    rt.AckPolicy: {"retries"},
    rt.Gzip: {"from_bytes", "level"},
    rt.Limits: {one.name for one in fields(rt.Limits)},
}
OTHERS: dict[Any, dict[str, list[Any]]] = {
    rt.Backoff: {},
    rt.ClientConfig: {
        "host": NO_HOSTS,
        "command_port": [*NO_PORTS, 0],
        "data_port": [*NO_PORTS, 0],
        "reconnect": [5, "never", False],
        "limits": [{}, 5],
        "gzip": [True, 9],
        "verify_digest": NO_FLAGS,
        "resync": NO_FLAGS,
        "ssl": [True, "tls"],
        "on_call": [5, "log"],
    },
    rt.ServerConfig: {
        "address": [*NO_HOSTS, None],
        "command_port": NO_PORTS,
        "data_port": NO_PORTS,
        "limits": [{}, 5],
        "allow": [
            ["10.0.0.0/8"],
            {"10.0.0.1/8": [rt.Effect.READ]},
            {"": [rt.Effect.READ]},
            {5: [rt.Effect.READ]},
            {"10.0.0.0/8": "read"},
            {"10.0.0.0/8": ["read"]},
            {"10.0.0.0/8": rt.Effect.READ},
            {"10.0.0.0/8": None},
        ],
        "on_handler_error": [5, "log"],
        "on_call": [5, "log"],
        "gzip": [True, 9],
        "verify_digest": NO_FLAGS,
        "resync": NO_FLAGS,
        "ssl": [True, "tls"],
    },
    rt.AckPolicy: {},
    rt.Gzip: {},
    rt.Limits: {},
}
RIGHT: dict[Any, Any] = {
    rt.Backoff: rt.Backoff(),
    rt.ClientConfig: rt.ClientConfig(),
    rt.ServerConfig: rt.ServerConfig(),
    rt.AckPolicy: rt.AckPolicy(timeout=1.0, retries=1),
    rt.Gzip: rt.Gzip(),
    rt.Limits: sample.SAMPLE.defaults.limits,
}


class Settings(unittest.TestCase):
    def test_every_wrong_setting_is_refused_by_name(self) -> None:
        for kind, right in RIGHT.items():
            wrong = dict(OTHERS[kind])
            wrong |= {name: [*NO_NUMBERS, *NO_DURATIONS] for name in DURATIONS.get(kind, ())}
            wrong |= dict.fromkeys(INTEGERS.get(kind, ()), NO_INTEGERS)
            self.assertEqual(set(wrong), {one.name for one in fields(kind)})
            for name, values in wrong.items():
                for value in values:
                    if value is None and "None" in str(kind.__annotations__[name]):
                        replace(right, **{name: value})
                        continue
                    with (
                        self.subTest(setting=f"{kind.__name__}.{name}", value=value),
                        self.assertRaisesRegex((TypeError, ValueError), rf"`{kind.__name__}\.{name}\b"),
                    ):
                        replace(right, **{name: value})

    def test_right_settings_are_taken(self) -> None:
        for seconds in (0, 0.0, 0.001, 5, 1e9):
            rt.ClientConfig(connect_timeout=seconds, call_timeout=seconds, stall_timeout=seconds)
            rt.ServerConfig(max_age=seconds, handler_timeout=seconds, idle_timeout=seconds)
        rt.ServerConfig(max_age="spec", command_port=0, allow={"10.0.0.0/24": [rt.Effect.READ], "::1": set(rt.Effect)})
        rt.ClientConfig(host="::1", command_port=65_535, first_id=0, reconnect=None)
        with self.assertRaises(TypeError):
            rt.ServerConfig(max_age="any")  # type: ignore[arg-type]
        with self.assertRaises(ValueError):
            rt.Gzip(level=10)
        with self.assertRaises(ValueError):
            rt.Gzip(level=0)

    @clocked
    async def test_wrong_call_options_are_refused_and_nothing_is_sent(self) -> None:
        server = await serve(sample.ExampleRobot(pretend_motion=True))
        host, port = server.command_address
        async with sample.Client.connect(rt.ClientConfig(host=host, command_port=port)) as client:
            request = sample.DockRequest.example()
            for options in (
                *({"timeout": value} for value in (*NO_NUMBERS, *NO_DURATIONS) if value is not None),
                *({"repeat": value} for value in (0, 1, "no", "yes")),
            ):
                for call in (
                    client.get_battery(**options),
                    client.dock(request, **options),
                    client.dock(request, **options).follow(),
                    client.connection.call_raw(0x0100, **options),
                ):
                    expected = "`timeout` is|`repeat` is"
                    with self.subTest(options=options), self.assertRaisesRegex((TypeError, ValueError), expected):
                        await call
            self.assertEqual(client.connection.in_flight, 0)
            self.assertEqual(server.counters.bytes_in, 0)
            self.assertEqual((await client.get_battery(timeout=5, repeat=False)).level, 80)
        for grace in (*NO_NUMBERS, *NO_DURATIONS):
            with self.assertRaisesRegex((TypeError, ValueError), "grace"):
                await server.shutdown(grace)
        # It still serves.
        app = await Raw.connect(server.command_address)
        app.send(0x0100, b"{}")
        self.assertIsNotNone(await app.next())
        await server.shutdown(0)

    @clocked
    async def test_wrong_codes_and_ids_are_refused_unsent(self) -> None:
        server = await serve(sample.ExampleRobot())
        host, port = server.command_address
        config = rt.ClientConfig(host=host, command_port=port, data_port=server.data_address[1])
        async with sample.Client.connect(config) as client:
            data = client.data()
            await data.connected()
            for code in (-1, 1 << 16, "256", 1.0, None, True):
                for sending in (
                    client.connection.call_raw(code),  # type: ignore[arg-type]
                    data.send(code, 1, b""),  # type: ignore[arg-type]
                    server.send_data(code, 1, b""),  # type: ignore[arg-type]
                ):
                    with self.subTest(code=code), self.assertRaisesRegex((TypeError, ValueError), "`code`"):
                        await sending
            for number in (-1, 1 << 32, "1", 1.0, None, True):
                for sending in (data.send(1, number, b""), server.send_data(1, number, b"")):  # type: ignore[arg-type]
                    with self.subTest(id=number), self.assertRaisesRegex((TypeError, ValueError), "`message_id`"):
                        await sending
            for content in (None, "text", 5):
                for sending in (data.send(1, 1, content), server.send_data(1, 1, content)):  # type: ignore[arg-type]
                    with self.subTest(data=content), self.assertRaisesRegex(TypeError, "`data`"):
                        await sending
            self.assertEqual(client.connection.in_flight, 0)
            # Neither side is harmed.
            self.assertEqual(await server.send_data(1, 2, b"after"), 1)
            self.assertEqual((await asyncio.wait_for(data.recv(), 5)).data, b"after")
        await server.shutdown(0)

    @clocked
    async def test_wrong_limits_of_a_protocol_are_refused(self) -> None:
        with self.assertRaisesRegex(ValueError, r"`Limits\.in_flight` is 0, expected an integer from 1"):
            limits(in_flight=0)


if __name__ == "__main__":
    unittest.main()
