// Receivers of one stream each, with separate queues.

import { Change } from '../alarm.ts'
import type { Loss } from '../loss.ts'
import { DataError } from './error.ts'
import type { Life } from './life.ts'

/** Frames waiting for one receiver. */
const QUEUE = 4

/** A frame of raw bytes. */
export interface StreamFrame {
  /** Code of the command that the bytes belong to. */
  readonly code: number
  /** Message id of the request that asked for them. */
  readonly id: number
  /** The bytes, not compressed. */
  readonly data: Uint8Array
}

/** A decoded frame of a stream. */
export interface StreamItem<Content> {
  /** Message id of the request that it belongs to. */
  readonly id: number
  /** The content. */
  readonly content: Content
}

/** Frames waiting for one receiver. */
export interface Taker {
  /** The code of its stream. */
  readonly code: number | null
  /** Frames and errors that wait. */
  readonly waiting: (StreamFrame | DataError)[]
  /** Number of frames dropped for later ones. */
  missed: number
}

/** The queues of all receivers of a data connection. */
export class Takers {
  /** Fires when a frame or error has arrived. */
  readonly changed: Change = new Change()
  private readonly all = new Set<Taker>()
  private skipped = 0

  /** Adds a receiver. */
  enter(code: number | null): Taker {
    const taker: Taker = { code, waiting: [], missed: 0 }
    this.all.add(taker)
    return taker
  }

  /** Removes a receiver. */
  leave(taker: Taker): void {
    this.all.delete(taker)
    this.changed.tell()
  }

  /** Returns `true` if the receiver still takes frames. */
  has(taker: Taker): boolean {
    return this.all.has(taker)
  }

  /** `true` if there is no receiver. */
  get isEmpty(): boolean {
    return this.all.size === 0
  }

  /** Wakes all receivers. */
  tell(): void {
    this.changed.tell()
  }

  /** Counts a dropped frame without a subscription. */
  skip(): void {
    this.skipped++
  }

  /** Returns the number of such frames since the last call. */
  takeSkipped(): number {
    const { skipped } = this
    this.skipped = 0
    return skipped
  }

  /** Hands out a frame or an error. Returns `false` if no receiver takes such frames. */
  offer(code: number, arrived: StreamFrame | DataError): boolean {
    const isOfStream = !(arrived instanceof DataError) || arrived.kind === 'frame'
    const takers = [...this.all].filter((taker) => isOfStream && taker.code === code)
    for (const taker of takers) put(taker, arrived)
    if (takers.length > 0) this.changed.tell()
    return takers.length > 0
  }

  /** Notes for each receiver that frames may be missing here. */
  lost(loss: Loss): void {
    for (const taker of this.all) {
      const last = taker.waiting.at(-1)
      if (!(last instanceof DataError && last.kind === 'lost')) put(taker, new DataError('lost', { loss }))
    }
    this.changed.tell()
  }
}

function put(taker: Taker, arrived: StreamFrame | DataError): void {
  if (taker.waiting.length >= QUEUE) {
    const oldest = taker.waiting.findIndex((one) => !(one instanceof DataError))
    taker.waiting.splice(Math.max(0, oldest), 1)
    taker.missed++
  }
  taker.waiting.push(arrived)
}

/**
 * The decoded frames of one stream from its creation on, for `for await`. When its queue of four frames is full, the
 * newest frame replaces the oldest.
 *
 * A `DataError` other than `closed` means that frames are missing here. It ends a `for await`; a further call of `next`
 * continues. The subscription ends with its data connection, or when a `for await` is left.
 */
export class Subscription<Content> implements AsyncIterableIterator<StreamItem<Content>> {
  private readonly takers: Takers
  private readonly taker: Taker
  private readonly life: Life
  private readonly read: (frame: StreamFrame) => Content

  /**
   * Made by a data connection.
   *
   * @internal
   */
  constructor(takers: Takers, taker: Taker, life: Life, read: (frame: StreamFrame) => Content) {
    this.takers = takers
    this.taker = taker
    this.life = life
    this.read = read
  }

  /** Returns the next frame. Rejects with a `DataError`. */
  async next(): Promise<IteratorResult<StreamItem<Content>, undefined>> {
    for (;;) {
      const first = this.taker.waiting.shift()
      if (first instanceof DataError) throw first
      if (first) return { done: false, value: { id: first.id, content: this.read(first) } }
      if (this.life.now.is === 'closed' || !this.takers.has(this.taker)) return { done: true, value: undefined }
      await this.takers.changed.wait()
    }
  }

  /** Returns the number of frames dropped for later ones since the last call. */
  missed(): number {
    const { missed } = this.taker
    this.taker.missed = 0
    return missed
  }

  /** Ends receiving. */
  close(): void {
    this.takers.leave(this.taker)
  }

  /** Ends receiving. */
  return(): Promise<IteratorResult<StreamItem<Content>, undefined>> {
    this.close()
    return Promise.resolve({ done: true, value: undefined })
  }

  /** Returns itself. */
  [Symbol.asyncIterator](): this {
    return this
  }
}
