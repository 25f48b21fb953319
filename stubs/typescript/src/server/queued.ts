// Reports on their way to one app.

import type { AckPolicy } from '../session.ts'
import type { Acknowledgement, ConnectionId } from './types.ts'

/** A report waiting for one app, or in flight to it. */
export interface Queued {
  /** Command code. */
  readonly code: number
  /** How its acknowledgement is awaited. */
  readonly policy: AckPolicy
  /** Its body. */
  readonly data: Uint8Array
  /** Is told how it ended. */
  ended(acknowledgement: Acknowledgement): void
}

/** Repetitions to different apps are spread over an eighth of the wait, so that they do not come at once. */
export function spread(timeout: number, connection: ConnectionId): number {
  const PLACES = 32
  return (timeout / 8 / PLACES) * (connection % PLACES)
}
