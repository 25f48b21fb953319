// What all handles of a connection share: its session, its queues, and the loop that keeps it up.

import { Alarm, pause } from '../alarm.ts'
import { Bodies, firstIdAt } from '../bodies.ts'
import { withDefaults } from '../defaults.ts'
import type { ErrorName } from '../errors.ts'
import { Framing } from '../framing.ts'
import type { WholeFrame } from '../framing.ts'
import { Logger } from '../log.ts'
import { lossText } from '../loss.ts'
import type { Loss } from '../loss.ts'
import { soon } from '../platform.ts'
import type { Platform, Transport } from '../platform.ts'
import { Session } from '../session.ts'
import type { FrameId } from '../session.ts'
import type { Limits, ProtocolOf } from '../wire.ts'
import { Arrivals } from './arrivals.ts'
import { clientCheck, defaultBackoff } from './config.ts'
import type { Backoff, ClientConfig } from './config.ts'
import { newCounters } from './counters.ts'
import type { ClientCounters } from './counters.ts'
import { CallError, ConnectError } from './error.ts'
import { Life } from './life.ts'
import { Link } from './link.ts'
import { Queues } from './queues.ts'
import { Tries, attempt, lossOf } from './tries.ts'
import type { Address } from './tries.ts'

/** A call that has not ended. */
export interface Flight {
  /** Whether it may be sent once more after the connection was lost. */
  repeat: boolean
  /** Not on its way; on its way; was on its way when the connection was lost, and is to be sent once more. */
  progress: 'unsent' | 'sent' | 'again'
  /** Writes the body; throws a `BodyError`. */
  body(): Uint8Array
  /** The answer has come. */
  answered(frame: WholeFrame): void
  /** There will be none. */
  failed(error: CallError): void
}

/** Settings with nothing left open. */
export interface Settings {
  /** Addresses of both ports. */
  readonly commands: Address
  /** Of streams. */
  readonly data: Address
  /** How long a call waits. */
  readonly callTimeout: number
  /** How to reconnect. */
  readonly backoff: Backoff | null
  /** How long a frame may make no progress. */
  readonly stallTimeout: number
  /** From which length on data is compressed. */
  readonly gzipFrom: number | null
  /** Bounds. */
  readonly limits: Limits
}

function settle({ wire }: ProtocolOf, config: ClientConfig): Settings {
  clientCheck('ClientConfig', config)
  const { host = wire.host, connectTimeout: timeout = 3000, keepalive = 30_000, reconnect = {}, gzip = null } = config
  return {
    commands: { host, port: config.commandPort ?? wire.commandPort, timeout, keepalive },
    data: { host, port: config.dataPort ?? wire.dataPort, timeout, keepalive },
    callTimeout: config.callTimeout ?? wire.defaults.callTimeout,
    backoff: reconnect === null ? null : withDefaults(reconnect, defaultBackoff),
    stallTimeout: config.stallTimeout ?? 10_000,
    gzipFrom: gzip === null ? null : (gzip.fromBytes ?? 1024),
    limits: withDefaults(config.limits ?? {}, wire.defaults.limits),
  }
}

/** Everything of a connection but its public face. */
export class Core {
  /** The protocol. */
  readonly protocol: ProtocolOf
  /** What it runs on. */
  readonly platform: Platform
  /** What it was told. */
  readonly settings: Settings
  /** Frames. */
  readonly framing: Framing
  /** Bodies. */
  readonly bodies: Bodies
  /** Whether there is a connection. */
  readonly life: Life = new Life()
  /** Requests in flight, reports seen. */
  readonly session: Session<Flight>
  /** What waits for receivers of reports. */
  readonly queues: Queues
  /** What has been seen. */
  readonly counters: ClientCounters = newCounters()
  /** Lines for people. */
  readonly log: Logger
  private readonly arrivals: Arrivals
  private readonly alarm: Alarm
  private readonly ending = new AbortController()
  private link: Link | null = null
  private why: Loss = { is: 'not_yet' }

  /** Not begun. */
  constructor(protocol: ProtocolOf, platform: Platform, config: ClientConfig) {
    const { wire } = protocol
    this.protocol = protocol
    this.platform = platform
    this.settings = settle(protocol, config)
    this.log = new Logger(config.log, wire.name, () => this.now)
    const { limits } = this.settings
    this.framing = new Framing(wire.frame, limits, platform.algorithms, config.verifyDigest ?? true)
    this.bodies = new Bodies(wire, platform.clock, limits)
    this.queues = new Queues(limits.queuedReports, config.queuedBytes ?? limits.inflatedBytes)
    this.session = new Session({
      report: this.framing.kind('report'),
      stream: this.framing.kind('stream'),
      inFlight: limits.inFlight,
      remembers: Math.max(limits.inFlight, limits.queuedReports, 64),
      ack: wire.defaults.ack,
      firstId: config.firstId ?? firstIdAt(platform.clock.wallTime()),
      idMax: this.framing.idMax,
    })
    this.arrivals = new Arrivals(this)
    this.alarm = new Alarm(
      platform.clock,
      () => this.session.nextDue,
      () => {
        this.expire()
      },
    )
  }

  /** Milliseconds that never go back. */
  get now(): number {
    return this.platform.clock.now()
  }

  /** Aborted when the connection has ended for good. */
  get ended(): AbortSignal {
    return this.ending.signal
  }

