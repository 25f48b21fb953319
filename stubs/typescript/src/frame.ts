// Frames: bytes to named fields and back. The layout comes from the generated protocol. `Framing` checks and seals
// frames for connections as well as here, where each check is listed with what it compared.

import type { Codec } from './algorithms.ts'
import { readUint, writeUint } from './bytes.ts'
import { crc32 } from './crc32.ts'
import type { ErrorName } from './errors.ts'
import { Framing, hexOf } from './framing.ts'
import type { WholeFrame } from './framing.ts'
import type { HeaderField, HeaderRole, Protocol, Side } from './protocol.ts'

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

/** Frames of any ratio of compression, as the golden frames have them. */
function framingOf({ protocol, algorithms }: Codec): Framing {
  const { frameBytes, inflatedBytes } = protocol.limits
  return new Framing(protocol, { frameBytes, inflatedBytes }, algorithms)
}

/** Takes the frame apart that begins with the first byte, as far as it goes. The order of the checks is the protocol's. */
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
  /** Notes a check, unless one has failed before. */
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

  // The algorithms of a codec answer at once, and so does the framing.
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

/** The digest of the data, and the one that was sent. */
function digests({ protocol, algorithms }: Codec, sent: FieldValue, data: Uint8Array): Compared {
  if (sent.field.algorithm !== 'crc32') return [hexOf(algorithms.md5(data)), hexOf(sent.bytes)]
  const expected = new Uint8Array(4)
  writeUint(expected, crc32(data), protocol.byteOrder)
  return [hexOf(expected), hexOf(sent.bytes)]
}

/** The length of the data before compression, and the length in the header. */
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

/** The number in the header field with a role; `null` where its bytes are not all there. */
export function headerValue(decoded: Decoded, role: HeaderRole): number | null {
  return fieldIn(decoded, role)?.value ?? null
}

/** Which message the head opens; `null` if it is not a whole head. */
export function sideOf(protocol: Protocol, decoded: Decoded): Side | null {
  const bytes = fieldIn(decoded, 'head')?.bytes
  const opens = (head: readonly number[]) => bytes !== undefined && same(head, bytes)
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
export function encodeFrame(codec: Codec, { gzip, data, ...id }: FrameParts): Uint8Array {
  const framing = framingOf(codec)
  return gzip && framing.gzip !== null
    ? framing.seal(id, codec.algorithms.gzip(data), data.length, framing.gzip)
    : framing.seal(id, data, data.length, framing.plain)
}
