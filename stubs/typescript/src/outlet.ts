// Outgoing bytes of a connection: gathered, and written when there is room.

import { Alarm, Change } from './alarm.ts'
import { joined } from './frames.ts'
import type { Clock, Transport } from './platform.ts'

/** Most bytes handed to a transport at once. */
const WRITE = 256 * 1024

/**
 * Once this many bytes are gathered, they are written without waiting for the end of the turn. The other side can work
 * on the first of many frames while the last are still being encoded.
 */
const EAGER = 4 * 1024

/** Most writes at a time. */
const AT_A_TIME = 4

/** Events of an outlet. */
export interface OutletEvents {
  /** The other side has not taken enough bytes in time. */
  stalled(): void
  /** The transport broke. */
  broke(problem: unknown): void
}

/** Measures progress since a moment: the bytes that have passed. */
export class Flow {
  /** Start of the period. */
  since: number
  private bytes = 0

  /** Starts at `now` with zero bytes. */
  constructor(now: number) {
    this.since = now
  }

  /** Starts again. */
  begin(now: number): void {
    this.since = now
    this.bytes = 0
  }

  /** Adds bytes; `least` of them count as progress. */
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
  /** A write is scheduled for the end of the turn. */
  private isDue = false
  /** Part of a long write has been handed to the transport: no other bytes may come between. */
  private isSplit = false
  private over = false

  /** Creates the outlet. It stalls if fewer than `least` bytes are taken in `stall` milliseconds. */
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

  /** Number of bytes not yet taken. */
  get unsent(): number {
    return this.held
  }

  /** Sends bytes, together with all others pushed in the same turn. */
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

  /** Waits until fewer than `bytes` bytes are unsent, or the outlet has ended. Returns `false` if it has ended. */
  async below(bytes: number): Promise<boolean> {
    while (this.held >= bytes && !this.over) await this.changed.wait()
    return !this.over
  }

  /** Stops sending. */
  stop(): void {
    this.over = true
    this.alarm.stop()
    this.changed.tell()
  }
}

/** Time a closing connection has to send the rest and to wait for the other side's end, in milliseconds. */
const CLOSING = 1000

/**
 * Sends the rest, closes this direction and waits until the other side has been `read` to its end. After one second the
 * connection is closed in any case.
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
