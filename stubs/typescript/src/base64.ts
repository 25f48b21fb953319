// Base64 of RFC 4648, with padding.

import { BodyError } from './fault.ts'

const ALPHABET = 'ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/'
const PAD = 0x3d
const NONE = 0xff

const VALUES = new Uint8Array(128).fill(NONE)
for (let value = 0; value < ALPHABET.length; value++) VALUES[ALPHABET.charCodeAt(value)] = value

/** The bytes that a text stands for. Throws a `BodyError`. */
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
  // Bits of the last digit that no byte takes: who sends them means something else.
  if ((bits & ((1 << held) - 1)) !== 0) throw new BodyError('bad_base64', 'RFC 4648')
  return bytes
}

/** Bytes as text. */
export function base64Of(bytes: Uint8Array): string {
  let text = ''
  for (let at = 0; at < bytes.length; at += 3) {
    const [a = 0, b = 0, c = 0] = bytes.subarray(at, at + 3)
    const bits = (a << 16) | (b << 8) | c
    text += digit(bits >> 18) + digit(bits >> 12)
    text += at + 1 < bytes.length ? digit(bits >> 6) : '='
    text += at + 2 < bytes.length ? digit(bits) : '='
  }
  return text
}

const digit = (bits: number): string => ALPHABET.charAt(bits & 63)
