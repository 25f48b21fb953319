// What all connections of a robot share: settings, counters, and who is there.

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

/** Settings with nothing left open. */
export interface ServerSettings {
  /** Bounds. */
  readonly limits: Limits
  /** How long a handler may take. */
  readonly handlerTimeout: number
  /** Oldest request that is served. */
  readonly maxAge: number | null
  /** Most bytes of reports that wait for one app. */
  readonly queuedBytes: number
  /** Most bytes that apps may make the robot hold. */
  readonly memory: number
  /** Most connections from one address, at each port. */
  readonly perAddress: number
  /** From which length on data is compressed. */
  readonly gzipFrom: number | null
  /** How long what may take. */
  readonly patience: Patience
}

/** Handlers that run on though nobody waits for their answer any more. */
export class Abandoned {
  private readonly limit: number
  private readonly changed = new Change()
  private running = 0

  /** So many may. */
  constructor(limit: number) {
    this.limit = limit
  }

  /** Whether as many run on as may: no handler that might join them is begun then. */
  get isFull(): boolean {
    return this.limit > 0 && this.running >= this.limit
  }

  /** One more. */
  begun(): void {
    this.running++
  }

  /** One has ended. */
  ended(): void {
    this.running--
    this.changed.tell()
  }

  /** Resolves once there is none. */
  async none(): Promise<void> {
    while (this.running > 0) await this.changed.wait()
  }
}

function settle({ defaults }: ProtocolOf['wire'], config: ServerConfig): ServerSettings {
  serverCheck('ServerConfig', config)
  const memory = config.memory ?? 256 << 20
  const given = withDefaults(config.limits ?? {}, defaults.limits)
  // A frame that could not be dealt with even if it were alone is refused: it may take up to four times its text beside itself.
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
  /** What it runs on. */
  readonly platform: ServerPlatform
  /** What it was told. */
  readonly settings: ServerSettings
  /** Frames. */
  readonly framing: Framing
  /** Bodies. */
  readonly bodies: Bodies
  /** Its methods. */
  readonly routes: Routes
  /** What has been seen. */
  readonly counters: ServerCounters = newCounters()
  /** Handlers that run on. */
  readonly abandoned: Abandoned
  /** From where apps may connect. */
  readonly access: Access
  /** Apps, by their numbers. */
  readonly peers: Map<ConnectionId, Peer> = new Map()
  /** Data connections, by their numbers. */
  readonly dataPeers: Map<ConnectionId, DataPeer> = new Map()
  /** Where frames of apps go. */
  inbox: AppStreams | null = null
  /** Lines for people. */
  readonly log: Logger
  private readonly config: ServerConfig
  private readonly ending = new Set<Promise<void>>()
  private next = 1
  private isStopping = false

  /** Those of a robot. */
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
    )
    this.bodies = new Bodies(protocol.wire, platform.clock, this.settings.limits)
    this.abandoned = new Abandoned(config.abandonedHandlers ?? 64)
  }

  /** Milliseconds that never go back. */
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

  /** The refusal of a command that this robot does not carry out. */
  notImplemented(code: number, connection: ConnectionId): Refusal {
    this.counters.callsNotImplemented++
    this.log.tellThinly('warn', 'not implemented', { connection, name: this.routes.nameOf(code), code })
    return because(this.protocol.wire.results.protocol, 'not implemented')
  }

  /** Serves one more command connection; `null` if there are too many, and it has been closed. */
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

  /** Serves one more data connection; `null` if there are too many, and it has been closed. */
  serveData(transport: Transport): ConnectionId | null {
    // Whoever only receives is known by his commands.
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

  /** Who has to give way to a new connection: nobody (`null`), or one over which nothing has come; `undefined` if it is refused. */
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

  /** How much is held for apps at this moment, in bytes. */
  get held(): number {
    let sum = 0
    for (const peer of this.peers.values()) sum += peer.held
    for (const peer of this.dataPeers.values()) sum += peer.held
    return sum
  }

  /** Something more is held: the connection that holds most goes, if it is too much. */
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

  /** An app has left. */
  left(id: ConnectionId): void {
    this.peers.delete(id)
  }

  /** A data connection has ended. */
  leftData(id: ConnectionId): void {
    this.dataPeers.delete(id)
  }

  /** Whom a report goes to. */
  audience(audience: Audience): Peer[] {
    if (audience === 'all') return [...this.peers.values()]
    const peer = this.peers.get(audience)
    if (!peer) throw new PushError('no_connection')
    return [peer]
  }

  /** Whom a stream goes to. */
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

  /** Takes no more connections and requests, and lets those there are end by themselves. Resolves when they have. */
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
