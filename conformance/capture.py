"""Writes captures in the pcap format, with TCP connections that carry frames."""

import struct

APP, ROBOT = bytes([10, 0, 0, 2]), bytes([10, 0, 0, 1])
LARGEST_PACKET = 262_144
PSH_ACK, FIN_ACK = 0x18, 0x11


def header():
    """Returns the header of a capture."""
    return struct.pack("<IHHiIII", 0xA1B2C3D4, 2, 4, 0, 0, LARGEST_PACKET, 1)


def packet(time, app_port, robot_port, sequence, payload, *, by_robot=False, flags=PSH_ACK):
    """Returns the record of an Ethernet packet between app and robot. The time is in microseconds."""
    ports, hosts = (app_port, robot_port), (APP, ROBOT)
    if by_robot:
        ports, hosts = ports[::-1], hosts[::-1]
    tcp = struct.pack(">HHIIBBHHH", *ports, sequence, 1, 5 << 4, flags, 65535, 0, 0)
    length = 20 + len(tcp) + len(payload)
    ip = struct.pack(">BBHHHBBH4s4s", 0x45, 0, length, 0, 0x4000, 64, 6, 0, *hosts)
    data = bytes(12) + b"\x08\x00" + ip + tcp + payload
    seconds, micros = divmod(time, 1_000_000)
    return struct.pack("<IIII", seconds, micros, len(data), len(data)) + data
