// What a handler is told of the call that it handles.

import type { Refusal } from '../refusal.ts'
import type { FrameId } from '../session.ts'
import type { ConnectionId, Context } from './types.ts'

/** A call. Its signal is made when somebody asks for it: few handlers do, and to make one costs as much as to read a request. */
export class Called implements Context {
  /** Address of the app. */
  readonly peer: string
  /** Connection of the app. */
  readonly connection: ConnectionId
  /** Message id of the request. */
  readonly id: number
  /** Command code of the request. */
  readonly code: number
  /** When the request was made, in milliseconds since 1970, if it says so. */
  readonly time: number | null
  private readonly refusal: () => Refusal
  private controller: AbortController | null = null
  private isAbandoned = false

  /** A call over a connection. */
  constructor(
    peer: string,
    connection: ConnectionId,
    { id, code }: FrameId,
    time: number | null,
    refusal: () => Refusal,
  ) {
    this.peer = peer
    this.connection = connection
    this.id = id
    this.code = code
    this.time = time
    this.refusal = refusal
  }

  /** Aborted when nobody waits for the answer any more. */
  get signal(): AbortSignal {
    if (this.controller === null) {
      this.controller = new AbortController()
      if (this.isAbandoned) this.controller.abort()
    }
    return this.controller.signal
  }

  /** The refusal of a command that this robot does not carry out. */
  notImplemented(): Refusal {
    return this.refusal()
  }

  /** Nobody waits for its answer any more. */
  abandon(): void {
    this.isAbandoned = true
    this.controller?.abort()
  }
}
