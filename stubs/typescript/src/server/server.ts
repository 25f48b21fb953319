// The robot's side: what a generated robot stands on.

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

/** An app that is connected. */
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

  /** The apps connected at this moment. */
  connections(): AppConnection[] {
    return [...this.shared.peers.values()].map(({ id, address }) => ({ connection: id, peer: address }))
  }

  /** How much memory is held for apps at this moment, in bytes. */
  memory(): number {
    return this.shared.held
  }

  /** What the robot has seen so far. */
  counters(): Readonly<ServerCounters> {
    return { ...this.shared.counters }
  }

  /** Serves a connection that was accepted elsewhere. `null` if there are too many. */
  serve(transport: Transport): ConnectionId | null {
    return this.shared.serve(transport)
  }

  /** Serves a data connection that was accepted elsewhere. `null` if there are too many. */
  serveData(transport: Transport): ConnectionId | null {
    return this.shared.serveData(transport)
  }

  /**
   * Sends a report to one app or to all that are connected, and waits for what becomes of it. Each app has a queue; when it is
   * full, the oldest report in it gives way. A report that is not acknowledged in time is sent again with the same id, as often as
   * its policy says. Rejects with a `PushError` if it was not even queued.
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

  /** Sends a report whose type is not known, such as one of a list of all. What it says, its schema asks. */
  pushAny(audience: Audience, report: AnyReportOf, body: unknown): Promise<Acknowledgement[]> {
    return this.push(audience, report as Report<unknown>, body)
  }

  /** Sends a frame of a stream; all else is as with `sendBytes`. Rejects with a `PushError`, also if it breaks a constraint. */
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
   * Sends a frame of raw bytes to the data connections of one app or of all: `code` says what they belong to, `id` which request
   * they answer. The protocol has nothing that ties a data connection to an app but the address: if several apps have come from
   * there, nothing is sent, and the error is `ambiguous`. Each data connection has a short queue, and this waits for room in all of
   * them, but in none longer than the stall timeout. Gives the number of connections that took the frame.
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
   * The frames of raw bytes that apps send from now on. While nobody takes them, they are dropped and counted; while the receiver
   * is busy, apps are not read. A later call takes over.
   */
  streams(): AppStreams {
    this.shared.inbox?.close()
    const streams = new AppStreams()
    this.shared.inbox = streams
    return streams
  }

  /** Resolves when the robot has ended. */
  ended(): Promise<void> {
    return this.isOver
  }

  /**
   * Ends the robot: accepts nothing more, reads no more requests, answers those that are being handled, waits for handlers that run
   * on, and cuts off after `grace` milliseconds what is not done by then. Resolves when all is over, never later than that.
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

/** Makes a robot that listens nowhere: connections are handed to it. */
export function robotWithoutPorts(
  protocol: ProtocolOf,
  service: ServiceOf,
  platform: ServerPlatform,
  robot: object,
  config: ServerConfig,
): Server {
  return new Server(new Shared(protocol, platform, new Routes(service, robot), config), [])
}

/** Serves apps with the methods of a robot. Rejects if a port cannot be had. */
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
