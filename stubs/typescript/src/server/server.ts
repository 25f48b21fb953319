// The robot's side: the base of a generated robot.

// Projects with an older `lib` have no `Symbol.asyncDispose`.
/// <reference lib="esnext.disposable" preserve="true" />

import { BodyError } from '../fault.ts'
import { bytesOfContent } from '../client/data.ts'
import { DataError } from '../client/error.ts'
import type { AnyReportOf, Report, Stream } from '../operation.ts'
import type { Listener, ServerPlatform, Transport } from '../platform.ts'
import { duration } from '../settings.ts'
import type { ProtocolOf, ServiceOf } from '../wire.ts'
import type { ServerConfig } from './config.ts'
import type { ServerCounters } from './counters.ts'
import { AppStreams } from './data_peer.ts'
import { Routes } from './routes.ts'
import { Shared } from './shared.ts'
import { PushError } from './types.ts'
import type { Acknowledgement, Audience, ConnectionId } from './types.ts'

/** A connected app. */
export interface AppConnection {
  /** Its connection. */
  readonly connection: ConnectionId
  /** Its address. */
  readonly peer: string
}

/** A robot that serves apps. */
export class Server {
  private readonly shared: Shared
  private readonly listeners: readonly Listener[]
  private readonly isOver: Promise<void>
  private over: () => void = () => {}

  /**
   * Made by `serveRobot`.
   *
   * @internal
   */
  constructor(shared: Shared, listeners: readonly Listener[]) {
    this.shared = shared
    this.listeners = listeners
    this.isOver = new Promise((resolve) => {
      this.over = resolve
    })
  }

  /** The port of commands and reports; 0 if it does not listen. */
  get commandPort(): number {
    return this.listeners[0]?.port ?? 0
  }

  /** The port of streams; 0 if it does not listen. */
  get dataPort(): number {
    return this.listeners[1]?.port ?? 0
  }

  /** Returns the apps connected at present. */
  connections(): AppConnection[] {
    return [...this.shared.peers.values()].map(({ id, address }) => ({ connection: id, peer: address }))
  }

  /** Returns the memory held for apps at present, in bytes. */
  memory(): number {
    return this.shared.held
  }

  /** Returns a copy of the robot's counters. */
  counters(): Readonly<ServerCounters> {
    return { ...this.shared.counters }
  }

  /** Serves a connection that the caller accepted. Returns `null` if there are too many. */
  serve(transport: Transport): ConnectionId | null {
    return this.shared.serve(transport)
  }

  /** Serves a data connection that the caller accepted. Returns `null` if there are too many. */
  serveData(transport: Transport): ConnectionId | null {
    return this.shared.serveData(transport)
  }

  /**
   * Sends a report to one app or to all connected ones, and returns the outcome at each. Each app has a queue. When it
   * is full, the newest report replaces the oldest. A report without an acknowledgement in time is sent again with the
   * same id, as its policy specifies. Rejects with a `PushError` if the report was not queued.
   */
  async push<Body>(audience: Audience, report: Report<Body>, body: Body): Promise<Acknowledgement[]> {
    const { code } = report
    if (code === null) throw new TypeError('the report has no code yet')
    const { shared } = this
    let data: Uint8Array
    try {
      data = shared.bodies.writeRequest(report.body, body)
    } catch (problem) {
      throw problem instanceof BodyError ? new PushError('invalid_report', problem) : problem
    }
    if (!shared.framing.fits(data) && shared.settings.gzipFrom === null) throw new PushError('frame')
    const policy = report.ack ?? shared.protocol.wire.defaults.ack
    const ends = shared.audience(audience).map(
      (peer) =>
        new Promise<Acknowledgement>((ended) => {
          peer.push({ code, policy, data, ended })
        }),
    )
    return await Promise.all(ends)
  }

  /** Sends a report whose type is not known, such as one from a list. Its schema checks the body. */
  pushAny(audience: Audience, report: AnyReportOf, body: unknown): Promise<Acknowledgement[]> {
    return this.push(audience, report as Report<unknown>, body)
  }

