// A stream of bytes as frames, however it is split on its way.

import type { Codec } from './algorithms.ts'
import { hexByte } from './bytes.ts'
import { decodeFrame, headerValue, sideOf } from './frame.ts'
import type { ErrorName } from './errors.ts'
import { fieldOf } from './lookup.ts'
import type { FrameId } from './session.ts'

/** A whole frame. */
export interface WholeFrame {
  /** What it is about. */
  id: FrameId
  /** The digest as sent, in hex; `null` where the header has none. */
  digest: string | null
  /** Its data, not compressed; `null` if it cannot be read. */
  data: Uint8Array | null
  /** What is wrong with it; the frame behind it can still be read. */
  fault: ErrorName | null
}

/** What comes out of a stream: a frame, or why there will be none any more. */
export type FromStream = WholeFrame | FatalFault

/** The place of the next frame is lost: the connection has to be closed. */
export interface FatalFault {
  /** What is wrong. */
  fatal: ErrorName
}

/** Faults behind which nobody knows where the next frame begins. */
const FATAL: readonly ErrorName[] = ['bad_head', 'short_frame', 'frame_too_long']

/** Gathers what arrives, and gives whole frames. It holds no more than has come, whatever a frame says of its length. */
export class FrameStream {
  private readonly codec: Codec
  private readonly head: number
  private chunks: Uint8Array[] = []
  private held = 0
  private fatal: ErrorName | null = null

  /** A stream from which nothing has come. */
  constructor(codec: Codec) {
    const length = fieldOf(codec.protocol, 'total_length')
    this.codec = codec
    this.head = length.offset + length.size
  }

  /** Bytes of a frame that has begun; 0 between two frames. */
  get pending(): number {
    return this.held
  }

  /** Adds bytes that have arrived. They must not change afterwards. */
  push(bytes: Uint8Array): void {
    if (bytes.length === 0 || this.fatal !== null) return
    this.chunks.push(bytes)
    this.held += bytes.length
  }

  /** The next frame; `null` until more arrives. */
  next(): FromStream | null {
    if (this.fatal !== null) return { fatal: this.fatal }
    if (this.held === 0) return null
    const start = this.start(this.head)
    const judged = decodeFrame(this.codec, start)
    // What else is wrong is asked of the whole frame: where a header ends with its length, more has been looked at.
    if (judged.fault !== null && FATAL.includes(judged.fault)) return this.lose(judged.fault)
    if (start.length < this.head) return null
    const total = headerValue(judged, 'total_length') ?? 0
    if (this.held < total) return null
    return this.whole(this.take(total))
  }

  /** The stream has ended: what is wrong if that was inside a frame. */
  end(): FatalFault | null {
    if (this.fatal !== null) return { fatal: this.fatal }
    return this.held === 0 ? null : this.lose('truncated')
  }

  private lose(fatal: ErrorName): FatalFault {
    this.fatal = fatal
    this.chunks = []
    this.held = 0
    return { fatal }
  }

  private whole(bytes: Uint8Array): WholeFrame {
    const decoded = decodeFrame(this.codec, bytes)
    const number = (role: 'kind' | 'code' | 'id') => headerValue(decoded, role) ?? 0
    const digest = decoded.fields.find(({ field }) => field.role === 'digest')
    return {
      id: {
        response: sideOf(this.codec.protocol, decoded) === 'response',
        kind: number('kind'),
        code: number('code'),
        id: number('id'),
      },
      digest: digest ? readDigest(digest.bytes) : null,
      data: decoded.plain,
      fault: decoded.fault,
    }
  }

  /** The first bytes, at most so many, of which none is taken. */
  private start(length: number): Uint8Array {
    const first = this.chunks[0]
    if (first && first.length >= length) return first.subarray(0, length)
    return joined(this.chunks, Math.min(length, this.held))
  }

  /** Takes the first bytes, of which there are enough. */
  private take(length: number): Uint8Array {
    const [first, ...others] = this.chunks
    const all = first && others.length === 0 ? first : joined(this.chunks, this.held)
    this.held -= length
    this.chunks = this.held === 0 ? [] : [all.subarray(length)]
    return all.subarray(0, length)
  }
}

const readDigest = (bytes: Uint8Array): string =>
  Array.from(bytes, hexByte).join('').toLowerCase()

/** The first bytes of several chunks as one. */
function joined(chunks: readonly Uint8Array[], length: number): Uint8Array {
  const all = new Uint8Array(length)
  let at = 0
  for (const chunk of chunks) {
    if (at >= length) break
    const part = chunk.subarray(0, length - at)
    all.set(part, at)
    at += part.length
  }
  return all
}
