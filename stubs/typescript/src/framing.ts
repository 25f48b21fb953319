// Frames of a protocol, for a connection: each header is read once, and only requested details are kept.

import { hexByte } from './bytes.ts'
import { crc32 } from './crc32.ts'
import type { ErrorName } from './errors.ts'
import type { OwnLimit } from './fault.ts'
import { hasTrailer } from './gzip.ts'
import type { PlatformAlgorithms, Soon } from './platform.ts'
import type { HeaderRole } from './protocol.ts'
import { room } from './room.ts'
import type { FrameId } from './session.ts'
import { integer } from './settings.ts'
import type { Check } from './settings.ts'
import type { FrameLayout, WireField } from './wire.ts'

/** Up to this many plain bytes, any compression ratio is allowed, for example for a grid of zeros. */
const INFLATE_FREE = 2 ** 20

/** Limits of a frame. */
export interface FrameLimits {
  /** Longest frame, header included, in bytes. */
  readonly frameBytes: number
  /** Longest data after decompression, in bytes. */
  readonly inflatedBytes: number
  /** Most plain bytes per byte of compressed JSON, for more than 1 MiB of plain bytes; absent for no limit. */
  readonly inflateRatio?: number
}

/** A whole frame. */
export interface WholeFrame {
  /** Kind, code and id of the frame. */
  readonly id: FrameId
  /** The digest of a report in hex, as sent; `null` for other frames and for headers without a digest. */
  readonly digest: string | null
  /** Its data, not compressed; `null` if it cannot be read. */
  readonly data: Uint8Array | null
  /** Bytes of its data as sent. */
  readonly sent: number
  /** The error in the frame; `null` for none. The next frame can still be read. */
  readonly fault: ErrorName | OwnLimit | null
}

/** Length of the frame that begins here, header included; or an error after which the next frame cannot be found. */
export type Beginning = number | 'bad_head' | 'short_frame' | 'frame_too_long'

/** Encodes and decodes frames of a layout. */
export class Framing {
  /** Number of bytes after which the frame's length is known. */
  readonly headEnd: number
  /** Bytes of the header. */
  readonly headerLength: number
  /** The largest message id. */
  readonly idMax: number
  /** The longest frame. */
  readonly frameBytes: number
  /** The encoding of data that is not compressed. */
  readonly plain: number
  /** The encoding of compressed data; `null` if the protocol has none. */
  readonly gzip: number | null
  /** `true` if a stream of these frames searches for the next frame after invalid bytes. */
  readonly resync: boolean
  private readonly layout: FrameLayout
  private readonly limits: FrameLimits
  private readonly algorithms: PlatformAlgorithms
  private readonly verifies: boolean
  private readonly fields: Partial<Record<HeaderRole, WireField>> = {}
  private readonly fixed: readonly WireField[]
  private readonly code: Check
  private readonly id: Check
  private readonly reports: number
  private readonly roles: ReadonlyMap<number, string>

  /** Creates a framing with limits. */
  constructor(
    layout: FrameLayout,
    limits: FrameLimits,
    algorithms: PlatformAlgorithms,
    verifyDigest: boolean = true,
    resync: boolean = false,
  ) {
    this.layout = layout
    this.limits = limits
    this.algorithms = algorithms
    this.verifies = verifyDigest
    this.resync = resync
    for (const field of layout.header) if (field.role !== null) this.fields[field.role] = field
    this.fixed = layout.header.filter(
      ({ role, value, type }) => (role === null || role === 'status') && value !== 0 && type === 'uint',
    )
    const total = this.need('total_length')
    this.headEnd = total.offset + total.size
    this.headerLength = layout.headerLength
    this.idMax = 2 ** (8 * Math.min(4, this.need('id').size)) - 1
    this.code = roomOf(this.need('code'))
    this.id = roomOf(this.need('id'))
    this.frameBytes = limits.frameBytes
    this.plain = layout.encodings.find(({ role }) => role === 'plain')?.value ?? 0
    this.gzip = layout.encodings.find(({ role }) => role === 'gzip')?.value ?? null
    this.roles = new Map(layout.kinds.map(({ value, role }) => [value, role]))
    this.reports = this.kind('report')
  }

