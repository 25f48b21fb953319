// Whole packets as capture tools print and store them. Their Ethernet, IP and TCP headers are removed, and the byte
// streams remain. Segments that are not packets do not change.

import { readUint } from '../fc'
import type { Heads, Segment } from './dump'

interface Packet {
  /** Addresses and ports of both ends, the sender first. */
  from: string
  to: string
  sequence: number
  /** `true` if it opens a connection. */
  opens: boolean
  payload: Uint8Array
}

const number = (bytes: Uint8Array, at: number, size: number) => readUint(bytes.subarray(at, at + size), 'big')

/** Returns the TCP segment in an IP packet; `null` if there is none. */
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
  return { from: end(0), to: end(1), sequence: number(tcp, 4, 4), opens: (tcp[13] & 2) !== 0, payload: tcp.subarray(offset) }
}

/** Finds the IP header after Ethernet, the two "cooked" forms of Linux, BSD's loopback, or at the start. */
function packetOf(bytes: Uint8Array): Packet | null {
  for (const link of [0, 14, 18, 16, 20, 4]) {
    const found = bytes.length > link ? inside(bytes.subarray(link)) : null
    if (found) return found
  }
  return null
}

/** One direction of a connection. */
interface Flow {
  stream: number
  /** Both ends of the connection, in the same order for both directions. */
  connection: string
  /** The sequence number of the next byte. */
  next: number
  /** Packets that came before a missing one. */
  early: Packet[]
}

/** Adds the new bytes of a packet to `found`. An early packet waits. */
function take(flow: Flow, packet: Packet, found: Segment[]): void {
  const ahead = (packet.sequence - flow.next) | 0
  if (ahead > 0) {
    flow.early.push(packet)
    return
  }
  const fresh = packet.payload.slice(Math.min(-ahead, packet.payload.length))
  if (fresh.length === 0) return
  found.push({ stream: flow.stream, bytes: fresh })
  flow.next = (flow.next + fresh.length) >>> 0
}

/** Takes packets that waited, in the order of their bytes: all of them, or those that are next. */
function takeEarly(flow: Flow, found: Segment[], all: boolean): void {
  const from = flow.next
  const waiting = flow.early.sort((a, b) => ((a.sequence - from) | 0) - ((b.sequence - from) | 0))
  flow.early = []
  for (const [index, packet] of waiting.entries()) {
    if (((packet.sequence - flow.next) | 0) > 0) {
      if (!all) {
        flow.early = waiting.slice(index)
        return
      }
      // The capture lacks the bytes in between.
      flow.next = packet.sequence
    }
    take(flow, packet, found)
  }
}

/** Returns the bytes of each flow in the order of its sequence numbers. Repeated bytes count once. */
function streamsOf(packets: Packet[]): { found: Segment[]; flows: Flow[] } {
  const open = new Map<string, Flow>()
  const flows: Flow[] = []
  const found: Segment[] = []
  for (const packet of packets) {
    const { from, to, sequence, opens, payload } = packet
    const name = `${from} ${to}`
    let flow = open.get(name)
    // A new connection between the same ports starts a new count.
    if (!flow || (opens && flow.next !== ((sequence + 1) >>> 0))) {
      flow = { stream: flows.length, connection: [from, to].sort().join(' '), next: (sequence + Number(opens)) >>> 0, early: [] }
      flows.push(flow)
      open.set(name, flow)
    }
    if (payload.length === 0 || opens) continue
    take(flow, packet, found)
    if (flow.early.length > 0) takeEarly(flow, found, false)
  }
  for (const flow of flows) takeEarly(flow, found, true)
  return { found, flows }
}

/** Returns the payload of printed packets; each flow is a separate stream. */
export function parsePackets(segments: Segment[]): Segment[] {
  const packets = segments.map(({ bytes }) => packetOf(bytes))
  const all = packets.filter((packet) => packet !== null)
  return all.length === 0 || all.length < packets.length ? segments : streamsOf(all).found
}

/**
 * Returns the streams with frames of captured IP packets, since a capture of a whole network has other traffic as well.
 * `tcp` is the number of TCP packets.
 */
export function framesIn(packets: Uint8Array[], heads: Heads): { segments: Segment[]; tcp: number } {
  const all = packets.map(inside).filter((packet) => packet !== null)
  const { found, flows } = streamsOf(all)
  const begins = ({ bytes }: Segment) => heads.some((head) => head.every((byte, index) => bytes[index] === byte))
  const connections = new Set(found.filter(begins).map(({ stream }) => flows[stream].connection))
  const streams = flows.filter(({ connection }) => connections.has(connection)).map(({ stream }) => stream)
  const kept = found.filter(({ stream }) => streams.includes(stream))
  return { segments: kept.map(({ stream, bytes }) => ({ stream: streams.indexOf(stream), bytes })), tcp: all.length }
}
