// Frames of a protocol, for a connection: a header is looked at once, and nothing is kept that nobody asks for.

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

/** Data of so many bytes or fewer may have been compressed by any ratio: a grid in which all is zero is no longer. */
const INFLATE_FREE = 2 ** 20

/** What bounds a frame. */
export interface FrameLimits {
  /** Longest frame, header included, in bytes. */
  readonly frameBytes: number
  /** Longest data after decompression, in bytes. */
  readonly inflatedBytes: number
  /** Most bytes that one byte of compressed JSON may become, where more than 1 MiB come out; absent for any. */
  readonly inflateRatio?: number
}

/** A whole frame. */
export interface WholeFrame {
  /** What it is about. */
  readonly id: FrameId
  /** The digest of a report as sent, in hex; `null` where the header has none, and for other frames. */
  readonly digest: string | null
  /** Its data, not compressed; `null` if it cannot be read. */
  readonly data: Uint8Array | null
  /** Bytes of its data as they were sent. */
  readonly sent: number
  /** What is wrong with it; the frame behind it can still be read. */
  readonly fault: ErrorName | OwnLimit | null
}

/** How long the frame is that begins here, header included; a fault behind which nobody knows where the next one begins. */
export type Beginning = number | 'bad_head' | 'short_frame' | 'frame_too_long'

/** Writes and reads frames as a layout says. */
export class Framing {
  /** Bytes from which on the length of a frame is known. */
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

  /** Frames of a layout, within limits. */
  constructor(layout: FrameLayout, limits: FrameLimits, algorithms: PlatformAlgorithms, verifyDigest: boolean = true) {
    this.layout = layout
    this.limits = limits
    this.algorithms = algorithms
    this.verifies = verifyDigest
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

  /** The kind of frames with this role. */
  kind(role: 'stream' | 'command' | 'report'): number {
    return this.layout.kinds.find((kind) => kind.role === role)?.value ?? 0
  }

  /** Throws a `TypeError` or `RangeError` for a command code that the header has no room for. */
  checkCode(code: number): void {
    this.code('code', code)
  }

  /** The same for a message id. */
  checkId(id: number): void {
    this.id('id', id)
  }

  /** Makes a frame. `from`: data of so many bytes or more is compressed, if the protocol can and it gets shorter. */
  encode(id: FrameId, data: Uint8Array, from: number | null): Soon<Uint8Array> {
    if (from === null || this.gzip === null || data.length < from) return this.seal(id, data, data.length, this.plain)
    const { gzip } = this
    const packed = this.algorithms.gzip(data)
    const sealed = (member: Uint8Array): Uint8Array =>
      member.length < data.length
        ? this.seal(id, member, data.length, gzip)
        : this.seal(id, data, data.length, this.plain)
    if (!(packed instanceof Promise)) return sealed(packed)
    // A platform that fails to compress does not prevent sending.
    return packed.then(sealed, () => this.seal(id, data, data.length, this.plain))
  }

  /** Whether data fits into a frame. */
  fits(data: Uint8Array): boolean {
    return this.headerLength + data.length <= this.frameBytes
  }

  /** Makes a frame of data in its encoding. */
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

  private opens(bytes: Uint8Array, head: readonly number[]): boolean {
    const offset = this.fields.head?.offset ?? 0
    const length = Math.min(head.length, bytes.length - offset)
    for (let at = 0; at < length; at++) if (bytes[offset + at] !== head[at]) return false
    return true
  }

  /** Looks at the first bytes of a frame; `null` while its length has not come. */
  begins(bytes: Uint8Array): Beginning | null {
    const { requestHead, responseHead } = this.layout
    if (!this.opens(bytes, requestHead) && !this.opens(bytes, responseHead)) return 'bad_head'
    if (bytes.length < this.headEnd) return null
    const total = this.read(bytes, this.fields.total_length)
    if (total < this.headerLength) return 'short_frame'
    return total > this.frameBytes ? 'frame_too_long' : total
  }

  /** Takes a whole frame apart, with all checks in the order of the protocol. */
  open(bytes: Uint8Array): Soon<WholeFrame> {
    const { fields, layout } = this
    const id: FrameId = {
      response: this.opens(bytes, layout.responseHead) && !this.opens(bytes, layout.requestHead),
      kind: this.read(bytes, fields.kind),
      code: this.read(bytes, fields.code),
      id: this.read(bytes, fields.id),
    }
    const data = bytes.subarray(this.headerLength)
    // Only reports are told apart by theirs.
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
      // More than is announced, whatever follows.
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

/** Checks the value of a field of the header. */
const roomOf = ({ size }: WireField): Check => integer(0, Math.min(2 ** (8 * size) - 1, Number.MAX_SAFE_INTEGER))

const HEX = Array.from({ length: 256 }, (_, byte) => hexByte(byte).toLowerCase())

/** Bytes in hex. */
export function hexOf(bytes: Uint8Array): string {
  let text = ''
  for (const byte of bytes) text += HEX[byte] ?? ''
  return text
}
