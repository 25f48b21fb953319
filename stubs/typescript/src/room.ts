// Room for bytes.

/** Bytes of a block. */
const BLOCK = 64 * 1024
/** What is longer has room of its own. */
const SHORT = 4 * 1024

let block = new Uint8Array(BLOCK)
let used = 0

/**
 * Room for so many bytes, all of which are to be written: what is short shares a block with others, which is much faster to
 * come by, and stays until none of them is held any more.
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

/** Texts of so many units or fewer are encoded here first: nobody knows before how many bytes they are. */
const UNITS = 32 * 1024

const encoder = new TextEncoder()
const scratch = new Uint8Array(3 * UNITS)

/** A text in UTF-8. */
export function utf8Of(text: string): Uint8Array {
  if (text.length > UNITS) return encoder.encode(text)
  const { written } = encoder.encodeInto(text, scratch)
  const bytes = room(written)
  bytes.set(scratch.subarray(0, written))
  return bytes
}
