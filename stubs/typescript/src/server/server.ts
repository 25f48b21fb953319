// The robot's side: what a generated robot stands on.

import type { Refusal } from '../refusal.ts'
import type { Report, Stream } from '../operation.ts'
import type { ServerPlatform, Soon } from '../platform.ts'
import type { ProtocolOf, ServiceOf } from '../wire.ts'
import type { BodyError } from '../fault.ts'
import type { ServerConfig } from './config.ts'

/** A connection of an app. */
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
  /** Aborted when nobody waits for the answer any more. */
  readonly signal: AbortSignal
  /** The refusal of a command that this robot does not carry out. */
  notImplemented(): Refusal
}

/** What a handler gives: the response, at once or later. */
export type Answer<Response> = Soon<Response>

/** A request of a code without a type. */
export interface RawRequest {
  /** Command code. */
  readonly code: number
  /** The own keys as JSON. */
  readonly json: string
}

/** Whom to send to: every app, or one by its command connection. */
export type Audience = 'all' | ConnectionId

/** How a report ended at one app. */
export interface Acknowledgement {
  /** The app. */
  readonly connection: ConnectionId
  /** How it ended. */
  readonly outcome: 'acknowledged' | 'refused' | 'invalid' | 'timed_out' | 'dropped' | 'closed'
  /** Of `refused`. */
  readonly refusal?: Refusal
  /** Of `invalid`. */
  readonly body?: BodyError
}

/** A robot that serves apps. */
export class Server {
  /** Sends a report, and waits for what becomes of it at each app. */
  push<Body>(audience: Audience, report: Report<Body>, body: Body): Promise<Acknowledgement[]> {
    throw new Error(`${audience} ${report.name} ${String(body)}`)
  }

  /** Sends a frame of a stream; gives the number of connections that took it. */
  sendStream<Content>(audience: Audience, stream: Stream<Content>, id: number, content: Content): Promise<number> {
    throw new Error(`${audience} ${stream.name} ${id} ${String(content)}`)
  }
}

/** Serves apps with the methods of a robot. */
export function serveRobot(
  protocol: ProtocolOf, service: ServiceOf, platform: ServerPlatform, robot: object, config: ServerConfig,
): Promise<Server> {
  void protocol, service, platform, robot, config
  throw new Error('not yet')
}
