// Whether there is a connection: as a value, and as a stream of its changes.

import type { Loss } from '../loss.ts'

/** Whether there is a connection at this moment, and why not. `connects` counts the connections made so far. */
export type ConnectionState =
  /** There is a connection. */
  | { readonly is: 'connected'; readonly connects: number }
  /** There is none, and one is being made: the first, or another one after a loss. */
  | { readonly is: 'connecting'; readonly connects: number; readonly why: Loss }
  /** There will be none any more. */
  | { readonly is: 'closed'; readonly connects: number; readonly why: Loss }
