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

/** A search ends the stream after this many times the longest frame. */
const SEARCH = 4

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
  /** `true` after bytes have been skipped, until the next frame. */
  private isSearching = false
  /** Bytes of unsuccessful candidates in this search. */
  private tried = 0

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

  /**
   * Returns the next frame; `null` until more bytes arrive. Await a promise before the next call. During a search, only
   * a frame without any error is returned.
   */
  next(): Soon<FromStream | null> {
    for (;;) {
      if (this.fatal !== null) return { fatal: this.fatal }
      if (this.held === 0) return null
      if (this.total === null) {
        const beginning = this.framing.begins(this.gather(this.framing.headEnd))
        if (typeof beginning === 'string') {
          if (!this.framing.resync) return this.lose(beginning)
          this.search()
          continue
        }
        if (beginning === null) return null
        this.total = beginning
      }
      if (this.held < this.total) return null
      const { total } = this
      this.total = null
      const frame = this.framing.open(this.gather(total).subarray(0, total))
      if (!this.isSearching) {
        this.drop(total)
        return frame
      }
      if (frame instanceof Promise) return frame.then((opened) => this.judge(opened, total) ?? this.next())
      const judged = this.judge(frame, total)
      if (judged) return judged
    }
  }

  /** Judges a frame that was found by a search. Returns `null` if the search continues. */
  private judge(frame: WholeFrame, total: number): FromStream | null {
    if (frame.fault === null) {
      this.isSearching = false
      this.tried = 0
      this.drop(total)
      return frame
    }
    this.tried += total
    if (this.tried > SEARCH * this.framing.frameBytes) return this.lose('bad_head')
    this.search()
    return null
  }

  /** Skips to the next position that may be a head. */
  private search(): void {
    this.isSearching = true
    const bytes = this.gather(this.held)
    let at = 1
    while (at < bytes.length && !this.framing.mayBegin(bytes, at)) at++
    this.drop(at)
  }

  /** Ends the stream. Returns an error if it ended inside a frame. */
  end(): FatalFault | null {
    if (this.fatal !== null) return { fatal: this.fatal }
    return this.held === 0 || this.isSearching ? null : this.lose('truncated')
  }

  private lose(fatal: ErrorName): FatalFault {
    this.fatal = fatal
    this.chunks = []
    this.held = 0
    return { fatal }
  }

  /** Joins chunks until the first one has `length` bytes, if available, and returns it. */
  private gather(length: number): Uint8Array {
    const first = this.chunks[0]
    if (first && (first.length >= length || this.chunks.length === 1)) return first
    const all = joined(this.chunks, this.held)
    this.chunks = [all]
    return all
  }

  /** Drops bytes of the first chunk. */
  private drop(length: number): void {
    const first = this.chunks[0]
    this.held -= length
    if (!first || first.length === length) this.chunks.shift()
    else this.chunks[0] = first.subarray(length)
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
