// Base64 of RFC 4648, with padding.

import { oneForEach } from './characters.ts'
import { BodyError } from './fault.ts'

const ALPHABET = 'ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/'
const PAD = 0x3d
const NONE = 0xff

const DIGITS = Uint8Array.from(ALPHABET, (digit) => digit.charCodeAt(0))
const VALUES = new Uint8Array(128).fill(NONE)
for (const [value, digit] of DIGITS.entries()) VALUES[digit] = value

/** Decodes base64 text. Throws a `BodyError`. */
export function bytesOfBase64(text: string): Uint8Array {
  const { length } = text
  if (length % 4 !== 0) throw new BodyError('bad_base64', 'RFC 4648')
  const padding = length === 0 || text.charCodeAt(length - 1) !== PAD ? 0 : text.charCodeAt(length - 2) === PAD ? 2 : 1
  const bytes = new Uint8Array((length / 4) * 3 - padding)
  const digits = length - padding
  let bits = 0
  let held = 0
  let out = 0
  for (let at = 0; at < digits; at++) {
    const value = VALUES[text.charCodeAt(at)] ?? NONE
    if (value === NONE) throw new BodyError('bad_base64', 'RFC 4648')
    bits = ((bits << 6) | value) & 0xffffff
    held += 6
    if (held >= 8) {
      held -= 8
      bytes[out++] = bits >> held
    }
  }
  // Spare bits of the last digit must be zero, otherwise the text is not the base64 of any bytes.
  if ((bits & ((1 << held) - 1)) !== 0) throw new BodyError('bad_base64', 'RFC 4648')
  return bytes
}

/** Encodes bytes as base64 text. */
export function base64Of(bytes: Uint8Array): string {
  const { length } = bytes
  const digits = new Uint8Array(Math.ceil(length / 3) * 4)
  let out = 0
  for (let at = 0; at < length; at += 3) {
    // Missing bytes after the end count as zero bits.
    const bits = ((bytes[at] ?? 0) << 16) | ((bytes[at + 1] ?? 0) << 8) | (bytes[at + 2] ?? 0)
    digits[out++] = DIGITS[bits >> 18] ?? PAD
    digits[out++] = DIGITS[(bits >> 12) & 63] ?? PAD
    digits[out++] = DIGITS[(bits >> 6) & 63] ?? PAD
    digits[out++] = DIGITS[bits & 63] ?? PAD
  }
  if (length % 3 !== 0) digits[out - 1] = PAD
  if (length % 3 === 1) digits[out - 2] = PAD
  return oneForEach(digits)
}
