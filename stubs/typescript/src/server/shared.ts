// State shared by all connections of a robot: settings, counters and the connected apps.

import { Bodies, because, firstIdAt } from '../bodies.ts'
import { withDefaults } from '../defaults.ts'
import { Framing } from '../framing.ts'
import { Logger } from '../log.ts'
import type { LogFields } from '../log.ts'
import type { ServerPlatform, Transport } from '../platform.ts'
import type { Refusal } from '../refusal.ts'
import { callUser, thrownFields } from '../thrown.ts'
import type { Limits, ProtocolOf } from '../wire.ts'
import { Change } from '../alarm.ts'
import { Access } from './allow.ts'
import { serverCheck } from './config.ts'
import type { ServerConfig } from './config.ts'
import { newCounters } from './counters.ts'
import type { ServerCounters } from './counters.ts'
import { DataPeer } from './data_peer.ts'
import type { AppStreams } from './data_peer.ts'
import type { Patience } from './inlet.ts'
import { Peer } from './peer.ts'
import type { Routes } from './routes.ts'
import { PushError } from './types.ts'
import type { Audience, ConnectionId, Context } from './types.ts'

/** Settings with all defaults filled in. */
export interface ServerSettings {
  /** Limits. */
  readonly limits: Limits
  /** Time a handler may take, in milliseconds. */
  readonly handlerTimeout: number
  /** Oldest request that is served, in milliseconds. */
  readonly maxAge: number | null
  /** Most bytes of reports that wait for one app. */
  readonly queuedBytes: number
  /** Most bytes held for apps. */
  readonly memory: number
  /** Most connections from one address, at each port. */
  readonly perAddress: number
  /** Least length of data to compress, in bytes; `null` for no compression. */
  readonly gzipFrom: number | null
  /** Timeouts of a connection. */
  readonly patience: Patience
}

/** Handlers still running after their response is no longer awaited. */
export class Abandoned {
  private readonly limit: number
  private readonly changed = new Change()
  private running = 0

  /** Creates the counter. At most `limit` handlers may run. */
  constructor(limit: number) {
    this.limit = limit
  }

  /** `true` at the limit: then no handler starts that might be abandoned and run on. */
  get isFull(): boolean {
    return this.limit > 0 && this.running >= this.limit
  }

  /** Counts one more. */
  begun(): void {
    this.running++
  }

  /** Notes that one has ended. */
  ended(): void {
    this.running--
    this.changed.tell()
  }

  /** Waits until there is none. */
  async none(): Promise<void> {
    while (this.running > 0) await this.changed.wait()
  }
}

function settle({ defaults }: ProtocolOf['wire'], config: ServerConfig): ServerSettings {
  serverCheck('ServerConfig', config)
  const memory = config.memory ?? 256 << 20
  const given = withDefaults(config.limits ?? {}, defaults.limits)
  // Frames too large for the memory limit are refused. Besides itself, a frame may take up to four times its text.
  const limits = { ...given, frameBytes: Math.min(given.frameBytes, Math.floor((memory / 16) * 3)) }
  const stall = config.stallTimeout ?? 30_000
  const { gzip = null } = config
  return {
    limits,
    memory,
    handlerTimeout: config.handlerTimeout ?? defaults.handlerTimeout,
    maxAge: config.maxAge === undefined ? defaults.maxAge : config.maxAge,
    queuedBytes: config.queuedBytes ?? limits.inflatedBytes,
    perAddress: config.connectionsPerAddress ?? 8,
    gzipFrom: gzip === null ? null : (gzip.fromBytes ?? 1024),
    patience: {
      header: config.headerTimeout ?? 5000,
      stall,
      least: Math.max(1, Math.floor((stall * (config.leastRate ?? 1024)) / 1000)),
      idle: config.idleTimeout ?? null,
    },
  }
}

