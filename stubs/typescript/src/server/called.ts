// The context of a call that a handler receives.

import type { Refusal } from '../refusal.ts'
import type { FrameId } from '../session.ts'
import type { ConnectionId, Context } from './types.ts'

/** A call. Its signal is created on first use: few handlers need it, and it costs as much as reading a request. */
export class Called implements Context {
  /** Address of the app. */
  readonly peer: string
  /** Connection of the app. */
  readonly connection: ConnectionId
  /** Message id of the request. */
  readonly id: number
  /** Command code of the request. */
  readonly code: number
  /** Time the request was made, in milliseconds since 1970; `null` if it carries no time. */
  readonly time: number | null
  /** When the request came, in milliseconds of the monotonic clock. */
  readonly since: number
  private readonly refusal: () => Refusal
  private controller: AbortController | null = null
  private isAbandoned = false

  /** Creates the context of a call over a connection. */
  constructor(
    peer: string,
    connection: ConnectionId,
    { id, code }: FrameId,
    time: number | null,
    since: number,
    refusal: () => Refusal,
  ) {
    this.peer = peer
    this.connection = connection
    this.id = id
    this.code = code
    this.time = time
    this.since = since
    this.refusal = refusal
  }

  /** Aborts when the response is no longer awaited. */
  get signal(): AbortSignal {
    if (this.controller === null) {
      this.controller = new AbortController()
      if (this.isAbandoned) this.controller.abort()
    }
    return this.controller.signal
  }

  /** Returns the refusal of a command that this robot does not implement. */
  notImplemented(): Refusal {
    return this.refusal()
  }

  /** Notes that the response is no longer awaited. */
  abandon(): void {
    this.isAbandoned = true
    this.controller?.abort()
  }
}
