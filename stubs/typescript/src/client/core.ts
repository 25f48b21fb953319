// State shared by all handles of a connection: its session, its queues, and the loop that reconnects.

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
import { callUser, thrownFields } from '../thrown.ts'
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
  /** `true` if it may be sent again after the connection was lost. */
  repeat: boolean
  /** `unsent`; `sent`: in flight; `again`: in flight when the connection was lost, to be sent once more. */
  progress: 'unsent' | 'sent' | 'again'
  /** Writes the body; throws a `BodyError`. */
  body(): Uint8Array
  /** Receives the response. */
  answered(frame: WholeFrame): void
  /** Receives the error if there is no response. */
  failed(error: CallError): void
}

/** Settings with all defaults filled in. */
export interface Settings {
  /** Address of the command port. */
  readonly commands: Address
  /** Address of the data port. */
  readonly data: Address
  /** Time a call waits for its response, in milliseconds. */
  readonly callTimeout: number
  /** Waits between attempts to connect; `null` for no reconnecting. */
  readonly backoff: Backoff | null
  /** Time without progress inside a frame, in milliseconds. */
  readonly stallTimeout: number
  /** Least length of data to compress, in bytes; `null` for no compression. */
  readonly gzipFrom: number | null
  /** Limits. */
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

/** A connection without its public interface. */
export class Core {
  /** The protocol. */
  readonly protocol: ProtocolOf
  /** The platform. */
  readonly platform: Platform
  /** The settings. */
  readonly settings: Settings
  /** Frames. */
  readonly framing: Framing
  /** Bodies. */
  readonly bodies: Bodies
  /** State of the connection. */
  readonly life: Life = new Life()
  /** Requests in flight, and reports to recognise when repeated. */
  readonly session: Session<Flight>
  /** Reports waiting for receivers. */
  readonly queues: Queues
  /** Counters of the connection. */
  readonly counters: ClientCounters = newCounters()
  /** The log. */
  readonly log: Logger
  private readonly onCall: ClientConfig['onCall']
  private readonly arrivals: Arrivals
  private readonly alarm: Alarm
  private readonly ending = new AbortController()
  private link: Link | null = null
  private why: Loss = { is: 'not_yet' }

  /** Creates the state, without connecting. */
  constructor(protocol: ProtocolOf, platform: Platform, config: ClientConfig) {
    const { wire } = protocol
    this.protocol = protocol
    this.platform = platform
    this.settings = settle(protocol, config)
    this.log = new Logger(config.log, wire.name, () => this.now)
    this.onCall = config.onCall
    const { limits } = this.settings
    this.framing = new Framing(
      wire.frame,
      limits,
      platform.algorithms,
      config.verifyDigest ?? true,
      config.resync ?? false,
    )
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

  /** Monotonic time, in milliseconds. */
  get now(): number {
    return this.platform.clock.now()
  }

  /** Aborts when the connection has ended for good. */
  get ended(): AbortSignal {
    return this.ending.signal
  }

  /** Makes the first attempt to connect, and rejects if it fails. The loop continues from there. */
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

  /** Serves one connection until it ends or is closed. Returns `true` if the robot sent at least one frame. */
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

  /** Makes a new connection. Returns `null` once there will be none. */
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
    // `dial` has already made and counted the first connection.
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

  /** Ends the calls that must not be sent twice. The others wait for the next connection. */
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

  /** Puts a call in flight. Returns the id to cancel it with. Throws a `CallError` if that is not possible. */
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

  /** Sends a call that is new or has waited for a connection. */
  private send(frame: FrameId, flight: Flight): void {
    const { link } = this
    if (!link) return
    // A call is repeated only once, however often the connection is lost.
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

  /** Tells the hook when a call ends. An aborted `signal` ends it, too. */
  watch(code: number, response: Promise<unknown>, signal: AbortSignal | undefined): void {
    const { onCall } = this
    if (!onCall) return
    const since = this.now
    const operation = this.protocol.commands.find((command) => command.code === code)?.name ?? 'unknown'
    const ended = (result: string): void => {
      const call = { operation, result, time: this.now - since }
      callUser(
        () => onCall(call),
        (failed) => this.log.tellThinly('error', '`onCall` threw', thrownFields(failed)),
      )
    }
    response.then(
      () => {
        ended('success')
      },
      (problem: unknown) => {
        if (problem instanceof CallError) ended(problem.kind)
        else if (signal?.aborted) ended('dropped')
      },
    )
  }

  /** Cancels a call that is no longer awaited. */
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
