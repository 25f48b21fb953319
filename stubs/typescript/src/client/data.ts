// An app's connection to the data port: frames of raw bytes in both directions.

// Projects with an older `lib` have no `Symbol.asyncDispose`.
/// <reference lib="esnext.disposable" preserve="true" />

import { Change, pause } from '../alarm.ts'
import { keys } from '../bodies.ts'
import { BodyError } from '../fault.ts'
import type { WholeFrame } from '../framing.ts'
import { lossText } from '../loss.ts'
import type { Loss } from '../loss.ts'
import type { Stream } from '../operation.ts'
import type { Transport } from '../platform.ts'
import { readMessage } from '../read.ts'
import { Refusal } from '../refusal.ts'
import type { Struct } from '../schema.ts'
import { bytesOf, toJson } from '../write.ts'
import type { Core } from './core.ts'
import { ConnectError, DataError } from './error.ts'
import type { DataErrorKind } from './error.ts'
import { Life } from './life.ts'
import type { ConnectionState } from './life.ts'
import { Link } from './link.ts'
import { Subscription, Takers } from './subscription.ts'
import type { StreamFrame } from './subscription.ts'
import { Tries, attempt, lossOf } from './tries.ts'

/** A received frame, or the error reported in its place. */
export type FromData = StreamFrame | DataError

/**
 * A connection to a robot's data port. It is made in the background once the command connection exists, and ends with
 * that. It is made again after a loss and after each new command connection.
 *
 * Frames are not acknowledged and never sent twice. After a loss, frames in flight may or may not have arrived. The
 * loss is reported once to the sender and once to the receiver. Only one frame is queued in each direction, except for
 * subscriptions.
 */
export class DataConnection {
  private readonly core: Core
  private readonly life = new Life()
  private readonly takers = new Takers()
  /** Fires when a frame has arrived or has been taken. */
  private readonly changed = new Change()
  private readonly ending = new AbortController()
  private link: Link | null = null
  /** The received frame or error not yet taken. */
  private inbox: FromData | null = null
  /** A loss to report to the receiver, after the frame in the inbox. */
  private gap: Loss | null = null
  /** A loss to report to the sender, after frames were sent. */
  private unsure: Loss | null = null
  /** `sent`: frames went over this connection. `sending`: one is being sent. */
  private sent = false
  private sending = false
  private turn: Promise<void> = Promise.resolve()

  /**
   * Creates the data connection of a command connection.
   *
   * @internal
   */
  constructor(core: Core) {
    this.core = core
    core.ended.addEventListener('abort', this.follow, { once: true })
    void this.drive()
  }

  /** The present state of the connection, with the reason if there is none. */
  get state(): ConnectionState {
    return this.life.now
  }

  /** Yields the present state, then each change. */
  states(): AsyncGenerator<ConnectionState, void, undefined> {
    return this.life.states()
  }

  /** Waits until the connection has ended for good. Returns the reason. */
  closed(): Promise<Loss> {
    return this.life.closed()
  }

  /**
   * Waits until there is a connection, at most for the call timeout. A robot sends requested data only to existing data
   * connections: call this before the request. Rejects with a `DataError`.
   */
  async connected(): Promise<void> {
    const { clock } = this.core.platform
    await this.life.changed.until(
      clock,
      clock.now() + this.core.settings.callTimeout,
      () => this.life.now.is !== 'connecting',
    )
    const { now } = this.life
    if (now.is !== 'connected') throw new DataError(now.is === 'closed' ? 'closed' : 'not_connected', { loss: now.why })
  }

  /**
   * Returns the next frame without a subscription. Until it is taken, nothing more is read from the robot. Rejects with
   * a `DataError`. After any kind except `closed`, the next call continues with the next frame.
   */
  async recv(): Promise<StreamFrame> {
    for (;;) {
      const taken = this.inbox ?? (this.gap && new DataError('lost', { loss: this.gap }))
      if (taken) {
        if (this.inbox) this.inbox = null
        else this.gap = null
        this.changed.tell()
        if (taken instanceof DataError) throw taken
        return taken
      }
      if (this.life.now.is === 'closed') throw new DataError('closed', { loss: this.life.now.why })
      await this.changed.wait()
    }
  }

