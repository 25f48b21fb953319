// An app's connection to a robot: the base of a generated client.

// Projects with an older `lib` have no `Symbol.asyncDispose`.
/// <reference lib="esnext.disposable" preserve="true" />

import { keys, keysOf, textOf } from '../bodies.ts'
import { BodyError } from '../fault.ts'
import type { WholeFrame } from '../framing.ts'
import type { Loss } from '../loss.ts'
import type { AnyCommand, Command, FollowedCommand, Report, Reported } from '../operation.ts'
import type { Platform } from '../platform.ts'
import { Refusal } from '../refusal.ts'
import type { JsonText } from '../schema.ts'
import type { FrameId } from '../session.ts'
import { callUser, thrownFields } from '../thrown.ts'
import type { ProtocolOf } from '../wire.ts'
import { callCheck } from './config.ts'
import type { CallOptions, ClientConfig } from './config.ts'
import { Core } from './core.ts'
import type { ClientCounters } from './counters.ts'
import { DataConnection } from './data.ts'
import { CallError } from './error.ts'
import { Following } from './following.ts'
import type { FollowableCall } from './following.ts'
import type { ConnectionState } from './life.ts'
import type { Queue } from './queues.ts'
import { Reports } from './reports.ts'

/** A started connection, from which a `Connection` is created. */
export class Started {
  /**
   * State shared by the connection's handles.
   *
   * @internal
   */
  readonly core: Core

  /**
   * Made by `dial` and `dialLater`.
   *
   * @internal
   */
  constructor(core: Core) {
    this.core = core
  }
}

/** Connects; rejects with a `ConnectError` if the first attempt fails. */
export async function dial(protocol: ProtocolOf, platform: Platform, config: ClientConfig): Promise<Started> {
  const core = new Core(protocol, platform, config)
  await core.connect()
  return new Started(core)
}

/** Returns at once and connects in the background: the first connection is retried like one after a loss. */
export function dialLater(protocol: ProtocolOf, platform: Platform, config: ClientConfig): Started {
  const core = new Core(protocol, platform, config)
  core.run(null)
  return new Started(core)
}

/** A report with a code that the spec does not declare. Its `value` is the JSON of its keys. */
export interface UnknownReport extends Reported<'Unknown', JsonText> {}

/** The response to a call without types. A refusal is a response, too. */
export interface RawResponse {
  /** The result, if it is not success. */
  readonly refusal: Refusal | null
  /** The response's keys, without the envelope. */
  readonly json: JsonText
}

/**
 * A connection to a robot's command port. It reconnects after a loss, unless configured otherwise. Calls made meanwhile
 * wait within their timeout. Calls in flight that only read are sent once more with the same id. The others end as
 * `lost`, because the robot may or may not have acted.
 */
export class Connection<Any> {
  private readonly core: Core

  /** Creates the connection from the result of `dial` or `dialLater`. */
  constructor({ core }: Started) {
    this.core = core
  }

  /** The present state of the connection, with the reason if there is none. */
  get state(): ConnectionState {
    return this.core.life.now
  }

  /**
   * Yields the present state, then each change; the last state is `closed`. An app that queries the robot's state at
   * each `connected` stays up to date after a restart of the robot.
   */
  states(): AsyncGenerator<ConnectionState, void, undefined> {
    return this.core.life.states()
  }

  /** Waits until the connection has ended for good. Returns the reason. */
  closed(): Promise<Loss> {
    return this.core.life.closed()
  }

  /** Number of calls in flight. */
  get inFlight(): number {
    return this.core.session.inFlight
  }

  /** Returns a copy of the connection's counters. */
  counters(): Readonly<ClientCounters> {
    return { ...this.core.counters }
  }

  /** Calls a command and waits for its response. Rejects with a `CallError` if none comes in time. */
  call<Request, Response, Body>(
    command: FollowedCommand<Request, Response, Body, string>,
    request: Request,
    options?: CallOptions,
  ): FollowableCall<Response, Body>
  /** Calls a command that sets off no reports to follow. */
  call<Request, Response>(
    command: Command<Request, Response, string>,
    request: Request,
    options?: CallOptions,
  ): Promise<Response>
  call<Request, Response, Body>(
    command: Command<Request, Response, string> | FollowedCommand<Request, Response, Body, string>,
    request: Request,
    options: CallOptions = {},
  ): FollowableCall<Response, Body> {
    const { core } = this
    const response = this.begin(
      command.code,
      command.effect === 'read',
      options,
      () => core.bodies.writeRequest(command.request, request),
      (data) => {
        const read = core.bodies.readResponse(command.response, data)
        if (read instanceof Refusal) throw new CallError('refused', { refusal: read })
        return read.message
      },
    )
    let isLate = false
    queueMicrotask(() => {
      isLate = true
    })
    const follow = async (): Promise<Following<Response, Body>> => {
      if (!('setsOff' in command)) throw new TypeError(`nothing is said of ${command.name} setting off reports`)
      if (isLate) throw new TypeError('follow() is to be called at once, or reports could be missed')
      const { report, tied } = command.setsOff
      const queue: Queue = core.queues.enter(report.code)
      try {
        const answer = await response
        return new Following(core, queue, report, answer, (body) =>
          tied.every((tie) => tie.call(request, answer) === tie.report(body)),
        )
      } catch (problem) {
        core.queues.leave(queue)
        throw problem
      }
    }
    return Object.assign(response, { follow })
  }

