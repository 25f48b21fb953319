// Receivers of reports.

import type { Core } from './core.ts'
import type { Arrived, Queue } from './queues.ts'

/**
 * The reports from its creation on, for `for await`. Each receiver has a separate queue and gets every report. The
 * reports are already acknowledged. The iteration ends with the connection, once the queue is empty.
 */
export class Reports<T> implements AsyncIterableIterator<T> {
  private readonly core: Core
  private readonly queue: Queue
  private readonly read: (report: Arrived) => T

  /**
   * Made by a connection.
   *
   * @internal
   */
  constructor(core: Core, queue: Queue, read: (report: Arrived) => T) {
    this.core = core
    this.queue = queue
    this.read = read
  }

  /** Returns the next report. */
  async next(): Promise<IteratorResult<T, undefined>> {
    for (;;) {
      const report = this.queue.pop()
      if (report) return { done: false, value: this.read(report) }
      if (this.core.life.now.is === 'closed' || !this.core.queues.has(this.queue))
        return { done: true, value: undefined }
      await this.queue.changed.wait()
    }
  }

  /**
   * Returns the number of reports since the last call that did not fit into this queue while another receiver took
   * them.
   */
  missed(): number {
    const { missed } = this.queue
    this.queue.missed = 0
    return missed
  }

  /** Ends receiving. */
  close(): void {
    this.core.queues.leave(this.queue)
  }

  /** Ends receiving. */
  return(): Promise<IteratorResult<T, undefined>> {
    this.close()
    return Promise.resolve({ done: true, value: undefined })
  }

  /** Returns itself. */
  [Symbol.asyncIterator](): this {
    return this
  }
}
