"""Counters of a robot."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(slots=True)
class ServerCounters:
    """Counters since the robot was made."""

    connections: int = 0
    """Connections accepted at the command port."""
    data_connections: int = 0
    """Connections accepted at the data port."""
    connections_refused: int = 0
    """Connections closed at once at the limit, in total or from their address."""
    connections_forbidden: int = 0
    """Connections closed at once because their address is not allowed."""
    connections_displaced: int = 0
    """Silent connections closed to make room for another."""
    connections_evicted: int = 0
    """Connections closed because memory was short and they held most of it."""
    connections_timed_out: int = 0
    """Connections closed by a timeout: of a header, of a stalled frame or reader, or of silence."""
    connections_paced: int = 0
    """Times a connection was not read for a while because of useless frames."""
    bad_frames: int = 0
    """Frames that cannot be read."""
    calls_succeeded: int = 0
    """Requests with a response of success."""
    calls_protocol: int = 0
    """Requests with the result for a protocol error."""
    calls_timed_out: int = 0
    """Requests whose handler gave no result in time."""
    calls_invalid: int = 0
    """Requests with the result for an invalid parameter."""
    calls_expired: int = 0
    """Requests with the result for an expired message."""
    calls_refused: int = 0
    """Requests to which a handler gave another result."""
    calls_forbidden: int = 0
    """Requests refused because their address does not allow them; included in `calls_protocol`."""
    calls_not_implemented: int = 0
    """Requests that the robot does not implement; included in `calls_protocol`."""
    handlers_panicked: int = 0
    """Handlers that raised an error other than a refusal; included in `calls_protocol`."""
    handlers_abandoned: int = 0
    """Handlers that were still running when their result was no longer awaited."""
    abandoned_reached: int = 0
    """Requests refused because `abandoned_handlers` of these were running; included in `calls_protocol`."""
    in_flight_reached: int = 0
    """Times a connection was not read because it had the most requests in flight."""
    reports_sent: int = 0
    """Reports sent for the first time, counted per app."""
    reports_repeated: int = 0
    """Reports sent again."""
    reports_acknowledged: int = 0
    """Reports acknowledged."""
    reports_refused: int = 0
    """Reports acknowledged with a result other than success."""
    reports_timed_out: int = 0
    """Reports given up after the last repetition."""
    reports_dropped: int = 0
    """Reports that newer ones replaced before they were sent."""
    stream_frames_in: int = 0
    """Stream frames received."""
    stream_frames_out: int = 0
    """Stream frames sent."""
    stream_frames_dropped: int = 0
    """Stream frames of apps dropped for lack of a receiver."""
    bytes_in: int = 0
    """Bytes received at both ports."""
    bytes_out: int = 0
    """Bytes sent at both ports."""
