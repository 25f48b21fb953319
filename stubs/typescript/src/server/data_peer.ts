// One app's data connection: frames of raw bytes to and from it.

import { Change } from '../alarm.ts'
import { keys } from '../bodies.ts'
import type { WholeFrame } from '../framing.ts'
import { Outlet, goodbye } from '../outlet.ts'
import type { Transport } from '../platform.ts'
import type { FrameId } from '../session.ts'
import { Inlet } from './inlet.ts'
import { Pace, inflated } from './pace.ts'
import type { Shared } from './shared.ts'
import type { ConnectionId } from './types.ts'

/** Frames waiting for one app, or for the robot, without the one being sent. */
const QUEUE = 4

/** A frame of raw bytes from an app. */
export interface AppStream {
  /** Data connection it came over. */
  readonly connection: ConnectionId
  /** Address of the app. */
  readonly peer: string
  /** Code of the command that the bytes belong to. */
  readonly code: number
  /** Message id of the request that they belong to. */
  readonly id: number
  /** The bytes, not compressed. */
  readonly data: Uint8Array
}

/** The frames of raw bytes that apps send: a short queue. While it is full, apps are not read. */
export class AppStreams implements AsyncIterableIterator<AppStream> {
  private readonly waiting: AppStream[] = []
  private readonly changed = new Change()
  private isOver = false

  /** Queues a frame as soon as there is room. Returns `false` if there is no receiver any more. */
  async put(frame: AppStream): Promise<boolean> {
    while (this.waiting.length >= QUEUE && !this.isOver) await this.changed.wait()
    if (this.isOver) return false
    this.waiting.push(frame)
    this.changed.tell()
    return true
  }

  /** Returns the next frame. */
  async next(): Promise<IteratorResult<AppStream, undefined>> {
    for (;;) {
      const value = this.waiting.shift()
      if (value) {
        this.changed.tell()
        return { done: false, value }
      }
      if (this.isOver) return { done: true, value: undefined }
      await this.changed.wait()
    }
  }

  /** Ends receiving: frames are dropped from now on. */
  close(): void {
    this.isOver = true
    this.changed.tell()
  }

  /** Ends receiving. */
  return(): Promise<IteratorResult<AppStream, undefined>> {
    this.close()
    return Promise.resolve({ done: true, value: undefined })
  }

  /** Returns itself. */
  [Symbol.asyncIterator](): this {
    return this
  }
}

/**
 * App that owns a data connection. The protocol does not identify it; the address does, as long as only one app uses
 * it.
 */
export type Owner = ConnectionId | 'nobody' | 'several'

/** One data connection. */
export class DataPeer {
  /** Its number. */
  readonly id: ConnectionId
  /** Its address. */
  readonly address: string
  /** App that owns it. */
  owner: Owner = 'nobody'
  /** A frame has been received. */
  isHeard = false
  /** Resolves when it has ended. */
  readonly over: Promise<void>
  private readonly shared: Shared
  private readonly transport: Transport
  private readonly outlet: Outlet
  private readonly inlet: Inlet
  private readonly pace = new Pace()
  private waiting = 0
  private readonly changed = new Change()
  private isGone = false
  private resolve: () => void = () => {}

  /** Serves a connection. */
  constructor(shared: Shared, id: ConnectionId, transport: Transport) {
    const { clock } = shared.platform
    const { patience } = shared.settings
    this.shared = shared
    this.id = id
    this.address = transport.remote
    this.transport = transport
    this.over = new Promise((resolve) => {
      this.resolve = resolve
    })
    this.outlet = new Outlet(transport, clock, patience.stall, patience.least, {
      stalled: () => {
        shared.counters.connectionsTimedOut++
        this.end('the app does not read')
      },
      broke: () => {
        this.end('the connection broke')
      },
    })
    this.inlet = new Inlet(
      transport,
      shared.framing,
      clock,
      { ...patience, idle: null },
      {
        frame: (frame) => this.take(frame),
        received: (bytes) => {
          shared.counters.bytesIn += bytes
          shared.weigh()
        },
        ended: (why) => {
          this.end(why)
        },
        late: () => {
          shared.counters.connectionsTimedOut++
        },
        isIdle: () => false,
      },
    )
  }

  /** Bytes held for the peer. */
  get held(): number {
    return this.inlet.pending + this.outlet.unsent
  }

  /** Notes a command connection from the same address. */
  saw(app: ConnectionId): void {
    this.owner = this.owner === 'nobody' || this.owner === app ? app : 'several'
  }

  private async take({ id, data, sent, fault }: WholeFrame): Promise<void> {
    const { shared } = this
    const { clock } = shared.platform
    let rest = 0
    if (fault !== null || data === null || id.response || id.kind !== shared.framing.kind('stream')) {
      shared.counters.badFrames++
      shared.log.tellThinly('warn', 'bad frame', {
        connection: this.id,
        error: fault ?? 'unexpected_frame',
        code: id.code,
      })
      if (!id.response) this.refuse(id)
      rest = this.pace.unusable(shared.now)
    } else {
      this.isHeard = true
      shared.counters.streamFramesIn++
      rest = inflated(data.length - sent)
      const frame = { connection: this.id, peer: this.address, code: id.code, id: id.id, data }
      if (!(await (shared.inbox?.put(frame) ?? false))) shared.counters.streamFramesDropped++
    }
    if (rest <= 0) return
    shared.counters.connectionsPaced++
    await this.changed.until(clock, clock.now() + rest, () => this.isGone)
  }

  /** Refuses a frame that cannot be used. The response is dropped if there is no room for it. */
  private refuse(id: FrameId): void {
    const { bodies, framing, protocol } = this.shared
    if (!bodies.hasResult || this.waiting >= QUEUE) return
    const made = framing.encode(
      { ...id, response: true },
      bodies.writeResponse(protocol.wire.results.protocol, keys, {}),
      null,
    )
    if (!(made instanceof Promise)) this.outlet.push(made)
  }

  /**
   * Queues a frame as soon as there is room, at most for the stall timeout. Returns `false` if there was no room in
   * time.
   */
  async send(bytes: Uint8Array): Promise<boolean> {
    const { clock } = this.shared.platform
    const { stall } = this.shared.settings.patience
    await this.changed.until(clock, clock.now() + stall, () => this.isGone || this.waiting < QUEUE + 1)
    if (this.isGone || this.waiting > QUEUE) return false
    this.waiting++
    this.outlet.push(bytes)
    this.shared.weigh()
    void this.outlet.below(1).then((isSent) => {
      this.waiting = 0
      if (isSent) this.shared.counters.bytesOut += bytes.length
      this.changed.tell()
    })
    this.shared.counters.streamFramesOut++
    return true
  }

  /** Ends the connection after sending the queued frames. */
  end(why: string): void {
    if (this.isGone) return
    this.isGone = true
    this.inlet.stop(why)
    this.changed.tell()
    this.shared.log.tell('info', 'connection ended', { connection: this.id, peer: this.address, port: 'data', why })
    this.shared.leftData(this.id)
    void goodbye(this.transport, this.outlet, this.shared.platform.clock, this.inlet.over).then(this.resolve)
  }

  /** Ends the connection at once. */
  cut(): void {
    this.end('cut off')
    this.outlet.stop()
    this.transport.close()
  }
}