  /** Subscribes to the frames of one stream. They get a separate queue and no longer come to `recv`. */
  subscribe<Content>(stream: Stream<Content>): Subscription<Content> {
    const taker = this.takers.enter(stream.code)
    // A frame that waits for room in the inbox may now go to this subscription.
    this.changed.tell()
    const read = ({ data }: StreamFrame): Content => {
      if (stream.content === null) return data as Content
      try {
        return readMessage(stream.content as Struct<Content>, data, this.core.bodies.allowed)
      } catch (problem) {
        throw problem instanceof BodyError ? new DataError('invalid', { body: problem }) : problem
      }
    }
    return new Subscription(this.takers, taker, this.life, read)
  }

  /** Returns the number of frames without a subscription that were dropped since the last call. */
  missed(): number {
    return this.takers.takeSkipped()
  }

  /** Sends a frame of a stream. Rejects with a `DataError`: `invalid` if the content breaks a constraint. */
  async sendStream<Content>(stream: Stream<Content>, id: number, content: Content): Promise<void> {
    if (stream.code === null) throw new TypeError('the stream has no code yet')
    await this.send(stream.code, id, bytesOfContent(stream, content))
  }

  /**
   * Sends a frame of raw bytes. `code` is the command that they belong to, `id` the request that they answer or
   * prepare. Resolves when the transport has taken it. Waits for a connection up to the call timeout. Rejects with a
   * `DataError`: `lost` if this frame, or one before, may not have arrived.
   */
  async send(code: number, id: number, data: Uint8Array): Promise<void> {
    const { framing } = this.core
    framing.checkCode(code)
    framing.checkId(id)
    if (!(data instanceof Uint8Array)) throw new DataError('invalid', { body: new BodyError('wrong_type', 'bytes') })
    const { clock } = this.core.platform
    const deadline = clock.now() + this.core.settings.callTimeout
    const before = this.turn
    let done = (): void => {}
    this.turn = new Promise((resolve) => {
      done = resolve
    })
    try {
      await before
      const frame = { response: false, kind: framing.kind('stream'), code, id }
      const bytes = await framing.encode(frame, data, this.core.settings.gzipFrom)
      if (bytes.length > framing.frameBytes) throw new DataError('frame', { frame: 'frame_too_long' })
      await this.sendBytes(bytes, deadline)
    } finally {
      done()
    }
  }

  private async sendBytes(bytes: Uint8Array, deadline: number): Promise<void> {
    const { clock } = this.core.platform
    await this.life.changed.until(clock, deadline, () => this.life.now.is !== 'connecting' || this.unsure !== null)
    const { now } = this.life
    if (now.is === 'closed') throw new DataError('closed', { loss: now.why })
    if (this.unsure) {
      const loss = this.unsure
      this.unsure = null
      throw new DataError('lost', { loss })
    }
    const { link } = this
    if (now.is !== 'connected' || !link) {
      throw new DataError('not_connected', { loss: now.is === 'connecting' ? now.why : { is: 'not_yet' } })
    }
    this.sent = true
    this.sending = true
    this.core.counters.bytesOut += bytes.length
    link.outlet.push(bytes)
    const isSent = await link.outlet.below(1)
    const loss = isSent ? null : await link.over
    this.sending = false
    if (loss) throw new DataError('lost', { loss })
  }

  /** Closes the connection. A frame being sent is finished if the robot takes it within a second. */
  close(): void {
    const commands = this.core.life.now
    const why: Loss = commands.is === 'closed' ? commands.why : { is: 'closed_here' }
    if (this.life.now.is === 'closed') return
    this.life.close(why)
    this.core.ended.removeEventListener('abort', this.follow)
    this.ending.abort()
    // Wakes the tasks that wait for the command connection.
    this.core.life.changed.tell()
    this.link?.end(why)
    this.changed.tell()
    this.takers.tell()
  }

  /** Closes the connection, for `await using`. */
  async [Symbol.asyncDispose](): Promise<void> {
    this.close()
    await this.closed()
  }

  /** Closes this connection when the command connection has ended for good. */
  private readonly follow = (): void => {
    this.close()
  }

  private get isClosed(): boolean {
    return this.life.now.is === 'closed'
  }

