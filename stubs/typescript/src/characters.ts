// Bytes as characters.

import { BodyError } from './fault.ts'

const utf8 = new TextDecoder('utf-8', { fatal: true, ignoreBOM: true })

/** Decodes UTF-8 from index `from` up to `to`, exclusive. Throws a `BodyError`. */
export function decoded(bytes: Uint8Array, from: number = 0, to: number = bytes.length): string {
  if (to - from <= SHORT) {
    const text = shortText(bytes, from, to)
    if (text !== null) return text
  }
  try {
    return utf8.decode(bytes.subarray(from, to))
  } catch {
    throw new BodyError('not_utf8', 'UTF-8')
  }
}

/** Up to this many bytes are decoded here, in a third of the time that starting a decoder takes. */
const SHORT = 32

/** Decodes characters of up to three bytes. Returns `null` for all other bytes, valid UTF-8 or not. */
function shortText(bytes: Uint8Array, from: number, to: number): string | null {
  const units: number[] = []
  let at = from
  while (at < to) {
    const lead = bytes[at++] ?? 0
    if (lead < 0x80) {
      units.push(lead)
      continue
    }
    // A first byte 110xxxxx starts two bytes, 1110xxxx three; the following ones are 10xxxxxx.
    const more = lead >= 0xc2 && lead < 0xe0 ? 1 : lead >= 0xe0 && lead < 0xf0 ? 2 : 0
    if (more === 0 || at + more > to) return null
    let code = more === 1 ? lead & 0x1f : lead & 0x0f
    for (let left = more; left > 0; left--) {
      const next = bytes[at++] ?? 0
      if (next >> 6 !== 0b10) return null
      code = (code << 6) | (next & 0x3f)
    }
    // An overlong form, or half of a surrogate pair.
    if (more === 2 && (code < 0x800 || (code >= 0xd800 && code < 0xe000))) return null
    units.push(code)
  }
  return String.fromCharCode(...units)
}

/**
 * Returns a string with one character per byte. ASCII bytes map to themselves; the characters for other bytes are
 * unspecified.
 */
export const oneForEach: (bytes: Uint8Array) => string = typeof Buffer === 'function' ? copied : single()

/** Node.js copies the bytes unchanged, while its decoder checks each one. */
function copied(bytes: Uint8Array): string {
  return (Buffer.isBuffer(bytes) ? bytes : Buffer.from(bytes.buffer, bytes.byteOffset, bytes.length)).toString('latin1')
}

function single(): (bytes: Uint8Array) => string {
  const decoder = new TextDecoder('windows-1252')
  return (bytes) => decoder.decode(bytes)
}

/** Returns `true` if the text is all ASCII. */
export function isAscii(text: string): boolean {
  return !/[^\0-\x7f]/.test(text)
}
