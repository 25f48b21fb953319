// Waiting for a time, or for a change.

import type { Clock } from './platform.ts'

/** Calls back when something is due. Most due times move before they pass, so the timer is reset only when it fires. */
export class Alarm {
  private readonly clock: Clock
  private readonly due: () => number | null
  private readonly ring: () => void
  private armed: number | null = null
  private cancel: (() => void) | null = null

  /** Creates an alarm. `due` returns the next due time, or `null`. `ring` is called at that time. */
  constructor(clock: Clock, due: () => number | null, ring: () => void) {
    this.clock = clock
    this.due = due
    this.ring = ring
  }

  /** Checks the due time again. Call this when it may have changed. */
  look(): void {
    const due = this.due()
    if (due !== null) this.by(due)
  }

  /** Makes sure the alarm checks at this time, at the latest. */
  by(due: number): void {
    if (this.armed !== null && this.armed <= due) return
    this.cancel?.()
    this.armed = due
    this.cancel = this.clock.after(Math.max(0, due - this.clock.now()), () => {
      this.armed = null
      this.cancel = null
      const next = this.due()
      if (next !== null && next <= this.clock.now()) this.ring()
      this.look()
    })
  }

  /** Stops the alarm. A later `by` or `look` starts it again. */
  stop(): void {
    this.cancel?.()
    this.cancel = null
    this.armed = null
  }
}

/** A change that others wait for. */
export class Change {
  private waiting: (() => void)[] = []

  /** Resolves at the next `tell`. */
  wait(): Promise<void> {
    return new Promise((resolve) => {
      this.waiting.push(resolve)
    })
  }

  /** Wakes all waiting callers. */
  tell(): void {
    if (this.waiting.length === 0) return
    const { waiting } = this
    this.waiting = []
    for (const resolve of waiting) resolve()
  }

  /** Waits until `holds` returns true or the deadline passes. Returns the last value of `holds`. */
  async until(clock: Clock, deadline: number, holds: () => boolean): Promise<boolean> {
    let late = false
    const cancel = clock.after(Math.max(0, deadline - clock.now()), () => {
      late = true
      this.tell()
    })
    while (!holds() && !late) await this.wait()
    cancel()
    return holds()
  }
}

/** Waits for `milliseconds`, or until the signal `ended` aborts. */
export function pause(clock: Clock, milliseconds: number, ended: AbortSignal): Promise<void> {
  return new Promise((resolve) => {
    const go = (): void => {
      cancel()
      ended.removeEventListener('abort', go)
      resolve()
    }
    const cancel = clock.after(milliseconds, go)
    ended.addEventListener('abort', go, { once: true })
  })
}
