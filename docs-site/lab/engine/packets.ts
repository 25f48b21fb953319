// Whole packets as capture tools print them: their Ethernet, IP and TCP headers come off, so that what
// remains is the byte stream. Segments that are none stay as they are.

import { readUint } from '../fc'
import type { Segment } from './dump'

interface Packet {
  /** Addresses and ports, from and to. */
  flow: string
  sequence: number
  payload: Uint8Array
}

const number = (bytes: Uint8Array, at: number, size: number) => readUint(bytes.subarray(at, at + size), 'big')

/** The TCP segment in an IP packet, `null` if this is none. */
function inside(bytes: Uint8Array): Packet | null {
  const version = bytes[0] >> 4
  let header: number
  let total: number
  let protocol: number
  let addresses: Uint8Array
  if (version === 4 && bytes.length >= 20) {
    header = (bytes[0] & 15) * 4
    total = number(bytes, 2, 2)
    protocol = bytes[9]
    addresses = bytes.subarray(12, 20)
  } else if (version === 6 && bytes.length >= 40) {
    header = 40
    total = 40 + number(bytes, 4, 2)
    protocol = bytes[6]
    addresses = bytes.subarray(8, 40)
  } else return null
  if (protocol !== 6 || header < 20 || total > bytes.length || total < header + 20) return null
  const tcp = bytes.subarray(header, total)
  const offset = (tcp[12] >> 4) * 4
  if (offset < 20 || offset > tcp.length) return null
  const half = addresses.length / 2
  const end = (side: number) => `${addresses.subarray(side * half, side * half + half)}:${number(tcp, side * 2, 2)}`
  return { flow: `${end(0)} ${end(1)}`, sequence: number(tcp, 4, 4), payload: tcp.subarray(offset) }
}

/** Ethernet, the two "cooked" forms of Linux, BSD's loopback, or bare IP: where the version's nibble stands. */
function packetOf(bytes: Uint8Array): Packet | null {
  for (const link of [0, 14, 18, 16, 20, 4]) {
    const found = bytes.length > link ? inside(bytes.subarray(link)) : null
    if (found) return found
  }
  return null
}

/** Packets give their payload, each flow a stream of its own; what was sent again counts once. */
export function parsePackets(segments: Segment[]): Segment[] {
  const packets = segments.map(({ bytes }) => packetOf(bytes))
  if (packets.length === 0 || packets.some((packet) => packet === null)) return segments
  const flows: string[] = []
  const next = new Map<string, number>()
  const streams: Segment[] = []
  for (const packet of packets) {
    if (!packet) continue
    const { flow, sequence, payload } = packet
    if (!flows.includes(flow)) flows.push(flow)
    if (payload.length === 0) continue
    const expected = next.get(flow)
    const repeated = expected === undefined ? 0 : (expected - sequence) >>> 0
    const skip = repeated < 2 ** 31 ? Math.min(repeated, payload.length) : 0
    if (skip < payload.length) {
      streams.push({ stream: flows.indexOf(flow), bytes: payload.slice(skip) })
      next.set(flow, (sequence + payload.length) >>> 0)
    }
  }
  return streams
}
