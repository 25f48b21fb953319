// Waiting: for a time, and for something to change.

import type { Clock } from './platform.ts'

/** Rings when something is due. Most that is due is over before it is: its timer is then moved on when it fires, and not before. */
export class Alarm {
  private readonly clock: Clock
  private readonly due: () => number | null
  private readonly ring: () => void
  private armed: number | null = null
  private cancel: (() => void) | null = null

  /** `due` says when, if anything is, and `ring` is called then. */
  constructor(clock: Clock, due: () => number | null, ring: () => void) {
    this.clock = clock
    this.due = due
    this.ring = ring
  }

  /** What is due may have changed. */
  look(): void {
    const due = this.due()
    if (due !== null) this.by(due)
  }

  /** Something is due then, at the earliest. */
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

  /** Never rings again, unless it is told of something new. */
  stop(): void {
    this.cancel?.()
    this.cancel = null
    this.armed = null
  }
}

/** Something that changes, and those who wait for that. */
export class Change {
  private waiting: (() => void)[] = []

  /** Resolves when it is next told. */
  wait(): Promise<void> {
    return new Promise((resolve) => {
      this.waiting.push(resolve)
    })
  }

  /** Tells all who wait. */
  tell(): void {
    if (this.waiting.length === 0) return
    const { waiting } = this
    this.waiting = []
    for (const resolve of waiting) resolve()
  }

  /** Waits until something holds, for no longer than until a time. Whether it does. */
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

/** Waits so many milliseconds, or until a signal says that nobody does any more. */
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
