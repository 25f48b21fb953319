// What handlers and reports are told of.

import type { BodyError } from '../fault.ts'
import type { Soon } from '../platform.ts'
import type { Refusal } from '../refusal.ts'

/** A connection of an app, by its number. */
export type ConnectionId = number

/** What a handler is told beside the request. */
export interface Context {
  /** Address of the app. */
  readonly peer: string
  /** Connection of the app, as the audience of a report. */
  readonly connection: ConnectionId
  /** Message id of the request. */
  readonly id: number
  /** Command code of the request. */
  readonly code: number
  /** When the request was made, in milliseconds since 1970, if it says so. */
  readonly time: number | null
  /**
   * Aborted when nobody waits for the answer any more: the connection has ended, or the handler timeout is over and the app has
   * been told so. A handler runs on then; this is how it learns of that and stops, if it should.
   */
  readonly signal: AbortSignal
  /** The refusal of a command that the spec has and this robot does not carry out, to be thrown: nothing has been done. */
  notImplemented(): Refusal
}

/** What a handler gives: the response, at once or later. It refuses by throwing a `Refusal`. */
export type Answer<Response> = Soon<Response>

/** A request of a code without a type. */
export interface RawRequest {
  /** Command code. */
  readonly code: number
  /** The own keys as JSON. */
  readonly json: string
}

/** Whom to send to: every app connected at this moment, or one by its command connection. */
export type Audience = 'all' | ConnectionId

/** How a report ended at one app. */
export type AckOutcome =
  /** The app has acknowledged it. */
  | 'acknowledged'
  /** The app has answered with another result than success. */
  | 'refused'
  /** The app has answered with something that is not an acknowledgement. */
  | 'invalid'
  /** No acknowledgement has come, and the report was repeated as often as it may be. */
  | 'timed_out'
  /** The app was so slow that the report gave way to newer ones before it was sent. */
  | 'dropped'
  /** The connection ended first. */
  | 'closed'

/** What has become of a report at one app. */
export interface Acknowledgement {
  /** The app. */
  readonly connection: ConnectionId
  /** How it ended. */
  readonly outcome: AckOutcome
  /** Of `refused`: what the app has answered. */
  readonly refusal?: Refusal
  /** Of `invalid`: what is wrong with it. */
  readonly body?: BodyError
}

/** Why a report was not even queued. */
export type PushErrorKind =
  /** What is to be sent breaks one of its own constraints. */
  | 'invalid_report'
  /** It does not fit into a frame. */
  | 'frame'
  /** There is no such connection any more; for a stream: no data connection of that app. */
  | 'no_connection'
  /** A stream: several apps share the address, and nothing tells whose data connection is whose. Nothing was sent. */
  | 'ambiguous'

const SAYS: Readonly<Record<PushErrorKind, string>> = {
  invalid_report: 'what is to be sent is invalid',
  frame: 'it does not fit into a frame',
  no_connection: 'there is no such connection to send to',
  ambiguous: 'several apps share the address, and nothing tells whose data connection is whose',
}

/** Why a report or a frame of a stream was not sent. */
export class PushError extends Error {
  /** The fixed name. */
  readonly kind: PushErrorKind
  /** Of `invalid_report`: what is wrong. */
  readonly body: BodyError | null

  /** An error of this kind. */
  constructor(kind: PushErrorKind, body: BodyError | null = null) {
    super(body ? `${SAYS[kind]}: ${body.message}` : SAYS[kind])
    this.name = 'PushError'
    this.kind = kind
    this.body = body
  }
}
