// Follows a command to its end: the response, then a typed stream of the reports that it set off.

import type { Loss } from '../loss.ts'
import type { Report, StateOf } from '../operation.ts'
import { isError, isFinal, isInOrder } from '../process.ts'
import type { EnumValueOf } from '../schema.ts'
import type { Core } from './core.ts'
import { FollowError } from './error.ts'
import type { Arrived, Queue } from './queues.ts'

/** An event of a process that is being followed. */
export type Followed<Body> =
  /** The process goes on (`going`), has ended with a final state (`ended`), or the report means a failure (`failed`). */
  | { readonly is: 'going' | 'ended' | 'failed'; readonly report: Body }
  /** Number of reports that did not fit into this queue while another receiver took them. */
  | { readonly is: 'missed'; readonly count: number }
  /** The connection was lost. The events continue with the reports after the next connection. */
  | { readonly is: 'interrupted'; readonly loss: Loss }
  /** There is a connection again. Reports in between may be lost, so query the state of the robot. */
  | { readonly is: 'resumed' }

/**
 * The reports that a command sets off, for `for await`. It ends after a final state, a failure or a `FollowError`. If
 * the spec declares no final states and no failures, it continues until it is closed. Reports are acknowledged once
 * queued here. Other receivers get them too.
 */
export class Following<Response, Body> implements AsyncIterableIterator<Followed<Body>> {
  /** The robot's response to the command. */
  readonly answer: Response
  private readonly core: Core
  private readonly queue: Queue
  private readonly report: Report<Body>
  private readonly belongs: (report: Body) => boolean
  private last: EnumValueOf | undefined
  private isOver = false

  /**
   * Made by a call.
   *
   * @internal
   */
  constructor(core: Core, queue: Queue, report: Report<Body>, answer: Response, belongs: (report: Body) => boolean) {
    this.core = core
    this.queue = queue
    this.report = report
    this.answer = answer
    this.belongs = belongs
  }

  /** Returns the next event. Rejects with a `FollowError` once the connection is closed for good. */
  async next(): Promise<IteratorResult<Followed<Body>, undefined>> {
    while (!this.isOver) {
      const event = this.queue.next()
      if (event === null) {
        const { now } = this.core.life
        if (now.is === 'closed') {
          this.close()
          throw new FollowError(now.why)
        }
        await this.queue.changed.wait()
        continue
      }
      const value =
        event.is === 'report'
          ? this.place(event.report)
          : event.is === 'missed'
            ? event
            : event.is === 'lost'
              ? { is: 'interrupted' as const, loss: event.loss }
              : { is: 'resumed' as const }
      if (value === null) continue
      if (value.is === 'ended' || value.is === 'failed') this.close()
      return { done: false, value }
    }
    return { done: true, value: undefined }
  }

  /** Returns a report's meaning for the process; `null` if it belongs to another call. */
  private place({ value }: Arrived): Followed<Body> | null {
    const report = value as Body
    if (!this.belongs(report)) return null
    const { state, failures = [] } = this.report
    const found = state?.of(report)
    if (state && found !== undefined) {
      if (this.last !== undefined && !isInOrder(state.schema, this.last, found)) this.outOfOrder()
      this.last = found
    }
    const fails = ({ schema, of }: StateOf<Body>): boolean => {
      const value = of(report)
      return value !== undefined && isError(schema, value)
    }
    if ((state && fails(state)) || failures.some(fails)) return { is: 'failed', report }
    return { is: state && found !== undefined && isFinal(state.schema, found) ? 'ended' : 'going', report }
  }

  private outOfOrder(): void {
    this.core.counters.reportsOutOfOrder++
    this.core.log.tellThinly('info', 'report out of order', { name: this.report.name, code: this.report.code })
  }

  /** Ends following. */
  close(): void {
    if (this.isOver) return
    this.isOver = true
    this.core.queues.leave(this.queue)
  }

  /** Ends following. */
  return(): Promise<IteratorResult<Followed<Body>, undefined>> {
    this.close()
    return Promise.resolve({ done: true, value: undefined })
  }

  /** Returns itself. */
  [Symbol.asyncIterator](): this {
    return this
  }
}

/** A call of a command that sets off reports. */
export interface FollowableCall<Response, Body> extends Promise<Response> {
  /**
   * Waits for the response, then follows the reports that the command sets off, from the moment it was sent. Call this
   * at once: `client.startDrive(request).follow()`.
   */
  follow(): Promise<Following<Response, Body>>
}