/** A robot's connections. */
export class Shared {
  /** The protocol. */
  readonly protocol: ProtocolOf
  /** The platform. */
  readonly platform: ServerPlatform
  /** The settings. */
  readonly settings: ServerSettings
  /** Frames. */
  readonly framing: Framing
  /** Bodies. */
  readonly bodies: Bodies
  /** Its methods. */
  readonly routes: Routes
  /** Counters of the robot. */
  readonly counters: ServerCounters = newCounters()
  /** Abandoned handlers. */
  readonly abandoned: Abandoned
  /** Rules for addresses. */
  readonly access: Access
  /** Apps, by their numbers. */
  readonly peers: Map<ConnectionId, Peer> = new Map()
  /** Data connections, by their numbers. */
  readonly dataPeers: Map<ConnectionId, DataPeer> = new Map()
  /** Receiver of the frames that apps send. */
  inbox: AppStreams | null = null
  /** The log. */
  readonly log: Logger
  private readonly config: ServerConfig
  private readonly ending = new Set<Promise<void>>()
  private next = 1
  private isStopping = false

  /** Creates the state of a robot. */
  constructor(protocol: ProtocolOf, platform: ServerPlatform, routes: Routes, config: ServerConfig) {
    this.protocol = protocol
    this.platform = platform
    this.routes = routes
    this.settings = settle(protocol.wire, config)
    this.config = config
    this.log = new Logger(config.log, protocol.wire.name, () => this.now)
    this.access = new Access(config.allow)
    this.framing = new Framing(
      protocol.wire.frame,
      this.settings.limits,
      platform.algorithms,
      config.verifyDigest ?? true,
      config.resync ?? false,
    )
    this.bodies = new Bodies(protocol.wire, platform.clock, this.settings.limits)
    this.abandoned = new Abandoned(config.abandonedHandlers ?? 64)
  }

  /** Monotonic time, in milliseconds. */
  get now(): number {
    return this.platform.clock.now()
  }

  /** The id of the first report on a connection. */
  firstId(): number {
    return this.config.firstId ?? firstIdAt(this.platform.clock.wallTime())
  }

  /** Notes an error of a handler in the log and for the hook. */
  handlerFailed(message: string, problem: unknown, context: Context, fields: LogFields = thrownFields(problem)): void {
    const { connection, id, code } = context
    const name = this.routes.nameOf(code)
    this.log.tellThinly('error', message, { connection, name, code, id, ...fields })
    callUser(
      () => this.config.onHandlerError?.(problem, context),
      (failed) =>
        this.log.tellThinly('error', '`onHandlerError` threw', { connection, code, id, ...thrownFields(failed) }),
    )
  }

  /** Tells the hook that a call which began at `since` has ended. */
  callEnded(code: number, result: string, since: number): void {
    const { onCall } = this.config
    if (!onCall) return
    const call = { operation: this.routes.nameOf(code), result, time: this.now - since }
    callUser(
      () => onCall(call),
      (failed) => this.log.tellThinly('error', '`onCall` threw', thrownFields(failed)),
    )
  }

  /** Returns the refusal of a command that this robot does not implement. */
  notImplemented(code: number, connection: ConnectionId): Refusal {
    this.counters.callsNotImplemented++
    this.log.tellThinly('warn', 'not implemented', { connection, name: this.routes.nameOf(code), code })
    return because(this.protocol.wire.results.protocol, 'not implemented')
  }

  /** Serves a new command connection. Closes it and returns `null` if there are too many. */
  serve(transport: Transport): ConnectionId | null {
    const displaced = this.admit(this.peers, transport, ({ isHeard }) => !isHeard)
    if (displaced === undefined) return null
    displaced?.cut()
    const id = this.next++
    const peer = new Peer(this, id, transport)
    this.peers.set(id, peer)
    for (const data of this.dataPeers.values()) if (data.address === peer.address) data.saw(id)
    this.counters.connections++
    this.log.tell('info', 'connected', { connection: id, peer: peer.address, port: 'command' })
    this.await(peer.over)
    return id
  }

  /** Serves a new data connection. Closes it and returns `null` if there are too many. */
  serveData(transport: Transport): ConnectionId | null {
    // A data connection that only receives counts as active if its address also sends commands.
    const speakers = (): ReadonlySet<string> =>
      new Set([...this.peers.values()].filter(({ isHeard }) => isHeard).map(({ address }) => address))
    const displaced = this.admit(
      this.dataPeers,
      transport,
      ({ isHeard, address }) => !isHeard && !speakers().has(address),
    )
    if (displaced === undefined) return null
    displaced?.cut()
    const id = this.next++
    const peer = new DataPeer(this, id, transport)
    this.dataPeers.set(id, peer)
    for (const app of this.peers.values()) if (app.address === peer.address) peer.saw(app.id)
    this.counters.dataConnections++
    this.log.tell('info', 'connected', { connection: id, peer: peer.address, port: 'data' })
    this.await(peer.over)
    return id
  }

