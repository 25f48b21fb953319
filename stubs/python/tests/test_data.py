"""The data port over TCP: streams both ways, slow apps, losses, and the owner of a data connection."""

from __future__ import annotations

import asyncio
import unittest
from typing import Any

import fc_runtime as rt
import sample
from sample import Scan, operations
from support import AsyncCase

PATIENCE = 20.0


class Data(AsyncCase):
    async def serve(self, command_port: int = 0, data_port: int = 0, **config: Any) -> rt.Server:
        settings = rt.ServerConfig(address="127.0.0.1", command_port=command_port, data_port=data_port, **config)
        server = rt.Server(sample.ExampleRobot(), settings)
        await server.bind()
        self.ports = server.command_address[1], server.data_address[1]
        return server

    async def client(self, **config: Any) -> sample.Client:
        command_port, data_port = self.ports
        settings: dict[str, Any] = {"host": "127.0.0.1", "call_timeout": PATIENCE, **config}
        client = await sample.Client.connect(
            rt.ClientConfig(command_port=command_port, data_port=data_port, **settings)
        )
        self.addCleanup(client.close)
        return client

    async def test_streams_go_both_ways_as_their_types(self) -> None:
        server = await self.serve()
        from_apps = server.streams()
        client = await self.client()
        streams = sample.Streams(client.data())
        scans = streams.subscribe_scan()
        await streams.send_firmware(5, b"\x1f\x8b")
        firmware = await from_apps.recv()
        assert firmware is not None
        self.assertEqual((firmware.code, firmware.id, firmware.data), (0x0401, 5, b"\x1f\x8b"))
        streamer = sample.Streamer(server)
        self.assertEqual(await streamer.send_scan(9, Scan(metres=[2.5]), firmware.connection), 1)
        self.assertEqual(await scans.recv(), rt.StreamItem(9, Scan(metres=[2.5])))
        (app, _) = server.connections[0]
        self.assertEqual(await streamer.send_scan(10, Scan(metres=[1.0]), app), 1)
        self.assertEqual((await scans.recv()).id, 10)
        with self.assertRaises(rt.InvalidReportError):
            await streamer.send_scan(11, Scan(metres=[]), app)
        await server.send_data(0x0400, 12, b"no JSON", app)
        with self.assertRaises(rt.DataInvalidError) as invalid:
            await scans.recv()
        self.assertEqual(invalid.exception.name, "bad_json")
        self.assertEqual(server.counters.stream_frames_out, 3)
        await server.shutdown(0)

    async def test_slow_subscriber_misses_the_oldest_alone(self) -> None:
        server = await self.serve()
        client = await self.client()
        data = client.data()
        await data.connected()
        slow, other = data.subscribe(operations.SCAN), data.subscribe(operations.SCAN)
        for number in range(6):
            await server.send_stream(operations.SCAN, number, Scan(metres=[1.0]))
            self.assertEqual((await other.recv()).id, number)
        await server.send_data(0x0500, 1, b"a")
        await server.send_data(0x0500, 2, b"b")
        await server.send_stream(operations.SCAN, 6, Scan(metres=[1.0]))
        self.assertEqual((await other.recv()).id, 6)
        self.assertEqual([(await slow.recv()).id for _ in range(4)], [3, 4, 5, 6])
        self.assertEqual((slow.missed, other.missed, data.missed), (3, 0, 1))
        self.assertEqual((await data.recv()).id, 1)
        await server.shutdown(0)

    async def test_loss_is_told_once_and_next_connection_continues(self) -> None:
        server = await self.serve()
        client = await self.client(reconnect=rt.Backoff(first=0.01, longest=0.01))
        data = client.data()
        await data.connected()
        await data.send(0x0401, 1, b"x")
        ports = self.ports
        await server.shutdown(0)
        with self.assertRaises(rt.DataLostError):
            await data.recv()
        server = await self.serve(*ports)
        with self.assertRaises(rt.DataLostError) as lost:
            await data.send(0x0401, 2, b"y")
        self.assertEqual(lost.exception.name, "lost")
        from_apps = server.streams()
        await data.send(0x0401, 3, b"z")
        frame = await asyncio.wait_for(from_apps.recv(), PATIENCE)
        assert frame is not None
        self.assertEqual(frame.id, 3)
        # It may be made once more, with the command connection: that loss is reported like any other.
        receiving = asyncio.ensure_future(_received(data))
        while not receiving.done():
            await server.send_data(0x0500, 4, b"back")
            await asyncio.wait({receiving}, timeout=0.01)
        received = await receiving
        self.assertEqual(received.data, b"back")
        client.close()
        with self.assertRaises(rt.DataClosedError):
            await data.recv()
        with self.assertRaises(rt.DataClosedError):
            await data.send(0x0401, 5, b"")
        await server.shutdown(0)

    async def test_without_a_robot_nothing_is_sent(self) -> None:
        server = await self.serve()
        ports = self.ports
        await server.shutdown(0)
        self.ports = ports
        client = sample.Client.connect_lazy(
            rt.ClientConfig(host="127.0.0.1", command_port=ports[0], data_port=ports[1], call_timeout=0.05)
        )
        with self.assertRaises(rt.DataNotConnectedError):
            await client.data().send(0x0401, 1, b"x")
        client.close()

    async def test_an_app_that_does_not_take_is_not_read(self) -> None:
        server = await self.serve()
        client = await self.client()
        data = client.data()
        await data.connected()
        sending = asyncio.ensure_future(_send_all(server, 64))
        while server.counters.stream_frames_out < 4:
            await asyncio.sleep(0)
        for _ in range(1000):
            await asyncio.sleep(0)
        self.assertLess(server.counters.stream_frames_out, 64)
        self.assertFalse(sending.done(), "it waits for room")
        for number in range(64):
            self.assertEqual((await asyncio.wait_for(data.recv(), PATIENCE)).id, number)
        await sending
        self.assertEqual(data.missed, 0)
        await server.shutdown(0)

    async def test_a_busy_robot_does_not_read_on(self) -> None:
        server = await self.serve()
        from_apps = server.streams()
        client = await self.client()
        data = client.data()
        await data.connected()

        async def send_all() -> None:
            for number in range(64):
                await data.send(0x0401, number, bytes(256 * 1024))

        sending = asyncio.ensure_future(send_all())
        while server.counters.stream_frames_in < 4:
            await asyncio.sleep(0)
        for _ in range(1000):
            await asyncio.sleep(0)
        self.assertEqual(server.counters.stream_frames_in, 4)
        for number in range(64):
            frame = await asyncio.wait_for(from_apps.recv(), PATIENCE)
            assert frame is not None
            self.assertEqual((frame.id, len(frame.data)), (number, 256 * 1024))
        await sending
        # Another receiver takes over. Without one, frames are dropped.
        later = server.streams()
        self.assertIsNone(await from_apps.recv())
        await data.send(0x0401, 64, b"")
        frame = await later.recv()
        assert frame is not None
        self.assertEqual((frame.id, server.counters.stream_frames_dropped), (64, 0))
        await server.shutdown(0)
        self.assertIsNone(await later.recv())

    async def test_it_is_made_again_when_the_command_connection_was(self) -> None:
        server = await self.serve()
        client = await self.client(reconnect=rt.Backoff(first=0, longest=0))
        data = client.data()
        await data.connected()
        states = data.states()
        self.assertEqual(await anext(states), rt.Connected(1))
        server._peers[server.connections[0][0]].over()
        with self.assertRaises(rt.DataLostError) as lost:
            await asyncio.wait_for(data.recv(), PATIENCE)
        self.assertEqual(lost.exception.loss.kind, rt.LossKind.RENEWED)
        while (state := await asyncio.wait_for(anext(states), PATIENCE)) != rt.Connected(2):
            self.assertIsInstance(state, rt.Connecting)
        # The robot knows its owner again.
        while len(server.connections) != 1 or server.counters.data_connections != 2:
            await asyncio.sleep(0)
        self.assertEqual(await server.send_data(0x0500, 7, b"", server.connections[0][0]), 1)
        self.assertEqual((await data.recv()).id, 7)
        await server.shutdown(0)

    async def test_shared_address_receives_no_stream(self) -> None:
        server = await self.serve()
        first = await self.client()
        second = await self.client()
        data = first.data()
        await data.connected()
        while not server.counters.data_connections:
            await asyncio.sleep(0)
        app = server.connections[0][0]
        with self.assertRaises(rt.AmbiguousError):
            await server.send_data(0x0500, 1, b"", app)
        with self.assertRaises(rt.NoConnectionError):
            await server.send_data(0x0500, 1, b"", 99)
        from_apps = server.streams()
        await data.send(0x0401, 1, b"")
        frame = await from_apps.recv()
        assert frame is not None
        self.assertEqual(await server.send_data(0x0500, 1, b"", frame.connection), 1)
        second.close()
        await server.shutdown(0)

    async def test_invalid_stream_is_refused_and_told(self) -> None:
        server = await self.serve()
        reader, writer = await asyncio.open_connection("127.0.0.1", self.ports[1])
        encoder, decoder = rt.Encoder(sample.SAMPLE), rt.Decoder(sample.SAMPLE)
        frame = rt.FrameId(False, sample.SAMPLE.command, 0x0100, 7)
        writer.write(encoder.encode(frame, b"{}"))
        while (answer := decoder.next()) is None:
            decoder.push(await reader.read(1024))
        self.assertEqual(answer.id, frame.answer())
        self.assertIn(b"2001", answer.data)
        writer.close()
        client = await self.client()
        data = client.data()
        await data.connected()
        peer = next(iter(server._data_peers.values()))
        peer._put(frame._replace(kind=sample.SAMPLE.stream).answer(), server.encoder.prepare(b'{"resultCode":2001}'))
        with self.assertRaises(rt.DataRefusedError):
            await data.recv()
        peer._put(frame, server.encoder.prepare(b"{}"))
        with self.assertRaises(rt.DataUnexpectedError):
            await data.recv()
        await server.shutdown(0)


async def _received(data: rt.DataConnection) -> rt.StreamFrame:
    while True:
        try:
            return await data.recv()
        except rt.DataLostError:
            continue


async def _send_all(server: rt.Server, count: int) -> None:
    for number in range(count):
        await server.send_data(0x0500, number, bytes(256 * 1024))


if __name__ == "__main__":
    unittest.main()
