// Reports on their way to the app: what waits for each of its receivers.

import { Change } from '../alarm.ts'
import type { Loss } from '../loss.ts'

/** A report that has arrived and been read. */
export interface Arrived {
  /** Command code. */
  readonly code: number
  /** Message id. */
  readonly id: number
  /** When it was sent, if it says so. */
  readonly time: number | null
  /** Its name among those of the spec; `null` if the spec does not have it. */
  readonly name: string | null
  /** What it says; its text if the spec does not have it. */
  readonly value: unknown
  /** Bytes of its body. */
  readonly size: number
}

/** What comes to who follows a process. */
export type QueueEvent =
  | { readonly is: 'missed'; readonly count: number }
  | { readonly is: 'lost'; readonly loss: Loss }
  | { readonly is: 'connected' }
  | { readonly is: 'report'; readonly report: Arrived }

/** What a receiver has not got, between one report and the next. */
interface Before {
  missed: number
  lost: Loss | null
  connected: boolean
}

const nothing = (): Before => ({ missed: 0, lost: null, connected: false })

/** What waits for one receiver. */
export class Queue {
  /** The only code that it takes; `null` for any. */
  readonly code: number | null
  /** Told when something has come. */
  readonly changed: Change = new Change()
  /** Bytes that wait. */
  bytes = 0
  /** Reports that did not fit, since it was last asked. */
  missed = 0
  private readonly reports: { before: Before; report: Arrived }[] = []
  private since: Before = nothing()
  private isCut = false

  /** An empty queue for reports of a code, or of any. */
  constructor(code: number | null) {
    this.code = code
  }

  /** How many reports wait. */
  get length(): number {
    return this.reports.length
  }

  /** Puts a report behind the others. */
  push(report: Arrived): void {
    this.bytes += report.size
    this.reports.push({ before: this.since, report })
    this.since = nothing()
    this.changed.tell()
  }

  /** There was no room for a report. */
  miss(): void {
    this.missed++
    this.since.missed++
  }

  /** The connection has been lost: notes it where the next report will come. */
  cut(loss: Loss): void {
    this.isCut = true
    this.since.lost = loss
    this.since.connected = false
    this.changed.tell()
  }

  /** There is a connection again. */
  joined(): void {
    this.since.connected ||= this.isCut
    this.isCut = false
    this.changed.tell()
  }

  /** The oldest report. */
  pop(): Arrived | null {
    const first = this.reports.shift()
    if (!first) return null
    this.bytes -= first.report.size
    return first.report
  }

  /** What comes next, the reports and what was between them. */
  next(): QueueEvent | null {
    const before = this.reports[0]?.before ?? this.since
    if (before.missed > 0) {
      const count = before.missed
      before.missed = 0
      return { is: 'missed', count }
    }
    if (before.lost) {
      const loss = before.lost
      before.lost = null
      return { is: 'lost', loss }
    }
    if (before.connected) {
      before.connected = false
      return { is: 'connected' }
    }
    const report = this.pop()
    return report ? { is: 'report', report } : null
  }
}

/** A bounded queue for each receiver. */
export class Queues {
  private readonly receivers = new Set<Queue>()
  private readonly limit: number
  private readonly bytesLimit: number

  /** So many reports, and bytes of them, may wait for each. */
  constructor(limit: number, bytesLimit: number) {
    this.limit = limit
    this.bytesLimit = bytesLimit
  }

  /** One more receiver, of reports of this code or of any. */
  enter(code: number | null): Queue {
    const queue = new Queue(code)
    this.receivers.add(queue)
    return queue
  }

  /** It takes no more. */
  leave(queue: Queue): void {
    this.receivers.delete(queue)
    queue.changed.tell()
  }

  /** Whether it still takes reports. */
  has(queue: Queue): boolean {
    return this.receivers.has(queue)
  }

  /**
   * Gives a report to all receivers that have room for it: acknowledge it. Says how many had none; `null` if nobody has got
   * it: leave it to the robot to send it again.
   */
  push(report: Arrived): number | null {
    const asked = [...this.receivers].filter(({ code }) => code === null || code === report.code)
    const takers = asked.filter((queue) => queue.length < this.limit && queue.bytes + report.size <= this.bytesLimit)
    if (takers.length === 0) return null
    for (const queue of asked) if (!takers.includes(queue)) queue.miss()
    for (const queue of takers) queue.push(report)
    return asked.length - takers.length
  }

  /** The connection has been lost. */
  lost(loss: Loss): void {
    for (const queue of this.receivers) queue.cut(loss)
  }

  /** There is a connection again. */
  connected(): void {
    for (const queue of this.receivers) queue.joined()
  }

  /** Wakes all that wait, as when the connection is closed. */
  wake(): void {
    for (const queue of this.receivers) queue.changed.tell()
  }
}
