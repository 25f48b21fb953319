// Files of captured packets: pcap and pcapng, as written by tcpdump, Wireshark and phone apps.

import { readUint } from '../fc'

type Order = 'big' | 'little'

/**
 * The first four bytes of a pcap file: with microseconds, with nanoseconds, and Kuznetzov's form with longer records.
 */
const PCAP = [0xa1b2c3d4, 0xa1b23c4d, 0xa1b2cd34]
const SECTION = 0x0a0d0d0a
const SECTION_ORDER = 0x1a2b3c4d
/** Blocks of pcapng with packets, or with data that packets need. */
const INTERFACE = 1
const OLD_PACKET = 2
const SIMPLE_PACKET = 3
const ENHANCED_PACKET = 6

const number = (bytes: Uint8Array, at: number, size: number, order: Order) => readUint(bytes.subarray(at, at + size), order)

function pcapOrder(bytes: Uint8Array): Order | null {
  if (bytes.length < 24) return null
  for (const order of ['big', 'little'] as const) if (PCAP.includes(number(bytes, 0, 4, order))) return order
  return null
}

const sectionOrder = (bytes: Uint8Array, at: number): Order | null => {
  for (const order of ['big', 'little'] as const) if (number(bytes, at + 8, 4, order) === SECTION_ORDER) return order
  return null
}

const isPcapng = (bytes: Uint8Array) => bytes.length >= 28 && number(bytes, 0, 4, 'big') === SECTION && sectionOrder(bytes, 0) !== null

/**
 * Returns the packets of such a file, without their link headers; `null` for other bytes. A file that ends inside a
 * packet gives the packets before it.
 */
export function readCaptureFile(bytes: Uint8Array): Uint8Array[] | null {
  const order = pcapOrder(bytes)
  if (order) return readPcap(bytes, order)
  return isPcapng(bytes) ? readPcapng(bytes) : null
}

function readPcap(bytes: Uint8Array, order: Order): Uint8Array[] {
  const link = number(bytes, 20, 4, order) & 0xffff
  const header = number(bytes, 0, 4, order) === PCAP[2] ? 24 : 16
  const packets: Uint8Array[] = []
  let at = 24
  while (at + header <= bytes.length) {
    const end = at + header + number(bytes, at + 8, 4, order)
    if (end > bytes.length) break
    packets.push(behindLink(link, bytes.subarray(at + header, end)))
    at = end
  }
  return packets
}

function readPcapng(bytes: Uint8Array): Uint8Array[] {
  const packets: Uint8Array[] = []
  let order: Order = 'little'
  let links: { link: number; limit: number }[] = []
  let at = 0
  while (at + 12 <= bytes.length) {
    const isSection = number(bytes, at, 4, 'big') === SECTION
    if (isSection) {
      const found = at + 28 <= bytes.length ? sectionOrder(bytes, at) : null
      if (!found) break
      ;[order, links] = [found, []]
    }
    const kind = number(bytes, at, 4, order)
    const length = number(bytes, at + 4, 4, order)
    if (length < 12 || length % 4 !== 0 || at + length > bytes.length) break
    const block = bytes.subarray(at + 8, at + length - 4)
    const packet = (from: number, size: number, which: number) => {
      const link = links[which]
      if (link && from + size <= block.length) packets.push(behindLink(link.link, block.subarray(from, from + size)))
    }
    if (!isSection && kind === INTERFACE && block.length >= 8) {
      links.push({ link: number(block, 0, 2, order), limit: number(block, 4, 4, order) || Infinity })
    } else if (kind === ENHANCED_PACKET && block.length >= 20) packet(20, number(block, 12, 4, order), number(block, 0, 4, order))
    else if (kind === OLD_PACKET && block.length >= 20) packet(20, number(block, 12, 4, order), number(block, 0, 2, order))
    else if (kind === SIMPLE_PACKET && block.length >= 4) {
      packet(4, Math.min(number(block, 0, 4, order), links[0]?.limit ?? 0), 0)
    }
    at += length
  }
  return packets
}

/** Skips the Ethernet header and the headers of VLANs after its addresses. */
function behindEthernet(bytes: Uint8Array): Uint8Array {
  let at = 12
  while (at + 4 <= bytes.length && [0x8100, 0x88a8, 0x9100].includes(number(bytes, at, 2, 'big'))) at += 4
  return bytes.subarray(at + 2)
}

/** Returns the IP packet in a frame of a link, by the numbers of `LINKTYPE_…`; for an unknown link the whole frame. */
function behindLink(link: number, bytes: Uint8Array): Uint8Array {
  switch (link) {
    case 1:
      return behindEthernet(bytes)
    case 0:
    case 108:
    case 9:
      return bytes.subarray(4)
    case 113:
      return bytes.subarray(16)
    case 276:
      return bytes.subarray(20)
    default:
      return bytes
  }
}
