// Reports waiting for the app, in a queue for each receiver.

import { Change } from '../alarm.ts'
import type { Loss } from '../loss.ts'

/** A decoded report. */
export interface Arrived {
  /** Command code. */
  readonly code: number
  /** Message id. */
  readonly id: number
  /** Time the report was sent; `null` if it carries no time. */
  readonly time: number | null
  /** Name of the report; `null` if the spec does not declare it. */
  readonly name: string | null
  /** The report's value, or its JSON text if the spec does not declare it. */
  readonly value: unknown
  /** Bytes of its body. */
  readonly size: number
}

/** An event for the receiver that follows a process. */
export type QueueEvent =
  | { readonly is: 'missed'; readonly count: number }
  | { readonly is: 'lost'; readonly loss: Loss }
  | { readonly is: 'connected' }
  | { readonly is: 'report'; readonly report: Arrived }

/** Events between one report and the next. */
interface Before {
  missed: number
  lost: Loss | null
  connected: boolean
}

const nothing = (): Before => ({ missed: 0, lost: null, connected: false })

/** Reports waiting for one receiver. */
export class Queue {
  /** Code of the reports it takes; `null` for all. */
  readonly code: number | null
  /** Fires when a report has arrived. */
  readonly changed: Change = new Change()
  /** Bytes waiting. */
  bytes = 0
  /** Reports that did not fit, since the last query. */
  missed = 0
  private readonly reports: { before: Before; report: Arrived }[] = []
  private since: Before = nothing()
  private isCut = false

  /** Creates an empty queue for reports of one code, or of all. */
  constructor(code: number | null) {
    this.code = code
  }

  /** Number of waiting reports. */
  get length(): number {
    return this.reports.length
  }

  /** Appends a report. */
  push(report: Arrived): void {
    this.bytes += report.size
    this.reports.push({ before: this.since, report })
    this.since = nothing()
    this.changed.tell()
  }

  /** Counts a report without room. */
  miss(): void {
    this.missed++
    this.since.missed++
  }

  /** Notes a lost connection in front of the next report. */
  cut(loss: Loss): void {
    this.isCut = true
    this.since.lost = loss
    this.since.connected = false
    this.changed.tell()
  }

  /** Notes a new connection. */
  joined(): void {
    this.since.connected ||= this.isCut
    this.isCut = false
    this.changed.tell()
  }

  /** Returns the oldest report. */
  pop(): Arrived | null {
    const first = this.reports.shift()
    if (!first) return null
    this.bytes -= first.report.size
    return first.report
  }

  /** Returns the next event: a report, or one that happened before it. */
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

  /** Creates the queues. Limits apply to the number of reports in each queue, and to their bytes. */
  constructor(limit: number, bytesLimit: number) {
    this.limit = limit
    this.bytesLimit = bytesLimit
  }

  /** Adds a receiver for reports of one code, or of all. */
  enter(code: number | null): Queue {
    const queue = new Queue(code)
    this.receivers.add(queue)
    return queue
  }

  /** Removes a receiver. */
  leave(queue: Queue): void {
    this.receivers.delete(queue)
    queue.changed.tell()
  }

  /** Returns `true` if the queue still takes reports. */
  has(queue: Queue): boolean {
    return this.receivers.has(queue)
  }

  /**
   * Gives a report to all receivers with room for it, and returns the number without room. The caller then acknowledges
   * it. Returns `null` if no receiver took it: without an acknowledgement the robot sends it again.
   */
  push(report: Arrived): number | null {
    const asked = [...this.receivers].filter(({ code }) => code === null || code === report.code)
    const takers = asked.filter((queue) => queue.length < this.limit && queue.bytes + report.size <= this.bytesLimit)
    if (takers.length === 0) return null
    for (const queue of asked) if (!takers.includes(queue)) queue.miss()
    for (const queue of takers) queue.push(report)
    return asked.length - takers.length
  }

  /** Notes a lost connection. */
  lost(loss: Loss): void {
    for (const queue of this.receivers) queue.cut(loss)
  }

  /** Notes a new connection. */
  connected(): void {
    for (const queue of this.receivers) queue.joined()
  }

  /** Wakes all receivers, for example when the connection is closed. */
  wake(): void {
    for (const queue of this.receivers) queue.changed.tell()
  }
}
