// Reports on their way to one app.

import type { AckPolicy } from '../session.ts'
import type { Acknowledgement, ConnectionId } from './types.ts'

/** A report waiting for one app, or in flight to it. */
export interface Queued {
  /** Command code. */
  readonly code: number
  /** Policy for its acknowledgement. */
  readonly policy: AckPolicy
  /** Its body. */
  readonly data: Uint8Array
  /** Receives the outcome. */
  ended(acknowledgement: Acknowledgement): void
}

/**
 * Returns the wait before a repetition. The waits of different apps are spread over an eighth, so that repetitions do
 * not come at once.
 */
export function spread(timeout: number, connection: ConnectionId): number {
  const PLACES = 32
  return (timeout / 8 / PLACES) * (connection % PLACES)
}
