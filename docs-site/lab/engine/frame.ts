// Frames: bytes to named fields and back. The layout comes from the generated protocol; nothing
// about it is written here.

import { Gunzip, gzipSync } from 'fflate'
import { md5 } from 'js-md5'
import { hexByte, readUint, writeUint } from './bytes'
import type { ErrorName, HeaderField, HeaderRole, Protocol } from './protocol'

/** A header field of a frame at hand. */
export interface FieldValue {
  field: HeaderField
  bytes: Uint8Array
  /** The number, for `uint` fields whose bytes are all there. */
  value: number | null
}

/** Something checked, and how it came out. */
export interface Verdict {
  what: 'head' | 'length' | 'kind' | 'encoding' | 'digest' | 'inflate'
  fault: ErrorName | null
  /** What was expected and what was found, where a number or bytes say it. */
  expected?: string
  found?: string
}

/** A frame, or as much of it as there is. */
export interface Decoded {
  /** All that there was to look at. */
  bytes: Uint8Array
  fields: FieldValue[]
  /** The data as sent. */
  data: Uint8Array
  /** The data after decompression; `null` if that failed or never began. */
  plain: Uint8Array | null
  /** Bytes behind this frame. */
  rest: Uint8Array
  verdicts: Verdict[]
  /** The first fault. */
  fault: ErrorName | null
}

/** The field with a role. */
export function fieldOf(protocol: Protocol, role: HeaderRole): HeaderField {
  const field = protocol.header.find((candidate) => candidate.role === role)
  if (!field) throw new Error(`the protocol has no header field with role ${role}`)
  return field
}

const same = (a: ArrayLike<number>, b: ArrayLike<number>) =>
  a.length === b.length && Array.prototype.every.call(a, (byte, index) => byte === b[index])

/** Raw digest of the data as sent. */
export function digest(data: Uint8Array): Uint8Array {
  return Uint8Array.from(md5.array(data))
}

/** Inflates one gzip member, giving up past `limit` bytes. */
function gunzip(data: Uint8Array, limit: number): Uint8Array | ErrorName {
  const parts: Uint8Array[] = []
  let length = 0
  let ended = false
  const stream = new Gunzip((part, final) => {
    parts.push(part)
    length += part.length
    ended = final
    if (length > limit) throw limit
  })
  try {
    stream.push(data, true)
  } catch (problem) {
    return problem === limit ? 'inflated_too_long' : 'bad_gzip'
  }
  if (!ended || data.length < 18) return 'bad_gzip'
  const plain = new Uint8Array(length)
  let at = 0
  for (const part of parts) {
    plain.set(part, at)
    at += part.length
  }
  // fflate does not look at the trailer (RFC 1952, 2.3.1): CRC32 and length of the plain data.
  const trailer = data.subarray(data.length - 8)
  const crc = readUint(trailer.subarray(0, 4), 'little')
  if (crc !== crc32(plain) || readUint(trailer.subarray(4), 'little') !== length % 2 ** 32) return 'bad_gzip'
  return plain
}

const CRC_TABLE = Uint32Array.from({ length: 256 }, (_, index) => {
  let value = index
  for (let bit = 0; bit < 8; bit++) value = value & 1 ? 0xedb88320 ^ (value >>> 1) : value >>> 1
  return value
})

function crc32(data: Uint8Array): number {
  let crc = 0xffffffff
  for (const byte of data) crc = CRC_TABLE[(crc ^ byte) & 0xff] ^ (crc >>> 8)
  return (crc ^ 0xffffffff) >>> 0
}

