// The receiving half of an app's connection: reads frames and enforces the timeouts.

import { Alarm, Change } from '../alarm.ts'
import { FrameStream } from '../frames.ts'
import type { Framing, WholeFrame } from '../framing.ts'
import { Flow } from '../outlet.ts'
import type { Clock, Transport } from '../platform.ts'

/** Timeouts of a connection. */
export interface Patience {
  /** Time for a header, from its first byte to its last. */
  readonly header: number
  /** Time without progress inside a frame. */
  readonly stall: number
  /** Bytes in that time that count as progress. */
  readonly least: number
  /** Silence allowed between frames; `null` for any time. */
  readonly idle: number | null
}

/** Events and questions of an inlet. */
export interface InletEvents {
  /** Handles a whole frame. The next one is read when this is done. */
  frame(frame: WholeFrame): Promise<void> | void
  /** Counts received bytes. */
  received(bytes: number): void
  /** No more frames will come, for this reason. Responses can still be sent, unless the connection broke. */
  ended(why: string, isBroken: boolean): void
  /** A timeout has passed. */
  late(why: string): void
  /** Returns `true` if every request has its response. */
  isIdle(): boolean
}

/** Reads frames from an app. */
export class Inlet {
  /** Resolves when reading has ended. */
  readonly over: Promise<void>
  private readonly transport: Transport
  private readonly clock: Clock
  private readonly patience: Patience
  private readonly events: InletEvents
  private readonly stream: FrameStream
  private readonly alarm: Alarm
  private readonly flow: Flow
  private readonly resumed = new Change()
  /** Time of the first byte of an incomplete header. */
  private header: number | null = null
  private frameAt: number
  private reads = true
  private isDeaf = false

  /** Starts reading. */
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

  /** Stops reading. The frame being handled is still finished. */
  stop(why: string): void {
    if (this.isDeaf) return
    this.isDeaf = true
    this.alarm.stop()
    this.resumed.tell()
    this.events.ended(why, false)
  }

  /** Checks the due time again. Call this when it may have changed. */
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
        // Bytes are read to the end, to notice the end, and dropped.
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
      if (frame === null) break
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
      // Time spent in the handler does not count as a stall.
      this.reads = false
      await dealt
      this.reads = true
      this.flow.begin(this.clock.now())
    }
  }
}
