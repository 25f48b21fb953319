// The receiving half of an app's connection: reads frames, and sees to it that they come in time.

import { Alarm, Change } from '../alarm.ts'
import { FrameStream } from '../frames.ts'
import type { Framing, WholeFrame } from '../framing.ts'
import { Flow } from '../outlet.ts'
import type { Clock, Transport } from '../platform.ts'

/** How long what may take. */
export interface Patience {
  /** For a header, from its first byte to its last. */
  readonly header: number
  /** Without progress in the middle of a frame. */
  readonly stall: number
  /** So many bytes in that time are progress. */
  readonly least: number
  /** Silent in between frames; `null` for any time. */
  readonly idle: number | null
}

/** What an inlet is told, and asks. */
export interface InletEvents {
  /** A whole frame; the next one is read when this has been dealt with. */
  frame(frame: WholeFrame): Promise<void> | void
  /** So many bytes have come. */
  received(bytes: number): void
  /** Nothing comes any more, for this reason; what has been carried out can still be answered, unless it broke. */
  ended(why: string, isBroken: boolean): void
  /** It did not come in time. */
  late(why: string): void
  /** Whether nothing is going on that is not answered. */
  isIdle(): boolean
}

/** Reads frames from an app. */
export class Inlet {
  /** Resolves when nothing is read any more. */
  readonly over: Promise<void>
  private readonly transport: Transport
  private readonly clock: Clock
  private readonly patience: Patience
  private readonly events: InletEvents
  private readonly stream: FrameStream
  private readonly alarm: Alarm
  private readonly flow: Flow
  private readonly resumed = new Change()
  /** The first byte of a header that is not whole yet. */
  private header: number | null = null
  private frameAt: number
  private reads = true
  private isDeaf = false

  /** Begins to read. */
  constructor(transport: Transport, framing: Framing, clock: Clock, patience: Patience, events: InletEvents) {
    this.transport = transport
    this.clock = clock
    this.patience = patience
    this.events = events
    this.stream = new FrameStream(framing)
    this.flow = new Flow(clock.now())
    this.frameAt = clock.now()
    this.alarm = new Alarm(
      clock,
      () => this.due(),
      () => {
        const now = this.clock.now()
        const why =
          this.header !== null && this.header + this.patience.header <= now
            ? 'a header did not come in time'
            : this.stream.pending > 0
              ? 'a frame stalled'
              : 'idle'
        this.events.late(why)
        this.stop(why)
      },
    )
    this.over = this.receive()
    this.alarm.look()
  }

  private due(): number | null {
    if (!this.reads || this.isDeaf) return null
    const { header, stall, idle } = this.patience
    let due = this.header === null ? null : this.header + header
    const by = (at: number): void => {
      due = due === null ? at : Math.min(due, at)
    }
    if (this.stream.pending > 0) by(this.flow.since + stall)
    else if (idle !== null && this.events.isIdle()) by(this.frameAt + idle)
    return due
  }

  /** Bytes of a frame that has begun. */
  get pending(): number {
    return this.stream.pending
  }

  /** Nothing more is read, though more may come. What is being dealt with is. */
  stop(why: string): void {
    if (this.isDeaf) return
    this.isDeaf = true
    this.alarm.stop()
    this.resumed.tell()
    this.events.ended(why, false)
  }

  /** What the alarm looks at may have changed. */
  look(): void {
    this.alarm.look()
  }

  private async receive(): Promise<void> {
    const { stream, transport, events } = this
    try {
      for (;;) {
        const chunk = await transport.read()
        if (chunk === null) {
          const inside = stream.end()
          this.stop(inside ? 'closed inside a frame' : 'closed by the app')
          return
        }
        // Read to the end, so that it is seen; and what comes is nobody's.
        if (this.isDeaf) continue
        events.received(chunk.length)
        const now = this.clock.now()
        if (stream.pending === 0) this.flow.begin(now)
        else this.flow.add(chunk.length, this.patience.least, now)
        stream.push(chunk)
        await this.takeAll()
        if (this.isDeaf) continue
        this.header = stream.isInsideHeader ? (this.header ?? this.clock.now()) : null
        this.alarm.look()
      }
    } catch {
      this.isDeaf = true
      this.alarm.stop()
      events.ended('the connection broke', true)
    }
  }

  private async takeAll(): Promise<void> {
    const { stream } = this
    for (let next = stream.next(); next !== null && !this.isDeaf; next = stream.next()) {
      const frame = next instanceof Promise ? await next : next
      if ('fatal' in frame) {
        this.events.frame({
          id: { response: true, kind: -1, code: 0, id: 0 },
          digest: null,
          data: null,
          sent: 0,
          fault: frame.fatal,
        })
        this.stop(frame.fatal)
        return
      }
      this.header = null
      this.frameAt = this.clock.now()
      const dealt = this.events.frame(frame)
      if (!dealt) continue
      // What could not come meanwhile is not missed.
      this.reads = false
      await dealt
      this.reads = true
      this.flow.begin(this.clock.now())
    }
  }
}
