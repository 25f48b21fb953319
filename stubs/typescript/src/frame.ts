// Frames: bytes to named fields and back. The layout comes from the generated protocol; nothing
// about it is written here.

import type { Codec, GunzipFault } from './algorithms.ts'
import { hexByte, readUint, writeUint } from './bytes.ts'
import { crc32 } from './crc32.ts'
import type { ErrorName } from './errors.ts'
import { hasTrailer } from './gzip.ts'
import { fieldOf } from './lookup.ts'
import type { DigestAlgorithm, HeaderField, HeaderRole, Protocol, Side } from './protocol.ts'

/** A header field of a frame at hand. */
export interface FieldValue {
  /** Which one. */
  field: HeaderField
  /** Its bytes, as many as are there. */
  bytes: Uint8Array
  /** The number, for `uint` fields whose bytes are all there. */
  value: number | null
}

/** Something checked, and how it came out. */
export interface Verdict {
  /** What was checked. */
  what: 'head' | 'length' | 'kind' | 'encoding' | 'digest' | 'inflate'
  /** What is wrong with it. */
  fault: ErrorName | null
  /** What was expected, where a number or bytes say it. */
  expected: string | null
  /** What was found there. */
  found: string | null
}

/** A frame, or as much of it as there is. */
export interface Decoded {
  /** All that there was to look at. */
  bytes: Uint8Array
  /** The header. */
  fields: FieldValue[]
  /** The data as sent. */
  data: Uint8Array
  /** The data after decompression; `null` if that failed or never began. */
  plain: Uint8Array | null
  /** Bytes behind this frame. */
  rest: Uint8Array
  /** All that was checked, in order. */
  verdicts: Verdict[]
  /** The first fault. */
  fault: ErrorName | null
}

const same = (a: ArrayLike<number>, b: ArrayLike<number>) =>
  a.length === b.length && Array.prototype.every.call(a, (byte, index) => byte === b[index])

/** Unpacks one gzip member of at most `limit` bytes, and checks its end. */
function gunzip({ algorithms }: Codec, member: Uint8Array, limit: number): Uint8Array | GunzipFault {
  const plain = algorithms.gunzip(member, limit)
  if (typeof plain === 'string') return plain
  if (plain.length > limit) return 'inflated_too_long'
  return hasTrailer(member, plain) ? plain : 'bad_gzip'
}

/** What a digest's field holds of data. */
function digest({ protocol, algorithms }: Codec, algorithm: DigestAlgorithm | null, data: Uint8Array): Uint8Array {
  if (algorithm !== 'crc32') return algorithms.md5(data)
  const bytes = new Uint8Array(4)
  writeUint(bytes, crc32(data), protocol.byteOrder)
  return bytes
}