  private async drive(): Promise<void> {
    const tries = new Tries(this.core.settings.backoff)
    for (;;) {
      const wait = tries.next()
      if (wait === null || this.isClosed) break
      if (wait > 0) await pause(this.core.platform.clock, wait, this.ending.signal)
      const number = await this.commandsUp()
      if (this.isClosed) return
      try {
        const transport = await attempt(this.core.platform, this.core.settings.data, this.ending.signal)
        const why = await this.serve(transport, number)
        if (this.isClosed) return
        tries.connected(this.sent || this.wasHeard || why.is === 'renewed')
        this.lose(why)
      } catch (problem) {
        if (this.isClosed || !(problem instanceof ConnectError)) return
        tries.failed()
        this.life.lost(lossOf(problem))
        this.core.log.tellThinly('warn', 'data port not connected', { why: problem.message })
      }
    }
    const { now } = this.life
    if (now.is !== 'closed') this.life.close(now.is === 'connecting' ? now.why : { is: 'not_yet' })
    this.changed.tell()
    this.takers.tell()
  }

  private wasHeard = false

  /** Waits for the command connection. Returns its number. */
  private async commandsUp(): Promise<number> {
    const { life } = this.core
    for (;;) {
      const { now } = life
      if (now.is === 'connected' || this.isClosed) return now.connects
      if (now.is === 'connecting') this.life.lost(now.why)
      await life.changed.wait()
    }
  }

  /** Serves a connection until it ends, or until the command connection has another number. */
  private async serve(transport: Transport, number: number): Promise<Loss> {
    const link = new Link(this.core, transport, (frame) => this.put(frame), { whole: false })
    this.link = link
    this.sent = false
    this.life.connected()
    this.core.log.tell('info', 'data port connected', { connects: this.life.now.connects })
    const commands = this.core.life
    const part = async (): Promise<void> => {
      while (this.link === link && commands.now.is !== 'closed' && commands.now.connects === number)
        await commands.changed.wait()
      link.end({ is: 'renewed' })
    }
    void part()
    const why = await link.over
    this.link = null
    // Wakes the tasks that watch the command connection for this one.
    commands.changed.tell()
    this.wasHeard = link.heard
    this.core.log.tell('info', 'data connection ended', { why: lossText(why) })
    if (this.isClosed) await link.goodbye()
    else link.cut()
    return why
  }

  /** Notes that the connection is lost, with the frames in flight. */
  private lose(why: Loss): void {
    if (this.sent && !this.sending) this.unsure = why
    this.sent = false
    this.gap = why
    this.takers.lost(why)
    this.life.lost(why)
    this.changed.tell()
  }

  /** Delivers a received frame to its subscriptions, or to the inbox as soon as there is room. */
  private async put(frame: WholeFrame): Promise<void> {
    const arrived = this.judge(frame)
    if (this.takers.offer(frame.id.code, arrived)) return
    while ((this.inbox !== null || this.gap !== null) && !this.isClosed) {
      // Subscribers must not wait for a receiver that may not exist.
      if (!this.takers.isEmpty) {
        this.takers.skip()
        return
      }
      await this.changed.wait()
      if (this.takers.offer(frame.id.code, arrived)) return
    }
    if (this.isClosed && this.inbox !== null) return
    this.inbox = arrived
    this.changed.tell()
  }

  private judge({ id, data, fault }: WholeFrame): FromData {
    const error = (kind: DataErrorKind, cause: object = {}): DataError => new DataError(kind, { id, ...cause })
    if (fault !== null || data === null) {
      this.core.counters.badFrames++
      return error('frame', { frame: fault })
    }
    if (!id.response)
      return id.kind === this.core.framing.kind('stream')
        ? { code: id.code, id: id.id, data }
        : error('unexpected_frame')
    try {
      const read = this.core.bodies.readResponse(keys, data)
      return read instanceof Refusal ? error('refused', { refusal: read }) : error('unexpected_frame')
    } catch {
      return error('unexpected_frame')
    }
  }
}

/**
 * Returns the bytes of a stream's frame. Raw bytes are returned unchecked. Throws a `DataError` for an invalid message.
 */
export function bytesOfContent<Content>(stream: Stream<Content>, content: Content): Uint8Array {
  if (stream.content === null) return content as Uint8Array
  try {
    return bytesOf(toJson(stream.content as Struct<Content>, content))
  } catch (problem) {
    throw problem instanceof BodyError ? new DataError('invalid', { body: problem }) : problem
  }
}
