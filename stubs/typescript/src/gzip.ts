// One gzip member (RFC 1952). Its header and trailer are read here; platforms inflate the deflated data between them.

import { crc32 } from './crc32.ts'

/** The magic number, and the method: deflate. */
const MAGIC = [0x1f, 0x8b, 8]
const HEADER = 10
const TRAILER = 8

/** Flags of optional header fields. */
const EXTRA = 0b0000_0100
const NAME = 0b0000_1000
const COMMENT = 0b0001_0000
const CHECKSUM = 0b0000_0010
const RESERVED = 0b1110_0000

/**
 * Returns the deflated data of a member; `null` for other data. The member must end with the last byte. A second member
 * or zeros after the first one count as data, and inflating them fails.
 */
export function deflatedOf(member: Uint8Array): Uint8Array | null {
  const flags = member[3] ?? RESERVED
  if (!MAGIC.every((byte, at) => member[at] === byte) || (flags & RESERVED) !== 0) return null
  let start = HEADER
  if ((flags & EXTRA) !== 0) start += 2 + ((member[start] ?? 0) | ((member[start + 1] ?? 0) << 8))
  for (const text of [NAME, COMMENT]) {
    if ((flags & text) === 0) continue
    const end = member.indexOf(0, start)
    if (end < 0) return null
    start = end + 1
  }
  if ((flags & CHECKSUM) !== 0) start += 2
  const end = member.length - TRAILER
  return start < end ? member.subarray(start, end) : null
}

/** Returns `true` if the last bytes of a member are the CRC-32 and the length of the plain data. Not every library checks them. */
export function hasTrailer(member: Uint8Array, plain: Uint8Array): boolean {
  if (member.length < HEADER + TRAILER) return false
  const trailer = new DataView(member.buffer, member.byteOffset + member.length - TRAILER, TRAILER)
  return trailer.getUint32(0, true) === crc32(plain) && trailer.getUint32(4, true) === plain.length % 2 ** 32
}
