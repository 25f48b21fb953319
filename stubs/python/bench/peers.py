"""Who answers and who asks: this package, gRPC, and bare transports of asyncio, with the same question and answer."""

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
"""Bytes of the frame that asks, and of the frame that answers."""
WINDOW = 64
"""Most requests in one write of the bare transports."""

sys.path.append(str(Path(__file__).resolve().parents[3] / "bench" / "proto"))


class Robot(fc.PartialRobot):
    """Answers for a station, with a message made for each call."""

    async def get_station(self, context: rt.Context, request: fc.GetStationRequest) -> fc.GetStationResponse:
        """The station that is asked for."""
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
        """Gives the port."""
        server = rt.Server(Robot(), rt.ServerConfig(address=HOST, command_port=0, data_port=0))
        await server.__aenter__()
        return server.command_address[1]

    async def connect(self, port: int, window: int) -> Call:
        """Gives what makes a call."""
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
        """Gives the port."""
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
        # Nobody else holds it.
        self.server = server
        return port

    async def connect(self, port: int, window: int) -> Call:
        """Gives what makes a call."""
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
    """As many bytes, a window of requests in one write, and nothing done with them."""

    windows = True

    async def serve(self) -> int:
        """Gives the port."""
        server = await asyncio.get_running_loop().create_server(_Answering, HOST, 0)
        # Nobody else holds it.
        self.server = server
        return int(server.sockets[0].getsockname()[1])

    async def connect(self, port: int, window: int) -> Call:
        """Gives what makes a window of calls."""
        loop = asyncio.get_running_loop()
        transport, asking = await loop.create_connection(_Asking, HOST, port)
        asks = bytes(window * ASKS)

        async def call() -> None:
            asking.missing, asking.done = window * ANSWERS, loop.create_future()
            transport.write(asks)
            await asking.done

        return call


PEERS: dict[str, Callable[[], Raw | Fc | Grpc]] = {"raw": Raw, "fc": Fc, "grpcio": Grpc}
"""All of them."""
