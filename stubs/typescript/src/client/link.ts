// One connection's bytes: reads what comes, and writes what is to be sent.

import { Alarm } from '../alarm.ts'
import { FrameStream } from '../frames.ts'
import type { Framing, WholeFrame } from '../framing.ts'
import type { Loss } from '../loss.ts'
import { Outlet, goodbye } from '../outlet.ts'
import type { Platform, Transport } from '../platform.ts'
import type { Settings } from './core.ts'
import { brokenBy } from './tries.ts'

/** What a frame has to bring beside the stall timeout, in bytes per second: a wrong length must not pass for progress. */
const LEAST_RATE = 16 * 1024

/** What a link counts. */
export interface LinkCounters {
  /** Bytes received. */
  bytesIn: number
  /** Frames that could not be read. */
  badFrames: number
}

/** What a link needs of the connection that it is one of. */
export interface LinkOwner {
  /** Frames. */
  readonly framing: Framing
  /** Time. */
  readonly platform: Pick<Platform, 'clock'>
  /** How long a frame may make no progress. */
  readonly settings: Pick<Settings, 'stallTimeout'>
  /** What has been seen. */
  readonly counters: LinkCounters
}

/** Whether a frame in full counts as stalled though it goes on: on the command port, not on that of streams. */
export interface LinkRules {
  /** Whether it does. */
  readonly whole: boolean
}

/** One connection to the robot. */
export class Link {
  /** What is to be sent. */
  readonly outlet: Outlet
  /** Resolves when the connection has ended, to why. */
  readonly over: Promise<Loss>
  /** At least one frame has come over it. */
  heard = false
  private readonly transport: Transport
  private readonly owner: LinkOwner
  private readonly stream: FrameStream
  private readonly take: (frame: WholeFrame) => Promise<void> | void
  private readonly rules: LinkRules
  private readonly alarm: Alarm
  private readonly read: Promise<void>
  private resolve: (why: Loss) => void = () => {}
  private isOver = false
  /** When the frame that is arriving began, and when bytes of it last came. */
  private begun: { at: number; last: number } | null = null

  /** Hands on each frame to `take`, and reads on when that is done. */
  constructor(
    owner: LinkOwner,
    transport: Transport,
    take: (frame: WholeFrame) => Promise<void> | void,
    rules: LinkRules = { whole: true },
  ) {
    const { clock } = owner.platform
    this.owner = owner
    this.transport = transport
    this.take = take
    this.rules = rules
    this.stream = new FrameStream(owner.framing)
    this.over = new Promise((resolve) => {
      this.resolve = resolve
    })
    this.outlet = new Outlet(transport, clock, owner.settings.stallTimeout, 1, {
      stalled: () => {
        this.end({ is: 'unread' })
      },
      broke: (problem) => {
        this.end(brokenBy(problem, this.heard))
      },
    })
    this.alarm = new Alarm(
      clock,
      () => this.stallsAt(),
      () => {
        this.end({ is: 'stalled', received: this.stream.pending, total: this.stream.expected })
      },
    )
    this.read = this.receive()
  }

  private stallsAt(): number | null {
    if (!this.begun || this.isOver) return null
    const { stallTimeout } = this.owner.settings
    const still = this.begun.last + stallTimeout
    if (!this.rules.whole) return still
    return Math.min(still, this.begun.at + stallTimeout + (this.stream.pending * 1000) / LEAST_RATE)
  }

  private async receive(): Promise<void> {
    const { stream, transport, owner } = this
    try {
      for (;;) {
        const chunk = await transport.read()
        if (this.isOver) {
          // Only to see that the robot has closed its side, too.
          if (chunk === null) return
          continue
        }
        if (chunk === null) {
          const inside = stream.end()
          this.end(
            inside
              ? { is: 'frame', fault: inside.fatal }
              : this.heard
                ? { is: 'closed_by_robot' }
                : { is: 'closed_unheard' },
          )
          return
        }
        owner.counters.bytesIn += chunk.length
        stream.push(chunk)
        for (let next = stream.next(); next !== null && !this.isOver; next = stream.next()) {
          this.begun = null
          const frame = next instanceof Promise ? await next : next
          if ('fatal' in frame) {
            owner.counters.badFrames++
            this.end({ is: 'frame', fault: frame.fatal })
            break
          }
          this.heard = true
          const taken = this.take(frame)
          if (taken) await taken
        }
        this.watch()
      }
    } catch (problem) {
      this.end(brokenBy(problem, this.heard))
    }
  }

  /** What has come ends inside a frame, or not. */
  private watch(): void {
    if (this.stream.pending === 0) {
      this.begun = null
      return
    }
    const now = this.owner.platform.clock.now()
    this.begun = { at: this.begun?.at ?? now, last: now }
    this.alarm.look()
  }

  /** The connection has ended. The first reason counts. */
  end(why: Loss): void {
    if (this.isOver) return
    this.isOver = true
    this.alarm.stop()
    this.resolve(why)
  }

  /** Ends it at once. */
  cut(): void {
    this.outlet.stop()
    this.transport.close()
  }

  /** Sends what is left first. */
  async goodbye(): Promise<void> {
    await goodbye(this.transport, this.outlet, this.owner.platform.clock, this.read)
  }
}
