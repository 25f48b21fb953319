// Decodes and encodes frames as named fields. The layout comes from the generated protocol. `Framing` checks and seals
// frames, as it does for connections. Here each check is listed with the values that it compared.

import type { Codec } from './algorithms.ts'
import { readUint, writeUint } from './bytes.ts'
import { crc32 } from './crc32.ts'
import type { ErrorName } from './errors.ts'
import { Framing, hexOf } from './framing.ts'
import type { WholeFrame } from './framing.ts'
import type { HeaderField, HeaderRole, Protocol, Side } from './protocol.ts'

/** A header field with its value. */
export interface FieldValue {
  /** The field. */
  field: HeaderField
  /** Its bytes, as far as present. */
  bytes: Uint8Array
  /** The number, for complete `uint` fields. */
  value: number | null
}

/** A check with its result. */
export interface Verdict {
  /** The part that was checked. */
  what: 'head' | 'length' | 'kind' | 'encoding' | 'digest' | 'inflate'
  /** The error found; `null` for none. */
  fault: ErrorName | null
  /** The expected number or bytes; `null` where neither applies. */
  expected: string | null
  /** The number or bytes found. */
  found: string | null
}

/** A decoded frame, complete or not. */
export interface Decoded {
  /** The bytes to decode. */
  bytes: Uint8Array
  /** The header. */
  fields: FieldValue[]
  /** The data as sent. */
  data: Uint8Array
  /** The data after decompression; `null` if decompression failed or did not start. */
  plain: Uint8Array | null
  /** Bytes after this frame. */
  rest: Uint8Array
  /** The checks, in order. */
  verdicts: Verdict[]
  /** The first error; `null` for none. */
  fault: ErrorName | null
}

const same = (a: ArrayLike<number>, b: ArrayLike<number>) =>
  a.length === b.length && Array.prototype.every.call(a, (byte, index) => byte === b[index])

/** Returns a framing that accepts any compression ratio, as the golden frames need it. */
function framingOf({ protocol, algorithms }: Codec): Framing {
  const { frameBytes, inflatedBytes } = protocol.limits
  return new Framing(protocol, { frameBytes, inflatedBytes }, algorithms)
}

/** Decodes the frame at the start of `bytes`, as far as possible. The order of the checks is the protocol's. */
export function decodeFrame(codec: Codec, bytes: Uint8Array): Decoded {
  const { protocol } = codec
  const framing = framingOf(codec)
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
  /** Adds a check, unless one has failed before. */
  const check = (what: Verdict['what'], fault: ErrorName | null, [expected, found]: Compared = [null, null]) => {
    if (decoded.fault !== null) return
    decoded.verdicts.push({ what, fault, expected, found })
    decoded.fault = fault
  }

  const { headerLength, limits } = protocol
  const begins = framing.begins(bytes)
  check('head', begins === 'bad_head' ? begins : null)
  if (typeof begins !== 'number') {
    const total = String(headerValue(decoded, 'total_length'))
    if (begins === null) check('length', 'truncated', [`≥ ${headerLength}`, String(bytes.length)])
    else check('length', begins, [begins === 'short_frame' ? `≥ ${headerLength}` : `≤ ${limits.frameBytes}`, total])
    return decoded
  }
  decoded.data = bytes.subarray(headerLength, begins)
  check('length', bytes.length < begins ? 'truncated' : null, [String(begins), String(bytes.length)])
  if (decoded.fault !== null) return decoded
  decoded.rest = bytes.subarray(begins)

  // A codec's algorithms are synchronous, so the framing is as well.
  const { data, fault } = framing.open(bytes.subarray(0, begins)) as WholeFrame
  decoded.plain = data
  const among = (...names: ErrorName[]): ErrorName | null => names.find((name) => name === fault) ?? null
  check('kind', among('unknown_kind', 'reserved_kind'))
  if (fieldIn(decoded, 'encoding')) check('encoding', among('unknown_encoding'))
  const digest = fieldIn(decoded, 'digest')
  if (digest) check('digest', among('bad_digest'), digests(codec, digest, decoded.data))
  if (decoded.fault === null) check('inflate', fault as ErrorName | null, lengths(codec, decoded, fault))
  return decoded
}

type Compared = readonly [expected: string | null, found: string | null]

/** Returns the digest of the data and the digest sent. */
function digests({ protocol, algorithms }: Codec, sent: FieldValue, data: Uint8Array): Compared {
  if (sent.field.algorithm !== 'crc32') return [hexOf(algorithms.md5(data)), hexOf(sent.bytes)]
  const expected = new Uint8Array(4)
  writeUint(expected, crc32(data), protocol.byteOrder)
  return [hexOf(expected), hexOf(sent.bytes)]
}

/** Returns the length of the data before compression and the length in the header. */
function lengths({ protocol, algorithms }: Codec, decoded: Decoded, fault: WholeFrame['fault']): Compared {
  const { inflatedBytes } = protocol.limits
  const found = String(headerValue(decoded, 'plain_length') ?? decoded.data.length)
  if (fault === 'bad_gzip') return [null, null]
  if (fault === 'inflated_too_long') return [`≤ ${inflatedBytes}`, found]
  const encoding = headerValue(decoded, 'encoding')
  const isPacked = protocol.encodings.some(({ value, role }) => role === 'gzip' && value === encoding)
  if (!isPacked) return [String(decoded.data.length), found]
  const plain = decoded.plain ?? algorithms.gunzip(decoded.data, inflatedBytes)
  return [typeof plain === 'string' ? `> ${inflatedBytes}` : String(plain.length), found]
}

const fieldIn = (decoded: Decoded, role: HeaderRole): FieldValue | undefined =>
  decoded.fields.find(({ field }) => field.role === role)

/** Returns the number in the header field with a role; `null` if it is incomplete. */
export function headerValue(decoded: Decoded, role: HeaderRole): number | null {
  return fieldIn(decoded, role)?.value ?? null
}

/** Returns the message that the head belongs to; `null` if the head is incomplete. */
export function sideOf(protocol: Protocol, decoded: Decoded): Side | null {
  const bytes = fieldIn(decoded, 'head')?.bytes
  const opens = (head: readonly number[]) => bytes !== undefined && same(head, bytes)
  return opens(protocol.requestHead) ? 'request' : opens(protocol.responseHead) ? 'response' : null
}

/** The parts of a frame to encode. */
export interface FrameParts {
  /** `true` for a response or an acknowledgement. */
  response: boolean
  /** Value of its kind. */
  kind: number
  /** Command code. */
  code: number
  /** Message id. */
  id: number
  /** Compresses the data. Ignored where the protocol has no gzip encoding. */
  gzip: boolean
  /** The data, not compressed. */
  data: Uint8Array
}

/** Encodes a frame. */
export function encodeFrame(codec: Codec, { gzip, data, ...id }: FrameParts): Uint8Array {
  const framing = framingOf(codec)
  return gzip && framing.gzip !== null
    ? framing.seal(id, codec.algorithms.gzip(data), data.length, framing.gzip)
    : framing.seal(id, data, data.length, framing.plain)
}
