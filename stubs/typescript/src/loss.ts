// Reasons for having no connection.

import type { ErrorName } from './errors.ts'

/** The reason why a connection was lost, or why there is none. */
export type Loss =
  /** There has been no connection yet; the first attempt is still running. */
  | { readonly is: 'not_yet' }
  /** The robot closed the connection after it had sent a frame. */
  | { readonly is: 'closed_by_robot' }
  /** The robot closed the connection without sending a frame. */
  | { readonly is: 'closed_unheard' }
  /** The connection broke, with the platform's reason. */
  | { readonly is: 'broken'; readonly reason: string }
  /** The received bytes cannot be split into frames. */
  | { readonly is: 'frame'; readonly fault: ErrorName }
  /** A frame stopped or was too slow after `received` of its `total` bytes. */
  | { readonly is: 'stalled'; readonly received: number; readonly total: number }
  /** The robot did not read the sent bytes within the stall timeout. */
  | { readonly is: 'unread' }
  /** The network refused a new connection. */
  | { readonly is: 'unreachable'; readonly reason: string }
  /** A new connection was not made within the connect timeout. */
  | { readonly is: 'connect_timeout' }
  /** The command connection was made again, so the data connection is made again as well. */
  | { readonly is: 'renewed' }
  /** This side has closed the connection. */
  | { readonly is: 'closed_here' }

/** Returns a description of the loss for people. */
export function lossText(loss: Loss): string {
  switch (loss.is) {
    case 'not_yet':
      return 'the first connection is still being made'
    case 'closed_by_robot':
      return 'the robot has closed the connection'
    case 'closed_unheard':
      return 'the robot has closed the connection before it sent anything; it may have too many connections, or fail at the request'
    case 'broken':
      return `the connection broke: ${loss.reason}`
    case 'frame':
      return `the robot's bytes are no frames: ${loss.fault}`
    case 'stalled':
      return `a frame stalled: ${loss.received} bytes have come of ${loss.total}; is its length right?`
    case 'unread':
      return 'the robot does not read'
    case 'unreachable':
      return `cannot connect: ${loss.reason}`
    case 'connect_timeout':
      return 'cannot connect in time'
    case 'renewed':
      return 'the command connection was made again, and the data connection with it'
    case 'closed_here':
      return 'the connection was closed by this side'
  }
}
