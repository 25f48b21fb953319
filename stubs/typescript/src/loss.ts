// Why there is no connection.

import type { ErrorName } from './errors.ts'

/** Why a connection was lost, or why there is none. */
export type Loss =
  /** There has been no connection yet, and the first attempt to make one is not over. */
  | { readonly is: 'not_yet' }
  /** The robot has closed the connection after it had sent something. */
  | { readonly is: 'closed_by_robot' }
  /** The robot has closed the connection, and not one frame had come over it. */
  | { readonly is: 'closed_unheard' }
  /** The connection broke, for a reason of the platform. */
  | { readonly is: 'broken'; readonly reason: string }
  /** What the robot sent cannot be told into frames. */
  | { readonly is: 'frame'; readonly fault: ErrorName }
  /** A frame began and did not go on, or came slower than it may: so many of its bytes have come. */
  | { readonly is: 'stalled'; readonly received: number; readonly total: number }
  /** The robot did not read what was sent to it within the stall timeout. */
  | { readonly is: 'unread' }
  /** The network says no to a new connection. */
  | { readonly is: 'unreachable'; readonly reason: string }
  /** A new connection was not made within the connect timeout. */
  | { readonly is: 'connect_timeout' }
  /** The command connection was made again, and the data connection, which belongs to it, is as well. */
  | { readonly is: 'renewed' }
  /** This side has closed the connection. */
  | { readonly is: 'closed_here' }

/** What it means, for people. */
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