  private need(role: HeaderRole): WireField {
    const field = this.fields[role]
    if (!field) throw new Error(`the protocol has no header field with role ${role}`)
    return field
  }

  /** Returns the kind of frames with this role. */
  kind(role: 'stream' | 'command' | 'report'): number {
    return this.layout.kinds.find((kind) => kind.role === role)?.value ?? 0
  }

  /** Throws a `TypeError` or `RangeError` for a command code that does not fit the header. */
  checkCode(code: number): void {
    this.code('code', code)
  }

  /** Throws a `TypeError` or `RangeError` for a message id that does not fit the header. */
  checkId(id: number): void {
    this.id('id', id)
  }

  /** Encodes a frame. Compresses data of at least `from` bytes, if the protocol can and the result is shorter. */
  encode(id: FrameId, data: Uint8Array, from: number | null): Soon<Uint8Array> {
    if (from === null || this.gzip === null || data.length < from) return this.seal(id, data, data.length, this.plain)
    const { gzip } = this
    const packed = this.algorithms.gzip(data)
    const sealed = (member: Uint8Array): Uint8Array =>
      member.length < data.length
        ? this.seal(id, member, data.length, gzip)
        : this.seal(id, data, data.length, this.plain)
    if (!(packed instanceof Promise)) return sealed(packed)
    // If the platform fails to compress, the data is sent uncompressed.
    return packed.then(sealed, () => this.seal(id, data, data.length, this.plain))
  }

  /** Returns `true` if the data fits into a frame. */
  fits(data: Uint8Array): boolean {
    return this.headerLength + data.length <= this.frameBytes
  }

  /** Makes a frame from data that is already in its encoding. */
  seal(id: FrameId, sent: Uint8Array, plainLength: number, encoding: number): Uint8Array {
    const { layout, fields } = this
    const frame = room(this.headerLength + sent.length)
    frame.fill(0, 0, this.headerLength)
    const head = fields.head
    if (head) frame.set(id.response ? layout.responseHead : layout.requestHead, head.offset)
    this.write(frame, fields.kind, id.kind)
    this.write(frame, fields.code, id.code)
    this.write(frame, fields.id, id.id)
    this.write(frame, fields.encoding, encoding)
    this.write(frame, fields.total_length, frame.length)
    this.write(frame, fields.plain_length, plainLength)
    for (const field of this.fixed) this.write(frame, field, field.value)
    frame.set(sent, this.headerLength)
    const { digest } = fields
    if (digest) {
      if (digest.algorithm === 'crc32') this.write(frame, digest, crc32(sent))
      else frame.set(this.algorithms.md5(sent), digest.offset)
    }
    return frame
  }

  private write(frame: Uint8Array, field: WireField | undefined, value: number): void {
    if (!field) return
    const big = this.layout.byteOrder === 'big'
    for (let at = 0; at < field.size; at++) {
      frame[big ? field.offset + field.size - 1 - at : field.offset + at] = value & 0xff
      value = Math.floor(value / 256)
    }
  }

  private read(frame: Uint8Array, field: WireField | undefined): number {
    if (!field) return 0
    const big = this.layout.byteOrder === 'big'
    let value = 0
    for (let at = 0; at < field.size; at++) {
      value = value * 256 + (frame[big ? field.offset + at : field.offset + field.size - 1 - at] ?? 0)
    }
    return value
  }

  private opens(bytes: Uint8Array, head: readonly number[], from = 0): boolean {
    const offset = from + (this.fields.head?.offset ?? 0)
    const length = Math.min(head.length, bytes.length - offset)
    for (let at = 0; at < length; at++) if (bytes[offset + at] !== head[at]) return false
    return true
  }

  /** Returns `true` if the bytes from a position on begin with a head, or are the beginning of one. */
  mayBegin(bytes: Uint8Array, at: number = 0): boolean {
    return this.opens(bytes, this.layout.requestHead, at) || this.opens(bytes, this.layout.responseHead, at)
  }

