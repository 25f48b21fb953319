// An app's connection to a robot: what a generated client stands on.

import type { ConnectionState } from './life.ts'
import type { CallOptions, ClientConfig } from './config.ts'
import type { DataConnection } from './data.ts'
import type { Loss } from '../loss.ts'
import type { Command, FollowedCommand, Report, Reported } from '../operation.ts'
import type { Platform } from '../platform.ts'
import type { ProtocolOf } from '../wire.ts'

/** What came of a connection that was begun. */
export interface Started {
  readonly protocol: ProtocolOf
}

/** Connects; rejects with a `ConnectError` if the first attempt fails. */
export function dial(protocol: ProtocolOf, platform: Platform, config: ClientConfig): Promise<Started> {
  void platform, config
  return Promise.resolve({ protocol })
}

/** Connects in the background. */
export function dialLater(protocol: ProtocolOf, platform: Platform, config: ClientConfig): Started {
  void platform, config
  return { protocol }
}

/** What comes to who follows a process. */
export type Followed<Body> =
  | { readonly is: 'going' | 'ended' | 'failed'; readonly report: Body }
  | { readonly is: 'missed'; readonly count: number }
  | { readonly is: 'interrupted'; readonly loss: Loss }
  | { readonly is: 'resumed' }

/** A command that has been answered, and the reports that it sets off. */
export interface Following<Response, Body> extends AsyncIterableIterator<Followed<Body>> {
  /** What the robot has answered to the command. */
  readonly answer: Response
  /** Ends it. */
  close(): void
}

/** A call of a command that sets off reports. */
export interface FollowableCall<Response, Body> extends Promise<Response> {
  /** Waits for the response, and then follows. To be called at once. */
  follow(): Promise<Following<Response, Body>>
}

/** A report with a code that the spec does not have. */
export interface UnknownReport extends Reported<'Unknown', string> {}

/** Reports from the moment of its creation on. */
export interface Reports<T> extends AsyncIterableIterator<T> {
  /** How many did not fit into the queue since this was last asked. */
  missed(): number
  /** Takes no more. */
  close(): void
}

/** A connection to a robot's command port. */
export class Connection<Any> {
  /** From `dial` or `dialLater`. */
  constructor(started: Started) {
    void started
  }

  /** Whether there is a connection at this moment, and why not. */
  get state(): ConnectionState {
    throw new Error('not yet')
  }

  /** Calls a command. */
  call<Request, Response, Body>(
    command: FollowedCommand<Request, Response, Body, string>, request: Request, options?: CallOptions,
  ): FollowableCall<Response, Body>
  call<Request, Response>(command: Command<Request, Response, string>, request: Request, options?: CallOptions): Promise<Response>
  call(): FollowableCall<never, never> {
    throw new Error('not yet')
  }

  /** All reports, or those of one kind. */
  reports(): Reports<Any | UnknownReport>
  reports<Body>(report: Report<Body>): Reports<Body>
  reports(): Reports<never> {
    throw new Error('not yet')
  }

  /** The data port. */
  data(): DataConnection {
    throw new Error('not yet')
  }
}
