// Splits a stream of bytes into frames, for any split of the bytes.

import type { ErrorName } from './errors.ts'
import type { Framing, WholeFrame } from './framing.ts'
import type { Soon } from './platform.ts'

/** One item of a stream: a frame, or the error that ends it. */
export type FromStream = WholeFrame | FatalFault

/** An error after which the next frame cannot be found: the connection must be closed. */
export interface FatalFault {
  /** The error. */
  readonly fatal: ErrorName
}

/**
 * Gathers received bytes and returns whole frames. Memory use follows the received bytes, not the length in a header.
 */
export class FrameStream {
  private readonly framing: Framing
  private chunks: Uint8Array[] = []
  private held = 0
  private fatal: ErrorName | null = null
  /** Length of the frame that has begun; `null` until its header is complete. */
  private total: number | null = null

  /** Creates an empty stream. */
  constructor(framing: Framing) {
    this.framing = framing
  }

  /** Number of bytes of the frame that has begun; 0 between two frames. */
  get pending(): number {
    return this.held
  }

  /**
   * Length of the frame that has begun, in bytes and with header. Until the length is known, the length of a header.
   */
  get expected(): number {
    return this.total ?? this.framing.headerLength
  }

  /** `true` if the received bytes end inside a header. */
  get isInsideHeader(): boolean {
    return this.held > 0 && this.held < this.framing.headerLength
  }

  /** Adds received bytes. They must not change afterwards. */
  push(bytes: Uint8Array): void {
    if (bytes.length === 0 || this.fatal !== null) return
    this.chunks.push(bytes)
    this.held += bytes.length
  }

  /** Returns the next frame; `null` until more bytes arrive. */
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

  /** Ends the stream. Returns an error if it ended inside a frame. */
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

  /** Returns the first bytes, at least `length` if available, without taking them. */
  private start(length: number): Uint8Array {
    const first = this.chunks[0]
    if (first && first.length >= length) return first
    return joined(this.chunks, Math.min(length, this.held))
  }

  /** Takes the first `length` bytes. The caller checks that there are enough. */
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

/** Joins the first bytes of several chunks. */
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