  /** Reads the length from the first bytes of a frame; `null` until the length is complete. */
  begins(bytes: Uint8Array): Beginning | null {
    if (!this.mayBegin(bytes)) return 'bad_head'
    if (bytes.length < this.headEnd) return null
    const total = this.read(bytes, this.fields.total_length)
    if (total < this.headerLength) return 'short_frame'
    return total > this.frameBytes ? 'frame_too_long' : total
  }

  /** Decodes a whole frame, with all checks in the order of the protocol. */
  open(bytes: Uint8Array): Soon<WholeFrame> {
    const { fields, layout } = this
    const id: FrameId = {
      response: this.opens(bytes, layout.responseHead) && !this.opens(bytes, layout.requestHead),
      kind: this.read(bytes, fields.kind),
      code: this.read(bytes, fields.code),
      id: this.read(bytes, fields.id),
    }
    const data = bytes.subarray(this.headerLength)
    // Only reports need their digest later.
    const digest =
      fields.digest && id.kind === this.reports
        ? hexOf(bytes.subarray(fields.digest.offset, fields.digest.offset + fields.digest.size))
        : null
    const bad = (fault: ErrorName | OwnLimit): WholeFrame => ({ id, digest, data: null, sent: data.length, fault })
    const role = this.roles.get(id.kind)
    if (role === undefined) return bad('unknown_kind')
    if (role === 'reserved') return bad('reserved_kind')
    const encoding = fields.encoding ? this.read(bytes, fields.encoding) : this.plain
    if (fields.encoding && encoding !== this.plain && encoding !== this.gzip) return bad('unknown_encoding')
    if (this.verifies && !this.hasDigest(bytes, data)) return bad('bad_digest')
    const plainLength = fields.plain_length ? this.read(bytes, fields.plain_length) : data.length
    if (encoding !== this.gzip || !fields.encoding) {
      const zero = plainLength === 0 && fields.plain_length?.zeroWhenPlain === true
      return plainLength === data.length || zero
        ? { id, digest, data, sent: data.length, fault: null }
        : bad('plain_length_mismatch')
    }
    const { inflatedBytes, inflateRatio } = this.limits
    if (plainLength > inflatedBytes) return bad('inflated_too_long')
    const most =
      role === 'stream' || inflateRatio === undefined
        ? inflatedBytes
        : Math.max(INFLATE_FREE, data.length * inflateRatio)
    if (plainLength > most) return bad('inflates_too_much')
    const judge = (plain: Uint8Array | ErrorName): WholeFrame => {
      // The limit is the header's plain length, so the data is longer than that.
      if (plain === 'inflated_too_long') return bad('plain_length_mismatch')
      if (typeof plain === 'string') return bad(plain)
      if (!hasTrailer(data, plain)) return bad('bad_gzip')
      return plain.length === plainLength
        ? { id, digest, data: plain, sent: data.length, fault: null }
        : bad('plain_length_mismatch')
    }
    const plain = this.algorithms.gunzip(data, plainLength)
    return plain instanceof Promise ? plain.then(judge) : judge(plain)
  }

  private hasDigest(bytes: Uint8Array, data: Uint8Array): boolean {
    const { digest } = this.fields
    if (!digest) return true
    if (digest.algorithm === 'crc32') return this.read(bytes, digest) === crc32(data)
    const expected = this.algorithms.md5(data)
    for (let at = 0; at < digest.size; at++) if (bytes[digest.offset + at] !== expected[at]) return false
    return true
  }
}

/** Returns the check for the value of a header field. */
const roomOf = ({ size }: WireField): Check => integer(0, Math.min(2 ** (8 * size) - 1, Number.MAX_SAFE_INTEGER))

const HEX = Array.from({ length: 256 }, (_, byte) => hexByte(byte).toLowerCase())

/** Returns bytes in hex. */
export function hexOf(bytes: Uint8Array): string {
  let text = ''
  for (const byte of bytes) text += HEX[byte] ?? ''
  return text
}
