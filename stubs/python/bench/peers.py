"""Servers and callers: this package, gRPC, and bare transports of asyncio, with the same request and response."""

from __future__ import annotations

import asyncio
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

import grpc

import fc
import fc_runtime as rt

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable

    Call = Callable[[], Awaitable[None]]

HOST = "127.0.0.1"
STATION = 1_671_124_918_008
NAME = "gate1"
ASKS, ANSWERS = 95, 204
"""Bytes of the request's frame, and of the response's."""
WINDOW = 64
"""Most requests in one write of the bare transports."""

sys.path.append(str(Path(__file__).resolve().parents[3] / "bench" / "proto"))


class Robot(fc.PartialRobot):
    """A robot that returns a station, with a new message for each call."""

    async def get_station(self, context: rt.Context, request: fc.GetStationRequest) -> fc.GetStationResponse:
        """Returns the station."""
        return fc.GetStationResponse(
            data=fc.GetStationResponseData(
                station_name=NAME,
                station_id=request.data.station_id,
                station_type=fc.StationType.NAVIGATION,
                x=0.5,
                y=0.6,
                yaw=0.2,
            )
        )


def _same(station: int, name: str) -> None:
    if (station, name) != (STATION, NAME):
        raise ValueError("another answer")


class Fc:
    """The asyncio client and the robot side of this package."""

    windows = False

    async def serve(self) -> int:
        """Returns the port."""
        server = rt.Server(Robot(), rt.ServerConfig(address=HOST, command_port=0, data_port=0))
        await server.__aenter__()
        return server.command_address[1]

    async def connect(self, port: int, window: int) -> Call:
        """Returns a function that makes a call."""
        client = await fc.Client.connect(rt.ClientConfig(host=HOST, command_port=port))

        async def call() -> None:
            request = fc.GetStationRequest(data=fc.GetStationRequestData(station_id=STATION))
            answer = await client.get_station(request)
            _same(answer.data.station_id, answer.data.station_name)

        return call


class Grpc:
    """gRPC with asyncio."""

    windows = False

    def __init__(self) -> None:
        self.messages, self.services = grpc.protos_and_services("bench.proto")

    async def serve(self) -> int:
        """Returns the port."""
        messages, success = self.messages, fc.FC.results.success

        class Servicer(self.services.RobotServicer):  # type: ignore[name-defined, misc]
            async def GetStation(self, request: Any, context: Any) -> Any:  # noqa: N802 - as gRPC calls it
                return messages.StationResponse(
                    cmd_time=time.time_ns() // 1_000_000,
                    result_code=success.code,
                    result_msg=success.text,
                    station_name=NAME,
                    station_id=request.station_id,
                    station_type=fc.StationType.NAVIGATION.value,
                    x=0.5,
                    y=0.6,
                    yaw=0.2,
                )

        server = grpc.aio.server()
        self.services.add_RobotServicer_to_server(Servicer(), server)
        port: int = server.add_insecure_port(f"{HOST}:0")
        await server.start()
        # Keeps a reference, since nothing else does.
        self.server = server
        return port

    async def connect(self, port: int, window: int) -> Call:
        """Returns a function that makes a call."""
        stub = self.services.RobotStub(grpc.aio.insecure_channel(f"{HOST}:{port}"))
        make = self.messages.StationRequest

        async def call() -> None:
            answer = await stub.GetStation(make(cmd_time=time.time_ns() // 1_000_000, station_id=STATION))
            _same(answer.station_id, answer.station_name)

        return call


class _Answering(asyncio.Protocol):
    answers = bytes(WINDOW * ANSWERS)

    def __init__(self) -> None:
        self.held = 0

    def connection_made(self, transport: Any) -> None:
        self.transport = transport

    def data_received(self, data: bytes) -> None:
        whole, self.held = divmod(self.held + len(data), ASKS)
        if whole:
            self.transport.write(self.answers[: whole * ANSWERS])


class _Asking(asyncio.Protocol):
    missing = 0
    done: asyncio.Future[None]

    def data_received(self, data: bytes) -> None:
        self.missing -= len(data)
        if self.missing == 0:
            self.done.set_result(None)


class Raw:
    """The floor: as many bytes, a window of requests in one write, without any processing."""

    windows = True

    async def serve(self) -> int:
        """Returns the port."""
        server = await asyncio.get_running_loop().create_server(_Answering, HOST, 0)
        # Keeps a reference, since nothing else does.
        self.server = server
        return int(server.sockets[0].getsockname()[1])

    async def connect(self, port: int, window: int) -> Call:
        """Returns a function that makes a window of calls."""
        loop = asyncio.get_running_loop()
        transport, asking = await loop.create_connection(_Asking, HOST, port)
        asks = bytes(window * ASKS)

        async def call() -> None:
            asking.missing, asking.done = window * ANSWERS, loop.create_future()
            transport.write(asks)
            await asking.done

        return call


PEERS: dict[str, Callable[[], Raw | Fc | Grpc]] = {"raw": Raw, "fc": Fc, "grpcio": Grpc}
"""All peers."""
