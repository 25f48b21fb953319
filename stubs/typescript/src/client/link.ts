// The bytes of one connection: reads received ones and writes those to send.

import { Alarm } from '../alarm.ts'
import { FrameStream } from '../frames.ts'
import type { Framing, WholeFrame } from '../framing.ts'
import type { Loss } from '../loss.ts'
import { Outlet, goodbye } from '../outlet.ts'
import type { Platform, Transport } from '../platform.ts'
import type { Settings } from './core.ts'
import { brokenBy } from './tries.ts'

/**
 * Least rate of a frame, in bytes per second, after a grace of one stall timeout: a wrong length must not pass for
 * progress.
 */
const LEAST_RATE = 16 * 1024

/** Counters of a link. */
export interface LinkCounters {
  /** Bytes received. */
  bytesIn: number
  /** Frames that could not be read. */
  badFrames: number
}

/** The parts of a connection that a link uses. */
export interface LinkOwner {
  /** The framing. */
  readonly framing: Framing
  /** The platform's clock. */
  readonly platform: Pick<Platform, 'clock'>
  /** Time without progress inside a frame. */
  readonly settings: Pick<Settings, 'stallTimeout'>
  /** Counters of the connection. */
  readonly counters: LinkCounters
}

/** Rules for stalled frames, which differ between the command port and the data port. */
export interface LinkRules {
  /** `true` if a frame must keep up the least rate, as on the command port. Otherwise any byte is progress. */
  readonly whole: boolean
}

/** One connection to the robot. */
export class Link {
  /** Bytes to send. */
  readonly outlet: Outlet
  /** Resolves to the reason when the connection has ended. */
  readonly over: Promise<Loss>
  /** At least one frame has been received. */
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
  /** Time the current frame began, and time of its last bytes. */
  private begun: { at: number; last: number } | null = null

  /** Passes each frame to `take`, and reads on when that is done. */
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
          // Reads on only to notice that the robot has closed its side too.
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
          if (frame === null) break
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

  /** Watches the frame that has begun, if any. */
  private watch(): void {
    if (this.stream.pending === 0) {
      this.begun = null
      return
    }
    const now = this.owner.platform.clock.now()
    this.begun = { at: this.begun?.at ?? now, last: now }
    this.alarm.look()
  }

  /** Notes the end of the connection. The first reason counts. */
  end(why: Loss): void {
    if (this.isOver) return
    this.isOver = true
    this.alarm.stop()
    this.resolve(why)
  }

  /** Closes the connection at once. */
  cut(): void {
    this.outlet.stop()
    this.transport.close()
  }

  /** Sends the remaining bytes, then closes the connection. */
  async goodbye(): Promise<void> {
    await goodbye(this.transport, this.outlet, this.owner.platform.clock, this.read)
  }
}
