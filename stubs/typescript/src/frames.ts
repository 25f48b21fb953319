// A stream of bytes as frames, however it is split on its way.

import type { ErrorName } from './errors.ts'
import type { Framing, WholeFrame } from './framing.ts'
import type { Soon } from './platform.ts'

/** What comes out of a stream: a frame, or why there will be none any more. */
export type FromStream = WholeFrame | FatalFault

/** The place of the next frame is lost: the connection has to be closed. */
export interface FatalFault {
  /** What is wrong. */
  readonly fatal: ErrorName
}

/** Gathers what arrives, and gives whole frames. It holds no more than has come, whatever a frame says of its length. */
export class FrameStream {
  private readonly framing: Framing
  private chunks: Uint8Array[] = []
  private held = 0
  private fatal: ErrorName | null = null
  /** The length of the frame that has begun, as soon as it is known. */
  private total: number | null = null

  /** A stream from which nothing has come. */
  constructor(framing: Framing) {
    this.framing = framing
  }

  /** Bytes of a frame that has begun; 0 between two frames. */
  get pending(): number {
    return this.held
  }

  /** How long the frame is that has begun, header included; that of a header while it does not say. */
  get expected(): number {
    return this.total ?? this.framing.headerLength
  }

  /** Whether what has come ends inside a header. */
  get isInsideHeader(): boolean {
    return this.held > 0 && this.held < this.framing.headerLength
  }

  /** Adds bytes that have arrived. They must not change afterwards. */
  push(bytes: Uint8Array): void {
    if (bytes.length === 0 || this.fatal !== null) return
    this.chunks.push(bytes)
    this.held += bytes.length
  }

  /** The next frame; `null` until more arrives. */
  next(): Soon<FromStream> | null {
    if (this.fatal !== null) return { fatal: this.fatal }
    if (this.held === 0) return null
    if (this.total === null) {
      const beginning = this.framing.begins(this.start(this.framing.headEnd))
      if (typeof beginning === 'string') return this.lose(beginning)
      if (beginning === null) return null
      this.total = beginning
    }
    if (this.held < this.total) return null
    const bytes = this.take(this.total)
    this.total = null
    return this.framing.open(bytes)
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

  /** The first bytes, so many or more if there are, of which none is taken. */
  private start(length: number): Uint8Array {
    const first = this.chunks[0]
    if (first && first.length >= length) return first
    return joined(this.chunks, Math.min(length, this.held))
  }

  /** Takes the first bytes, of which there are enough. */
  private take(length: number): Uint8Array {
    const { chunks } = this
    const first = chunks[0]
    const all = first && chunks.length === 1 ? first : joined(chunks, this.held)
    this.held -= length
    if (this.held === 0) {
      this.chunks = []
      return all
    }
    this.chunks = [all.subarray(length)]
    return all.subarray(0, length)
  }
}

/** The first bytes of several chunks as one. */
export function joined(chunks: readonly Uint8Array[], length: number): Uint8Array {
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
