// Types that handlers and senders of reports receive.

import type { BodyError } from '../fault.ts'
import type { Soon } from '../platform.ts'
import type { Refusal } from '../refusal.ts'

/** A connection of an app, by its number. */
export type ConnectionId = number

/** Facts about a call that a handler receives with the request. */
export interface Context {
  /** Address of the app. */
  readonly peer: string
  /** Connection of the app, as the audience of a report. */
  readonly connection: ConnectionId
  /** Message id of the request. */
  readonly id: number
  /** Command code of the request. */
  readonly code: number
  /** Time the request was made, in milliseconds since 1970; `null` if it carries no time. */
  readonly time: number | null
  /**
   * Aborts when the response is no longer awaited: the connection has ended, or the app got a timeout after the handler
   * timeout. The handler keeps running and can use this signal to stop.
   */
  readonly signal: AbortSignal
  /**
   * Returns the refusal of a command that this robot does not implement. The handler throws it before it has any
   * effect.
   */
  notImplemented(): Refusal
}

/** The result of a handler: the response, at once or later. A handler refuses by throwing a `Refusal`. */
export type Answer<Response> = Soon<Response>

/** A request of a code without a type. */
export interface RawRequest {
  /** Command code. */
  readonly code: number
  /** The request's keys, without the envelope, as JSON. */
  readonly json: string
}

/** Receivers of a report: every app connected at present, or one by its command connection. */
export type Audience = 'all' | ConnectionId

/** Outcome of a report at one app. */
export type AckOutcome =
  /** The app has acknowledged it. */
  | 'acknowledged'
  /** The app acknowledged it with a result other than success. */
  | 'refused'
  /** The app sent something that is not an acknowledgement. */
  | 'invalid'
  /** No acknowledgement came, and the repetitions are used up. */
  | 'timed_out'
  /** The app was so slow that newer reports replaced it before it was sent. */
  | 'dropped'
  /** The connection ended first. */
  | 'closed'

/** Outcome of a report at one app. */
export interface Acknowledgement {
  /** The app. */
  readonly connection: ConnectionId
  /** The outcome. */
  readonly outcome: AckOutcome
  /** For `refused`: the app's result. */
  readonly refusal?: Refusal
  /** For `invalid`: the error in the body. */
  readonly body?: BodyError
}

/** Reasons why a report was not queued. */
export type PushErrorKind =
  /** The report or stream content breaks a constraint. */
  | 'invalid_report'
  /** It does not fit into a frame. */
  | 'frame'
  /** The connection does not exist any more. For a stream: that app has no data connection. */
  | 'no_connection'
  /** For a stream: nothing was sent. Several apps share the address, so the app's data connection is unknown. */
  | 'ambiguous'

const SAYS: Readonly<Record<PushErrorKind, string>> = {
  invalid_report: 'what is to be sent is invalid',
  frame: 'it does not fit into a frame',
  no_connection: 'there is no such connection to send to',
  ambiguous: 'several apps share the address, and nothing tells whose data connection is whose',
}

/** The error of sending a report or a frame of a stream. */
export class PushError extends Error {
  /** The fixed name. */
  readonly kind: PushErrorKind
  /** For `invalid_report`: the error in the body. */
  readonly body: BodyError | null

  /** Creates an error of this kind. */
  constructor(kind: PushErrorKind, body: BodyError | null = null) {
    super(body ? `${SAYS[kind]}: ${body.message}` : SAYS[kind])
    this.name = 'PushError'
    this.kind = kind
    this.body = body
  }
}
