// What can go wrong with connecting, with calls and with streams.

import type { ErrorName } from '../errors.ts'
import type { BodyError, OwnLimit } from '../fault.ts'
import { lossText } from '../loss.ts'
import type { Loss } from '../loss.ts'
import type { Declares } from '../operation.ts'
import type { Refusal } from '../refusal.ts'
import type { FrameId } from '../session.ts'

/** What is wrong with a frame. */
export type FrameFault = ErrorName | OwnLimit

/** Why a connection could not be made. */
export class ConnectError extends Error {
  /** `io`: the network says no; `timeout`: no connection in time. */
  readonly kind: 'io' | 'timeout'
  /** The network's reason. */
  readonly reason: string

  /** Whom it was to connect to, and the network's reason. */
  constructor(kind: 'io' | 'timeout', address: string, reason: string) {
    super(
      kind === 'io'
        ? `cannot connect to ${address}: ${reason}`
        : `no connection to ${address} in time; is the robot switched on and in the same network?`,
    )
    this.name = 'ConnectError'
    this.kind = kind
    this.reason = reason
  }
}

/** What a call can end with, by the names that all implementations share. */
export type CallErrorKind =
  | 'refused'
  | 'timeout'
  | 'not_connected'
  | 'closed'
  | 'lost'
  | 'busy'
  | 'invalid_request'
  | 'invalid_response'
  | 'frame'

/** What goes with the kind of an error. */
export interface CallErrorCause {
  /** Of `refused`: what the robot has answered. */
  readonly refusal?: Refusal
  /** Of `not_connected`, `closed` and `lost`: why there was no connection (any more). */
  readonly loss?: Loss
  /** Of `invalid_request` and `invalid_response`: what is wrong with it. */
  readonly body?: BodyError
  /** Of `frame`: what is wrong with it. */
  readonly frame?: FrameFault
}

/** What each kind means, for people. */
export const callErrorText: Readonly<Record<CallErrorKind, string>> = {
  refused: 'the robot has refused',
  timeout: 'no response in time',
  not_connected: 'not sent, for there was no connection in time',
  closed: 'not sent, for the connection is closed',
  lost: "the connection was lost before the response arrived; query the robot's state",
  busy: 'not sent, for too many calls are in flight',
  invalid_request: 'not sent, for the request is invalid',
  invalid_response: 'the response is invalid',
  frame: 'the request does not fit into a frame, or the answer came in a broken one',
}

const why = ({ refusal, loss, body, frame }: CallErrorCause): string =>
  refusal?.message ?? (loss && lossText(loss)) ?? body?.message ?? frame ?? ''

/** The standard `cause` of an error, which logs print below it, where there is one. */
const options = ({ refusal, body }: CallErrorCause): ErrorOptions => {
  const cause = refusal ?? body
  return cause ? { cause } : {}
}

/** Why a call has no typed response. */
export class CallError extends Error {
  /** The fixed name. */
  readonly kind: CallErrorKind
  /** Of `refused`: what the robot has answered. */
  readonly refusal: Refusal | null
  /** Of `not_connected`, `closed` and `lost`: why there was no connection (any more). */
  readonly loss: Loss | null
  /** Of `invalid_request` and `invalid_response`: what is wrong with it. */
  readonly body: BodyError | null
  /** Of `frame`: what is wrong with it. */
  readonly frame: FrameFault | null

  /** An error of this kind. */
  constructor(kind: CallErrorKind, cause: CallErrorCause = {}) {
    super([callErrorText[kind], why(cause)].filter((part) => part !== '').join(': '), options(cause))
    this.name = 'CallError'
    this.kind = kind
    this.refusal = cause.refusal ?? null
    this.loss = cause.loss ?? null
    this.body = cause.body ?? null
    this.frame = cause.frame ?? null
  }

  /** Which of the errors that a command declares the robot has answered with; `null` for any other. */
  declared<Failure extends string>(command: Declares<Failure>): Failure | null {
    return this.refusal?.declared(command) ?? null
  }
}

/** Why a process can be followed no further, although it may go on. */
export class FollowError extends Error {
  /** The connection is closed for good. */
  readonly kind: 'closed'
  /** Why. */
  readonly loss: Loss

  /** An end for this reason. */
  constructor(loss: Loss) {
    super(`the connection is closed: ${lossText(loss)}; the process may go on`)
    this.name = 'FollowError'
    this.kind = 'closed'
    this.loss = loss
  }
}

/** What can go wrong on a data connection. */
export type DataErrorKind =
  /** The connection was lost, and is made again: frames may be missing here, or may not have arrived. */
  | 'lost'
  /** No connection in time; the frame has not been sent. */
  | 'not_connected'
  /** The connection is closed for good. */
  | 'closed'
  /** A frame could not be read, and was skipped; or the one to be sent is too long. */
  | 'frame'
  /** The robot has refused a frame sent to it. */
  | 'refused'
  /** A frame arrived that is not a stream frame. */
  | 'unexpected_frame'
  /** What a frame carries, or is to carry, is not what its stream does. */
  | 'invalid'

/** What goes with the kind of an error. */
export interface DataErrorCause extends CallErrorCause {
  /** The frame that it is about. */
  readonly id?: FrameId
}

/** Why a frame of a stream could not be sent, or what came instead of one. */
export class DataError extends Error {
  /** The fixed name. */
  readonly kind: DataErrorKind
  /** Why there is no connection, if that is what is wrong. */
  readonly loss: Loss | null
  /** What is wrong with what a frame carries. */
  readonly body: BodyError | null
  /** What is wrong with a frame. */
  readonly frame: FrameFault | null
  /** What the robot has answered. */
  readonly refusal: Refusal | null
  /** The frame that it is about, if it is about one. */
  readonly id: FrameId | null

  /** An error of this kind. */
  constructor(kind: DataErrorKind, cause: DataErrorCause = {}) {
    super([kind, why(cause)].filter((part) => part !== '').join(': '), options(cause))
    this.name = 'DataError'
    this.kind = kind
    this.loss = cause.loss ?? null
    this.body = cause.body ?? null
    this.frame = cause.frame ?? null
    this.refusal = cause.refusal ?? null
    this.id = cause.id ?? null
  }
}