  /**
   * Returns the silent connection that a new one replaces; `null` if there is room, `undefined` if the new one is
   * refused.
   */
  private admit<T extends { readonly address: string }>(
    table: ReadonlyMap<ConnectionId, T>,
    transport: Transport,
    isSilent: (one: T) => boolean,
  ): T | null | undefined {
    if (this.access.effects(transport.remote) === null) {
      this.counters.connectionsForbidden++
      this.log.tellThinly('warn', 'refused: the address is not allowed', { peer: transport.remote })
      transport.close()
      return undefined
    }
    const all = [...table.values()]
    const own = all.filter(({ address }) => address === transport.remote)
    if (!this.isStopping) {
      if (own.length < this.settings.perAddress && all.length < this.settings.limits.connections) return null
      const candidates = (own.length >= this.settings.perAddress ? own : all).filter(isSilent)
      const from = (address: string): number => all.filter((one) => one.address === address).length
      const [first] = candidates.sort((a, b) => from(b.address) - from(a.address))
      if (first) {
        this.counters.connectionsDisplaced++
        return first
      }
    }
    this.counters.connectionsRefused++
    this.log.tellThinly('warn', 'refused: too many connections', { peer: transport.remote })
    transport.close()
    return undefined
  }

  /** Memory held for apps at present, in bytes. */
  get held(): number {
    let sum = 0
    for (const peer of this.peers.values()) sum += peer.held
    for (const peer of this.dataPeers.values()) sum += peer.held
    return sum
  }

  /** Checks the memory limit. Beyond it, closes the connection that holds most. */
  weigh(): void {
    if (this.held <= this.settings.memory) return
    const all = [...this.peers.values(), ...this.dataPeers.values()]
    const most = all.reduce((greatest, one) => (one.held > greatest.held ? one : greatest))
    this.counters.connectionsEvicted++
    this.log.tellThinly('warn', 'closed: memory is short', { connection: most.id, peer: most.address, held: most.held })
    most.cut()
  }

  private await(over: Promise<void>): void {
    this.ending.add(over)
    void over.then(() => this.ending.delete(over))
  }

  /** Removes an app that has left. */
  left(id: ConnectionId): void {
    this.peers.delete(id)
  }

  /** Removes a data connection that has ended. */
  leftData(id: ConnectionId): void {
    this.dataPeers.delete(id)
  }

  /** Returns the receivers of a report. */
  audience(audience: Audience): Peer[] {
    if (audience === 'all') return [...this.peers.values()]
    const peer = this.peers.get(audience)
    if (!peer) throw new PushError('no_connection')
    return [peer]
  }

  /** Returns the receivers of a stream. */
  dataAudience(audience: Audience): DataPeer[] {
    const all = [...this.dataPeers.values()]
    if (audience === 'all') return all
    const direct = this.dataPeers.get(audience)
    if (direct) return [direct]
    const own = all.filter(({ owner }) => owner === audience)
    if (own.length > 0) return own
    const host = this.peers.get(audience)?.address
    const isAnybodys = all.some(({ address, owner }) => address === host && owner === 'several')
    throw new PushError(isAnybodys ? 'ambiguous' : 'no_connection')
  }

  /** Takes no more connections and requests, and lets the present ones finish. Resolves when all have ended. */
  async stop(): Promise<void> {
    this.isStopping = true
    for (const peer of this.peers.values()) peer.drain()
    for (const peer of this.dataPeers.values()) peer.end('the robot ends')
    while (this.ending.size > 0) await Promise.all(this.ending)
    await this.abandoned.none()
  }

  /** Ends all connections at once. */
  abort(): void {
    for (const peer of [...this.peers.values()]) peer.cut()
    for (const peer of [...this.dataPeers.values()]) peer.cut()
    this.inbox?.close()
  }
}