/** Takes a frame apart as far as it goes. Checks stand in the order in which the engine makes them. */
export function decodeFrame(protocol: Protocol, bytes: Uint8Array): Decoded {
  const fields = protocol.header.map((field): FieldValue => {
    const slice = bytes.subarray(field.offset, field.offset + field.size)
    const whole = slice.length === field.size
    return { field, bytes: slice, value: whole && field.type === 'uint' ? readUint(slice, protocol.byteOrder) : null }
  })
  const decoded: Decoded = { bytes, fields, data: new Uint8Array(), plain: null, rest: new Uint8Array(), verdicts: [], fault: null }
  const valueOf = (role: HeaderRole) => {
    const found = fields.find(({ field }) => field.role === role)
    return { value: found?.value ?? 0, bytes: found?.bytes ?? new Uint8Array() }
  }
  /** Notes a verdict; true if the frame goes on. */
  const check = (what: Verdict['what'], fault: ErrorName | null, expected?: string, found?: string) => {
    decoded.verdicts.push({ what, fault, expected, found })
    decoded.fault ??= fault
    return fault === null
  }

  const head = valueOf('head').bytes
  const heads = [protocol.requestHead, protocol.responseHead]
  const opens = heads.some((candidate) => same(candidate.slice(0, head.length), head))
  if (!check('head', opens ? null : 'bad_head')) return decoded
  const lengthField = fieldOf(protocol, 'total_length')
  if (bytes.length < lengthField.offset + lengthField.size) {
    check('length', 'truncated', `≥ ${protocol.headerLength}`, String(bytes.length))
    return decoded
  }
  const total = valueOf('total_length').value
  const available = String(bytes.length)
  if (total < protocol.headerLength) {
    check('length', 'short_frame', `≥ ${protocol.headerLength}`, String(total))
    return decoded
  }
  if (total > protocol.limits.frameBytes) {
    check('length', 'frame_too_long', `≤ ${protocol.limits.frameBytes}`, String(total))
    return decoded
  }
  decoded.data = bytes.subarray(protocol.headerLength, total)
  if (!check('length', bytes.length < total ? 'truncated' : null, String(total), available)) return decoded
  decoded.rest = bytes.subarray(total)

  const kindValue = valueOf('kind').value
  const kind = protocol.kinds.find(({ value }) => value === kindValue)
  if (!check('kind', !kind ? 'unknown_kind' : kind.role === 'reserved' ? 'reserved_kind' : null)) return decoded
  const encodingValue = valueOf('encoding').value
  const encoding = protocol.encodings.find(({ value }) => value === encodingValue)
  if (!check('encoding', encoding ? null : 'unknown_encoding')) return decoded
  const expected = digest(decoded.data)
  const sent = valueOf('digest').bytes
  const spell = (bytes: Uint8Array) => Array.from(bytes, hexByte).join('').toLowerCase()
  if (!check('digest', same(expected, sent) ? null : 'bad_digest', spell(expected), spell(sent))) return decoded

  const plainLength = valueOf('plain_length').value
  if (encoding?.role === 'plain') {
    const zero = plainLength === 0 && fieldOf(protocol, 'plain_length').zeroWhenPlain
    const fits = plainLength === decoded.data.length || zero
    check('inflate', fits ? null : 'plain_length_mismatch', String(decoded.data.length), String(plainLength))
    if (fits) decoded.plain = decoded.data
    return decoded
  }
  if (plainLength > protocol.limits.inflatedBytes) {
    check('inflate', 'inflated_too_long', `≤ ${protocol.limits.inflatedBytes}`, String(plainLength))
    return decoded
  }
  const plain = gunzip(decoded.data, protocol.limits.inflatedBytes)
  if (typeof plain === 'string') {
    check('inflate', plain)
    return decoded
  }
  const fits = plain.length === plainLength
  check('inflate', fits ? null : 'plain_length_mismatch', String(plain.length), String(plainLength))
  if (fits) decoded.plain = plain
  return decoded
}

/** What a frame to be made says of itself. */
export interface FrameParts {
  response: boolean
  kind: number
  code: number
  id: number
  gzip: boolean
  data: Uint8Array
}

/** Makes the frame. */
export function encodeFrame(protocol: Protocol, parts: FrameParts): Uint8Array {
  const data = parts.gzip ? gzipSync(parts.data, { mtime: 0 }) : parts.data
  const frame = new Uint8Array(protocol.headerLength + data.length)
  frame.set(data, protocol.headerLength)
  const encoding = protocol.encodings.find(({ role }) => role === (parts.gzip ? 'gzip' : 'plain'))
  const numbers: Partial<Record<HeaderRole, number>> = {
    kind: parts.kind,
    code: parts.code,
    id: parts.id,
    encoding: encoding?.value ?? 0,
    total_length: frame.length,
    plain_length: parts.data.length,
  }
  for (const field of protocol.header) {
    const target = frame.subarray(field.offset, field.offset + field.size)
    if (field.role === 'head') target.set(parts.response ? protocol.responseHead : protocol.requestHead)
    else if (field.role === 'digest') target.set(digest(data))
    else if (field.type === 'uint') writeUint(target, (field.role && numbers[field.role]) ?? field.value, protocol.byteOrder)
  }
  return frame
}