/** Takes the frame apart that begins with the first byte, as far as it goes. The order of the checks is the protocol's. */
export function decodeFrame(codec: Codec, bytes: Uint8Array): Decoded {
  const { protocol } = codec
  const fields = protocol.header.map((field): FieldValue => {
    const slice = bytes.subarray(field.offset, field.offset + field.size)
    const whole = slice.length === field.size
    return { field, bytes: slice, value: whole && field.type === 'uint' ? readUint(slice, protocol.byteOrder) : null }
  })
  const decoded: Decoded = {
    bytes,
    fields,
    data: new Uint8Array(),
    plain: null,
    rest: new Uint8Array(),
    verdicts: [],
    fault: null,
  }
  const valueOf = (role: HeaderRole) => headerValue(decoded, role) ?? 0
  const bytesOf = (role: HeaderRole) => fields.find(({ field }) => field.role === role)?.bytes ?? new Uint8Array()
  /** Notes a verdict; true if the frame goes on. */
  const check = (
    what: Verdict['what'],
    fault: ErrorName | null,
    expected: string | null = null,
    found: string | null = null,
  ) => {
    decoded.verdicts.push({ what, fault, expected, found })
    decoded.fault ??= fault
    return fault === null
  }

  const head = bytesOf('head')
  const heads = [protocol.requestHead, protocol.responseHead]
  const opens = heads.some((candidate) => same(candidate.slice(0, head.length), head))
  if (!check('head', opens ? null : 'bad_head')) return decoded
  const lengthField = fieldOf(protocol, 'total_length')
  if (bytes.length < lengthField.offset + lengthField.size) {
    check('length', 'truncated', `≥ ${protocol.headerLength}`, String(bytes.length))
    return decoded
  }
  const total = valueOf('total_length')
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

  const kindValue = valueOf('kind')
  const kind = protocol.kinds.find(({ value }) => value === kindValue)
  if (!check('kind', !kind ? 'unknown_kind' : kind.role === 'reserved' ? 'reserved_kind' : null)) return decoded
  const encodingValue = headerValue(decoded, 'encoding')
  const encoding = protocol.encodings.find(({ value }) => value === encodingValue)
  if (encodingValue !== null && !check('encoding', encoding ? null : 'unknown_encoding')) return decoded
  const digestField = fields.find(({ field }) => field.role === 'digest')
  if (digestField) {
    const expected = digest(codec, digestField.field.algorithm, decoded.data)
    const sent = digestField.bytes
    const spell = (bytes: Uint8Array) => Array.from(bytes, hexByte).join('').toLowerCase()
    if (!check('digest', same(expected, sent) ? null : 'bad_digest', spell(expected), spell(sent))) return decoded
  }

  const plainLength = headerValue(decoded, 'plain_length') ?? decoded.data.length
  if (encoding?.role !== 'gzip') {
    const zeroWhenPlain = protocol.header.some((field) => field.role === 'plain_length' && field.zeroWhenPlain)
    const zero = plainLength === 0 && zeroWhenPlain
    const fits = plainLength === decoded.data.length || zero
    check('inflate', fits ? null : 'plain_length_mismatch', String(decoded.data.length), String(plainLength))
    if (fits) decoded.plain = decoded.data
    return decoded
  }
  if (plainLength > protocol.limits.inflatedBytes) {
    check('inflate', 'inflated_too_long', `≤ ${protocol.limits.inflatedBytes}`, String(plainLength))
    return decoded
  }
  const plain = gunzip(codec, decoded.data, protocol.limits.inflatedBytes)
  if (plain === 'inflated_too_long') {
    // What is announced is within the limit.
    check('inflate', 'plain_length_mismatch', `> ${protocol.limits.inflatedBytes}`, String(plainLength))
    return decoded
  }
  if (typeof plain === 'string') {
    check('inflate', plain)
    return decoded
  }
  const fits = plain.length === plainLength
  check('inflate', fits ? null : 'plain_length_mismatch', String(plain.length), String(plainLength))
  if (fits) decoded.plain = plain
  return decoded
}

/** The number in the header field with a role; `null` where its bytes are not all there. */
export function headerValue(decoded: Decoded, role: HeaderRole): number | null {
  return decoded.fields.find(({ field }) => field.role === role)?.value ?? null
}

/** Which message the head opens; `null` if it is not a whole head. */
export function sideOf(protocol: Protocol, decoded: Decoded): Side | null {
  const bytes = decoded.fields.find(({ field }) => field.role === 'head')?.bytes
  const opens = (head: number[]) => bytes !== undefined && same(head, bytes)
  return opens(protocol.requestHead) ? 'request' : opens(protocol.responseHead) ? 'response' : null
}

/** What a frame to be made says of itself. */
export interface FrameParts {
  /** Whether it answers another one. */
  response: boolean
  /** Value of its kind. */
  kind: number
  /** Command code. */
  code: number
  /** Message id. */
  id: number
  /** Whether its data is to be compressed; it is not where the protocol has no encoding for that. */
  gzip: boolean
  /** The data, not compressed. */
  data: Uint8Array
}

/** Makes the frame. */
export function encodeFrame(codec: Codec, parts: FrameParts): Uint8Array {
  const { protocol, algorithms } = codec
  const packed = protocol.encodings.find(({ role }) => role === 'gzip')
  const gzip = parts.gzip && packed !== undefined
  const data = gzip ? algorithms.gzip(parts.data) : parts.data
  const frame = new Uint8Array(protocol.headerLength + data.length)
  frame.set(data, protocol.headerLength)
  const encoding = gzip ? packed : protocol.encodings.find(({ role }) => role === 'plain')
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
    else if (field.role === 'digest') target.set(digest(codec, field.algorithm, data))
    else if (field.type === 'uint')
      writeUint(target, (field.role && numbers[field.role]) ?? field.value, protocol.byteOrder)
  }
  return frame
}
