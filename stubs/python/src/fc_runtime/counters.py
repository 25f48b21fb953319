"""What has happened at a robot, in numbers."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(slots=True)
class ServerCounters:
    """What has happened since the robot was made."""

    connections: int = 0
    """Connections accepted at the command port."""
    data_connections: int = 0
    """Connections accepted at the data port."""
    connections_refused: int = 0
    """Connections closed at once, for there were as many as there may be, in total or from their address."""
    connections_forbidden: int = 0
    """Connections closed at once, for none may come from their address."""
    connections_displaced: int = 0
    """Connections closed to make room for another, for nothing had come over them yet."""
    connections_evicted: int = 0
    """Connections closed because memory was short and they held most of it."""
    connections_timed_out: int = 0
    """Connections closed because a header, the rest of a frame, a reader or anything at all did not come in time."""
    connections_paced: int = 0
    """Times a connection was not read for a while because of useless work it had made."""
    bad_frames: int = 0
    """Frames that cannot be read."""
    calls_succeeded: int = 0
    """Requests answered with success."""
    calls_protocol: int = 0
    """Requests answered with the result of a protocol error."""
    calls_timed_out: int = 0
    """Requests whose handler gave no result in time."""
    calls_invalid: int = 0
    """Requests answered with the result of an invalid parameter."""
    calls_expired: int = 0
    """Requests answered with the result of an expired message."""
    calls_refused: int = 0
    """Requests that a handler answered with another result."""
    calls_forbidden: int = 0
    """Requests that may not be made from their address. They are among `calls_protocol`."""
    calls_not_implemented: int = 0
    """Requests that the robot does not implement. They are among `calls_protocol`."""
    handlers_panicked: int = 0
    """Handlers that raised something other than a refusal. They are among `calls_protocol`."""
    handlers_abandoned: int = 0
    """Handlers that ran on without anybody waiting for their result."""
    abandoned_reached: int = 0
    """Requests refused because as many as `abandoned_handlers` ran on. They are among `calls_protocol`."""
    in_flight_reached: int = 0
    """How often a connection was not read, for it has too many requests in flight."""
    reports_sent: int = 0
    """Reports sent for the first time, counted per app."""
    reports_repeated: int = 0
    """Reports sent again."""
    reports_acknowledged: int = 0
    """Reports acknowledged."""
    reports_refused: int = 0
    """Reports answered with another result."""
    reports_timed_out: int = 0
    """Reports given up after the last repetition."""
    reports_dropped: int = 0
    """Reports that made way before they were sent."""
    stream_frames_in: int = 0
    """Stream frames received."""
    stream_frames_out: int = 0
    """Stream frames sent."""
    stream_frames_dropped: int = 0
    """Stream frames of apps that nobody took."""
    bytes_in: int = 0
    """Bytes received at both ports."""
    bytes_out: int = 0
    """Bytes sent at both ports."""