  /**
   * Sends a frame of a stream as `sendBytes` does. Rejects with a `PushError`, also if the content breaks a constraint.
   */
  async sendStream<Content>(
    audience: Audience,
    stream: Stream<Content>,
    id: number,
    content: Content,
  ): Promise<number> {
    if (stream.code === null) throw new TypeError('the stream has no code yet')
    let bytes: Uint8Array
    try {
      bytes = bytesOfContent(stream, content)
    } catch (problem) {
      throw problem instanceof DataError && problem.body ? new PushError('invalid_report', problem.body) : problem
    }
    return await this.sendBytes(audience, stream.code, id, bytes)
  }

  /**
   * Sends a frame of raw bytes to the data connections of one app or of all. `code` is the command that they belong to,
   * `id` the request that they answer. Returns the number of connections that took the frame.
   *
   * Only the address ties a data connection to an app. If several apps share it, nothing is sent and the error is
   * `ambiguous`. Each data connection has a short queue. The call waits for room in each, at most for the stall
   * timeout.
   */
  async sendBytes(audience: Audience, code: number, id: number, data: Uint8Array): Promise<number> {
    const { shared } = this
    shared.framing.checkCode(code)
    shared.framing.checkId(id)
    if (!(data instanceof Uint8Array)) throw new PushError('invalid_report', new BodyError('wrong_type', 'bytes'))
    const peers = shared.dataAudience(audience)
    const frame = { response: false, kind: shared.framing.kind('stream'), code, id }
    const bytes = await shared.framing.encode(frame, data, shared.settings.gzipFrom)
    if (bytes.length > shared.framing.frameBytes) throw new PushError('frame')
    const taken = await Promise.all(peers.map((peer) => peer.send(bytes)))
    return taken.filter((one) => one).length
  }

  /**
   * Returns the frames of raw bytes that apps send from now on. Without a receiver, frames are dropped and counted.
   * While the receiver is busy, nothing is read from apps. A later call takes over.
   */
  streams(): AppStreams {
    this.shared.inbox?.close()
    const streams = new AppStreams()
    this.shared.inbox = streams
    return streams
  }

  /** Waits until the robot has ended. */
  ended(): Promise<void> {
    return this.isOver
  }

  /**
   * Ends the robot. Accepts no more connections and reads no more requests. Requests in handlers still get their
   * responses. After `grace` milliseconds, cuts off the rest. Resolves when all has ended, at the latest then.
   */
  async shutdown(grace: number): Promise<void> {
    duration('grace', grace)
    const { shared } = this
    for (const listener of this.listeners) listener.close()
    shared.log.tell('info', 'shutting down')
    let stop = (): void => {}
    const late = new Promise<boolean>((resolve) => {
      const cancel = shared.platform.clock.after(grace, () => {
        resolve(true)
      })
      stop = cancel
    })
    const isCut = await Promise.race([late, shared.stop().then(() => false)])
    stop()
    if (isCut) shared.log.tell('warn', 'connections or handlers were cut off at the end of the grace')
    shared.abort()
    this.over()
  }

  /** Ends the robot at once. */
  close(): Promise<void> {
    return this.shutdown(0)
  }

  /** Ends the robot at once, for `await using`. */
  async [Symbol.asyncDispose](): Promise<void> {
    await this.close()
  }
}

/** Creates a robot that listens on no port: the caller hands it connections. */
export function robotWithoutPorts(
  protocol: ProtocolOf,
  service: ServiceOf,
  platform: ServerPlatform,
  robot: object,
  config: ServerConfig,
): Server {
  return new Server(new Shared(protocol, platform, new Routes(service, robot), config), [])
}

/** Serves apps with the methods of a robot. Rejects if a port is not available. */
export async function serveRobot(
  protocol: ProtocolOf,
  service: ServiceOf,
  platform: ServerPlatform,
  robot: object,
  config: ServerConfig,
): Promise<Server> {
  const { wire } = protocol
  const { address = '0.0.0.0', commandPort = wire.commandPort, dataPort = wire.dataPort, keepalive = 30_000 } = config
  const shared = new Shared(protocol, platform, new Routes(service, robot), config)
  const commands = await platform.listen(
    address,
    commandPort,
    { keepalive },
    (transport) => void shared.serve(transport),
  )
  try {
    const data = await platform.listen(
      address,
      dataPort,
      { keepalive },
      (transport) => void shared.serveData(transport),
    )
    return new Server(shared, [commands, data])
  } catch (problem) {
    commands.close()
    throw problem
  }
}
