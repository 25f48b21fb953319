// Allocates buffers.

/** Bytes of a block. */
const BLOCK = 64 * 1024
/** Longer arrays get a buffer each. */
const SHORT = 4 * 1024

let block = new Uint8Array(BLOCK)
let used = 0

/**
 * Returns a buffer of `length` bytes; the caller writes all of them. Short buffers share a block, which is much faster
 * to allocate. The block stays in memory until all of its buffers are free.
 */
export function room(length: number): Uint8Array {
  if (length > SHORT) return new Uint8Array(length)
  if (used + length > BLOCK) {
    block = new Uint8Array(BLOCK)
    used = 0
  }
  const bytes = block.subarray(used, used + length)
  used += length
  return bytes
}

/** Texts up to this many UTF-16 units are first encoded here, since the number of bytes is not known before. */
const UNITS = 32 * 1024

const encoder = new TextEncoder()
const scratch = new Uint8Array(3 * UNITS)

/** Encodes a text in UTF-8. */
export function utf8Of(text: string): Uint8Array {
  if (text.length > UNITS) return encoder.encode(text)
  const { written } = encoder.encodeInto(text, scratch)
  const bytes = room(written)
  bytes.set(scratch.subarray(0, written))
  return bytes
}