  /** Calls a command whose types are not known, such as one from a list. Its schema checks the request. */
  callAny(command: AnyCommand, request: unknown, options: CallOptions = {}): Promise<unknown> {
    return this.call(command as Command<unknown, unknown, string>, request, options)
  }

  /**
   * Calls a code with a JSON object of the request's keys. The call is not repeated after a loss, and its result is not
   * an error. Rejects with a `CallError` of any kind except `refused`.
   */
  callRaw(code: number, json: JsonText, options: CallOptions = {}): Promise<RawResponse> {
    const { bodies } = this.core
    const body = (): Uint8Array => bodies.writeRequest(keys, keysOf(json, bodies.allowed))
    return this.begin(code, false, options, body, (data) => {
      const read = bodies.readResponse(keys, data)
      return read instanceof Refusal ? { refusal: read, json: '{}' } : { refusal: null, json: textOf(read.message) }
    })
  }

  private begin<Response>(
    code: number | null,
    repeatsByItself: boolean,
    options: CallOptions,
    body: () => Uint8Array,
    read: (data: Uint8Array) => Response,
  ): Promise<Response> {
    const { core } = this
    let given: AbortSignal | undefined
    const response = new Promise<Response>((resolve, reject) => {
      callCheck('CallOptions', options)
      const { timeout = core.settings.callTimeout, repeat = repeatsByItself, signal } = options
      given = signal
      if (code === null) throw new TypeError('the command has no code yet')
      core.framing.checkCode(code)
      signal?.throwIfAborted()
      let frame: FrameId | null = null
      const stop = (): void => {
        if (frame) core.cancel(frame)
        reject(signal?.reason)
      }
      const end = (): void => {
        signal?.removeEventListener('abort', stop)
      }
      // A request that breaks a constraint is rejected before anything is sent, even without a connection.
      let first: Uint8Array | null = attempt('invalid_request', body)
      frame = core.begin(code, timeout, {
        repeat,
        progress: 'unsent',
        body: () => {
          const bytes = first ?? body()
          first = null
          return bytes
        },
        answered: (answer) => {
          end()
          try {
            resolve(readAnswer(answer, read))
          } catch (problem) {
            reject(problem)
          }
        },
        failed: (error) => {
          end()
          reject(error)
        },
      })
      signal?.addEventListener('abort', stop, { once: true })
    })
    if (code !== null) core.watch(code, response, given)
    return response
  }

  /** All reports from now on. A report is acknowledged only when a receiver has it. */
  reports(): Reports<Any | UnknownReport>
  /** Reports of one kind. */
  reports<Body>(report: Report<Body>): Reports<Body>
  reports<Body>(report?: Report<Body>): Reports<Any | UnknownReport> | Reports<Body> {
    const { core } = this
    if (report) return new Reports(core, core.queues.enter(report.code), ({ value }) => value as Body)
    return new Reports(core, core.queues.enter(null), ({ code, id, time, name, value }) => {
      const reported: Reported<string, unknown> = { case: name ?? 'Unknown', value, code, id, time }
      return reported as Any
    })
  }

  /** Calls `then` with each later report of a kind. Returns a function that ends this. */
  on<Body>(report: Report<Body>, then: (body: Body) => void): () => void {
    const reports = this.reports(report)
    const pump = async (): Promise<void> => {
      const failed = (problem: unknown): void => {
        this.core.log.tellThinly('error', 'a listener threw', { name: report.name, ...thrownFields(problem) })
      }
      for await (const body of reports) callUser(() => then(body), failed)
    }
    void pump()
    return () => {
      reports.close()
    }
  }

  /**
   * Makes a connection to the robot's data port, in the background. It ends with this one. Each call makes another one.
   */
  data(): DataConnection {
    return new DataConnection(this.core)
  }

  /** Closes the connection. Calls in flight end as `lost`, and reports end once the queue is empty. */
  close(): void {
    this.core.close()
  }

  /** Closes the connection, for `await using`. */
  async [Symbol.asyncDispose](): Promise<void> {
    this.close()
    await this.closed()
  }
}

function attempt<T>(kind: 'invalid_request' | 'invalid_response', make: () => T): T {
  try {
    return make()
  } catch (problem) {
    if (problem instanceof BodyError) throw new CallError(kind, { body: problem })
    throw problem
  }
}

function readAnswer<T>({ fault, data }: WholeFrame, read: (data: Uint8Array) => T): T {
  if (fault !== null || data === null) throw new CallError('frame', { frame: fault ?? 'truncated' })
  return attempt('invalid_response', () => read(data))
}
