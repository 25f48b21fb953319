// Errors of connecting, of calls and of streams.

import type { ErrorName } from '../errors.ts'
import type { BodyError, OwnLimit } from '../fault.ts'
import { lossText } from '../loss.ts'
import type { Loss } from '../loss.ts'
import type { Declares } from '../operation.ts'
import type { Refusal } from '../refusal.ts'
import type { FrameId } from '../session.ts'

/** The error of a frame. */
export type FrameFault = ErrorName | OwnLimit

/** The error of connecting. */
export class ConnectError extends Error {
  /** `io`: the network refused; `timeout`: no connection in time. */
  readonly kind: 'io' | 'timeout'
  /** The network's reason. */
  readonly reason: string

  /** Creates the error for an address, with the network's reason. */
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

/** Kinds of call errors, with the names that all implementations share. */
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

/** Details of an error, depending on its kind. */
export interface CallErrorCause {
  /** For `refused`: the robot's result. */
  readonly refusal?: Refusal
  /** For `not_connected`, `closed` and `lost`: why there was no connection. */
  readonly loss?: Loss
  /** For `invalid_request` and `invalid_response`: the error in the body. */
  readonly body?: BodyError
  /** For `frame`: the error in the frame. */
  readonly frame?: FrameFault
}

/** A description of each kind for people. */
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

/** Returns the standard `cause` of an error, which logs print below it. */
const options = ({ refusal, body }: CallErrorCause): ErrorOptions => {
  const cause = refusal ?? body
  return cause ? { cause } : {}
}

/** The error of a call without a typed response. */
export class CallError extends Error {
  /** The fixed name. */
  readonly kind: CallErrorKind
  /** For `refused`: the robot's result. */
  readonly refusal: Refusal | null
  /** For `not_connected`, `closed` and `lost`: why there was no connection. */
  readonly loss: Loss | null
  /** For `invalid_request` and `invalid_response`: the error in the body. */
  readonly body: BodyError | null
  /** For `frame`: the error in the frame. */
  readonly frame: FrameFault | null

  /** Creates an error of this kind. */
  constructor(kind: CallErrorKind, cause: CallErrorCause = {}) {
    super([callErrorText[kind], why(cause)].filter((part) => part !== '').join(': '), options(cause))
    this.name = 'CallError'
    this.kind = kind
    this.refusal = cause.refusal ?? null
    this.loss = cause.loss ?? null
    this.body = cause.body ?? null
    this.frame = cause.frame ?? null
  }

  /** Returns the name of the command's declared error that the robot responded with; `null` for any other. */
  declared<Failure extends string>(command: Declares<Failure>): Failure | null {
    return this.refusal?.declared(command) ?? null
  }
}

/** The reason why following a process has ended, although the process may go on. */
export class FollowError extends Error {
  /** The connection is closed for good. */
  readonly kind: 'closed'
  /** Reason. */
  readonly loss: Loss

  /** Creates the error for a loss. */
  constructor(loss: Loss) {
    super(`the connection is closed: ${lossText(loss)}; the process may go on`)
    this.name = 'FollowError'
    this.kind = 'closed'
    this.loss = loss
  }
}

/** Kinds of errors on a data connection. */
export type DataErrorKind =
  /** The connection was lost and is made again. Frames may be missing here, or may not have arrived. */
  | 'lost'
  /** No connection in time; the frame has not been sent. */
  | 'not_connected'
  /** The connection is closed for good. */
  | 'closed'
  /** A received frame could not be read and was skipped, or the frame to send is too long. */
  | 'frame'
  /** The robot has refused a frame sent to it. */
  | 'refused'
  /** A frame arrived that is not a stream frame. */
  | 'unexpected_frame'
  /** The content of a frame does not fit its stream. */
  | 'invalid'

/** Details of an error, depending on its kind. */
export interface DataErrorCause extends CallErrorCause {
  /** The frame concerned. */
  readonly id?: FrameId
}

/** The error of sending or receiving a frame of a stream. */
export class DataError extends Error {
  /** The fixed name. */
  readonly kind: DataErrorKind
  /** The loss, for errors of a missing connection. */
  readonly loss: Loss | null
  /** The error in the content of a frame. */
  readonly body: BodyError | null
  /** The error of the frame. */
  readonly frame: FrameFault | null
  /** The robot's refusal. */
  readonly refusal: Refusal | null
  /** The frame concerned, if any. */
  readonly id: FrameId | null

  /** Creates an error of this kind. */
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
