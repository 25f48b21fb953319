// Receivers of one stream each, with a queue of their own.

import { Change } from '../alarm.ts'
import type { Loss } from '../loss.ts'
import { DataError } from './error.ts'
import type { Life } from './life.ts'

/** Frames waiting for one receiver. */
const QUEUE = 4

/** A frame of raw bytes. */
export interface StreamFrame {
  /** Command code of what the bytes belong to. */
  readonly code: number
  /** Message id of the request that asked for them. */
  readonly id: number
  /** The bytes, not compressed. */
  readonly data: Uint8Array
}

/** A frame of a stream, read. */
export interface StreamItem<Content> {
  /** Message id, that of the request which it belongs to. */
  readonly id: number
  /** What it carries. */
  readonly content: Content
}

/** What waits for one receiver. */
export interface Taker {
  /** The code of its stream. */
  readonly code: number | null
  /** What waits. */
  readonly waiting: (StreamFrame | DataError)[]
  /** Frames that have made way. */
  missed: number
}

/** The queues of all receivers of a data connection. */
export class Takers {
  /** Something has come. */
  readonly changed: Change = new Change()
  private readonly all = new Set<Taker>()
  private skipped = 0

  /** One more. */
  enter(code: number | null): Taker {
    const taker: Taker = { code, waiting: [], missed: 0 }
    this.all.add(taker)
    return taker
  }

  /** It takes no more. */
  leave(taker: Taker): void {
    this.all.delete(taker)
    this.changed.tell()
  }

  /** Whether it still takes frames. */
  has(taker: Taker): boolean {
    return this.all.has(taker)
  }

  /** Whether there is none. */
  get isEmpty(): boolean {
    return this.all.size === 0
  }

  /** Tells all to look again. */
  tell(): void {
    this.changed.tell()
  }

  /** A frame was dropped to which nobody had subscribed. */
  skip(): void {
    this.skipped++
  }

  /** How many there were since this was last asked. */
  takeSkipped(): number {
    const { skipped } = this
    this.skipped = 0
    return skipped
  }

  /** Hands out what has arrived; `false` if nobody takes such frames. */
  offer(code: number, arrived: StreamFrame | DataError): boolean {
    const isOfStream = !(arrived instanceof DataError) || arrived.kind === 'frame'
    const takers = [...this.all].filter((taker) => isOfStream && taker.code === code)
    for (const taker of takers) put(taker, arrived)
    if (takers.length > 0) this.changed.tell()
    return takers.length > 0
  }

  /** Notes for everybody that frames may be missing here. */
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
 * The frames of one stream from its creation on, each read as its type, for `for await`. While its queue of four frames is full,
 * the oldest makes way for the one that arrives. A `DataError` other than `closed` says that frames are missing here, and ends a
 * `for await`; `next` may be called again and goes on. It ends with its data connection, and with a `for await` that is left.
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

  /** The next frame. Rejects with a `DataError`. */
  async next(): Promise<IteratorResult<StreamItem<Content>, undefined>> {
    for (;;) {
      const first = this.taker.waiting.shift()
      if (first instanceof DataError) throw first
      if (first) return { done: false, value: { id: first.id, content: this.read(first) } }
      if (this.life.now.is === 'closed' || !this.takers.has(this.taker)) return { done: true, value: undefined }
      await this.takers.changed.wait()
    }
  }

  /** How many frames have made way for later ones since this was last asked. */
  missed(): number {
    const { missed } = this.taker
    this.taker.missed = 0
    return missed
  }

  /** Takes no more. */
  close(): void {
    this.takers.leave(this.taker)
  }

  /** Takes no more. */
  return(): Promise<IteratorResult<StreamItem<Content>, undefined>> {
    this.close()
    return Promise.resolve({ done: true, value: undefined })
  }

  /** Itself. */
  [Symbol.asyncIterator](): this {
    return this
  }
}