  /** The first attempt to connect, which may fail; the loop goes on behind it. */
  async connect(): Promise<void> {
    const transport = await attempt(this.platform, this.settings.commands, this.ended)
    this.run(transport)
  }

  /** Keeps the connection up from now on. */
  run(transport: Transport | null): void {
    if (transport) this.life.connected()
    void this.drive(transport)
  }

  private async drive(first: Transport | null): Promise<void> {
    const tries = new Tries(this.settings.backoff)
    let transport = first ?? (await this.connectAgain(tries))
    while (transport) {
      tries.connected(await this.serve(transport))
      transport = this.life.now.is === 'closed' ? null : await this.connectAgain(tries)
    }
    this.down(true)
  }

  /** Serves one connection until it ends or is closed. Whether the robot was heard over it. */
  private async serve(transport: Transport): Promise<boolean> {
    const link = new Link(this, transport, (frame) => {
      this.arrivals.arrive(frame, link)
    })
    this.up(link)
    this.why = await link.over
    this.log.tell('info', 'connection ended', { why: lossText(this.why) })
    this.link = null
    if (this.life.now.is === 'closed') await link.goodbye()
    else link.cut()
    return link.heard
  }

  /** A new connection, or `null` once there will be none. */
  private async connectAgain(tries: Tries): Promise<Transport | null> {
    for (;;) {
      const wait = tries.next()
      if (wait === null || this.life.now.is === 'closed') return null
      this.down(false)
      if (wait > 0) await pause(this.platform.clock, wait, this.ended)
      if (this.ended.aborted) return null
      try {
        return await attempt(this.platform, this.settings.commands, this.ended)
      } catch (problem) {
        if (this.ended.aborted || !(problem instanceof ConnectError)) return null
        this.why = lossOf(problem)
        tries.failed()
        this.log.tellThinly('warn', 'not connected', { why: lossText(this.why) })
      }
    }
  }

  private up(link: Link): void {
    this.link = link
    // The first connection may have been there, and counted, before.
    if (this.life.now.is !== 'connected') this.life.connected()
    this.log.tell('info', 'connected', { connects: this.life.now.connects })
    this.session.reconnected()
    this.arrivals.begin()
    this.session.endIf((frame, flight) => {
      if (flight.progress !== 'sent') this.send(frame, flight)
      return false
    })
    this.queues.connected()
  }

  /** Ends the calls that must not be sent twice, and keeps the others for the next connection. */
  private down(forGood: boolean): void {
    if (forGood) this.life.close(this.why)
    else {
      if (this.life.now.is === 'connected') this.queues.lost(this.why)
      this.life.lost(this.why)
    }
    const { now } = this.life
    const over = now.is === 'closed'
    const why = now.is === 'connected' ? this.why : now.why
    const ended = this.session.endIf((_, flight) => {
      if (flight.repeat && flight.progress === 'sent') flight.progress = 'again'
      return over || flight.progress === 'sent'
    })
    for (const { token } of ended)
      token.failed(new CallError(token.progress === 'unsent' ? 'closed' : 'lost', { loss: why }))
    if (!over) return
    this.ending.abort()
    this.alarm.stop()
    this.queues.wake()
  }

  private expire(): void {
    for (const { is, token } of this.session.due(this.now)) {
      if (is === 'again') continue
      this.counters.timeouts++
      const { now } = this.life
      if (now.is === 'connected') token.failed(new CallError('timeout'))
      else if (token.progress !== 'unsent') token.failed(new CallError('lost', { loss: now.why }))
      else token.failed(new CallError(now.is === 'closed' ? 'closed' : 'not_connected', { loss: now.why }))
    }
  }

  /** Puts a call in flight. Gives what to cancel it with; throws a `CallError` if it cannot be. */
  begin(code: number, timeout: number, flight: Flight): FrameId {
    const { now } = this.life
    if (now.is === 'closed') throw new CallError('closed', { loss: now.why })
    const policy = { timeout, retries: 0 }
    const frame = this.session.open(this.framing.kind('command'), code, policy, this.now, flight)
    if (!frame) {
      this.log.tellThinly('warn', 'too many calls', { code, inFlight: this.settings.limits.inFlight })
      throw new CallError('busy')
    }
    if (this.link) this.send(frame, flight)
    this.alarm.by(this.now + timeout)
    return frame
  }

  /** Sends a call that has waited for a connection, or is new. */
  private send(frame: FrameId, flight: Flight): void {
    const { link } = this
    if (!link) return
    // Once more, and not as often as the connection is lost.
    if (flight.progress === 'again') flight.repeat = false
    flight.progress = 'sent'
    const made = this.framing.encode(frame, flight.body(), this.settings.gzipFrom)
    const go = (bytes: Uint8Array): void => {
      if (bytes.length > this.framing.frameBytes) {
        if (this.session.cancel(frame))
          flight.failed(new CallError('frame', { frame: 'frame_too_long' satisfies ErrorName }))
      } else if (this.link === link) {
        this.counters.bytesOut += bytes.length
        link.outlet.push(bytes)
      }
    }
    soon(made, go)
  }

  /** Nobody waits for a call any more. */
  cancel(frame: FrameId): void {
    this.session.cancel(frame)
  }

  /** Ends the connection for good, if it has not ended. */
  close(): void {
    this.life.close({ is: 'closed_here' })
    this.why = { is: 'closed_here' }
    const { link } = this
    this.down(true)
    link?.end({ is: 'closed_here' })
  }
}
