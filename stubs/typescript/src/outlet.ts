// What is to be sent over a connection: gathered, and written when there is room.

import { Alarm, Change } from './alarm.ts'
import { joined } from './frames.ts'
import type { Clock, Transport } from './platform.ts'

/** What is handed to a transport at once, in bytes. */
const WRITE = 256 * 1024

/**
 * So much, in bytes, goes out before this moment is over: the other side is at work on the first of many frames while the last
 * are still being made.
 */
const EAGER = 4 * 1024

/** Most writes at a time. */
const AT_A_TIME = 4

/** What an outlet is told. */
export interface OutletEvents {
  /** The other side has not taken enough for too long. */
  stalled(): void
  /** The transport broke. */
  broke(problem: unknown): void
}

/** How far something has come since there was enough of it. */
export class Flow {
  /** When there was, or when it began to matter. */
  since: number
  private bytes = 0

  /** Nothing has come. */
  constructor(now: number) {
    this.since = now
  }

  /** It begins again. */
  begin(now: number): void {
    this.since = now
    this.bytes = 0
  }

  /** Bytes have come; so many make progress. */
  add(bytes: number, least: number, now: number): void {
    this.bytes += bytes
    if (this.bytes >= least) this.begin(now)
  }
}

/** The sending half of a connection. */
export class Outlet {
  private readonly transport: Transport
  private readonly clock: Clock
  private readonly least: number
  private readonly events: OutletEvents
  private readonly alarm: Alarm
  private readonly flow: Flow
  private readonly changed = new Change()
  private chunks: Uint8Array[] = []
  private held = 0
  /** Bytes of the chunks. */
  private gathered = 0
  /** Writes that have not ended. */
  private writes = 0
  /** A write has been put off to the end of this moment. */
  private isDue = false
  /** Of a long write not all has been handed to the transport: nothing else may come between. */
  private isSplit = false
  private over = false

  /** `stall`: how long less than `least` bytes may be taken, in milliseconds. */
  constructor(transport: Transport, clock: Clock, stall: number, least: number, events: OutletEvents) {
    this.transport = transport
    this.clock = clock
    this.least = least
    this.events = events
    this.flow = new Flow(clock.now())
    this.alarm = new Alarm(
      clock,
      () => (this.held > 0 && !this.over ? this.flow.since + stall : null),
      () => {
        this.stop()
        events.stalled()
      },
    )
  }

  /** Bytes that have not been taken yet. */
  get unsent(): number {
    return this.held
  }

  /** Sends bytes, with all else that is said at this moment. */
  push(bytes: Uint8Array): void {
    if (this.over) return
    if (this.held === 0) this.flow.begin(this.clock.now())
    this.chunks.push(bytes)
    this.held += bytes.length
    this.gathered += bytes.length
    if (this.gathered >= EAGER && this.writes < AT_A_TIME && !this.isSplit) void this.write()
    else if (!this.isDue && this.writes === 0) {
      this.isDue = true
      queueMicrotask(() => {
        this.isDue = false
        if (this.writes === 0) void this.write()
      })
    }
  }

  private async write(): Promise<void> {
    this.writes++
    try {
      while (this.chunks.length > 0 && !this.over && !this.isSplit) {
        const bytes = this.gather()
        for (let at = 0; at < bytes.length && !this.over; at += WRITE) {
          const piece = bytes.subarray(at, at + WRITE)
          this.isSplit = at + WRITE < bytes.length
          const written = this.transport.write(piece)
          this.alarm.look()
          await written
          this.held -= piece.length
          this.flow.add(piece.length, this.least, this.clock.now())
          this.changed.tell()
        }
      }
    } catch (problem) {
      if (!this.over) {
        this.stop()
        this.events.broke(problem)
      }
    }
    this.writes--
    this.changed.tell()
  }

  private gather(): Uint8Array {
    const { chunks } = this
    this.chunks = []
    this.gathered = 0
    const [only] = chunks
    if (only && chunks.length === 1) return only
    return joined(
      chunks,
      chunks.reduce((sum, { length }) => sum + length, 0),
    )
  }

  /** Resolves once less than so much is unsent, or nothing will be any more. Whether it has been sent. */
  async below(bytes: number): Promise<boolean> {
    while (this.held >= bytes && !this.over) await this.changed.wait()
    return !this.over
  }

  /** Sends nothing any more. */
  stop(): void {
    this.over = true
    this.alarm.stop()
    this.changed.tell()
  }
}

/** How long a closing connection tries to send what is left, and waits for the other side's end; milliseconds. */
const CLOSING = 1000

/**
 * Sends what is left, says that this is all, and waits until the other side has been `read` to its end: for a second, and
 * then it is closed.
 */
export async function goodbye(
  transport: Transport,
  outlet: Outlet,
  clock: Clock,
  read: Promise<unknown>,
): Promise<void> {
  let stop = (): void => {}
  const late = new Promise<void>((resolve) => {
    const cancel = clock.after(CLOSING, resolve)
    stop = () => {
      cancel()
      resolve()
    }
  })
  const leave = async (): Promise<void> => {
    if (await outlet.below(1)) transport.end()
    await read
  }
  await Promise.race([leave().catch(() => {}), late])
  stop()
  outlet.stop()
  transport.close()
}
