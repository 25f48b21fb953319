// What is told of what happens.

/** How much it matters. */
export type LogLevel = 'debug' | 'info' | 'warn' | 'error'

/** What goes with a message: names and numbers, never what a body says. */
export type LogFields = Readonly<Record<string, string | number | boolean | null>>

/** Is told what happens. */
export type Log = (level: LogLevel, message: string, fields: LogFields) => void

/** Tells nobody. */
export const silent: Log = () => {}

/** Lines that one cause may write in a minute. */
const LINES = 5
const WINDOW = 60_000

/** A log that a flood does not flood: a few lines a minute of one cause. What is held back is counted, and the next line says so. */
export class Thin {
  private since = Number.NEGATIVE_INFINITY
  private lines = 0
  private held = 0

  /** Whether to write a line now: how many were held back before it; `null` if this one is. */
  line(now: number): number | null {
    if (now - this.since >= WINDOW) {
      this.since = now
      this.lines = 0
    }
    if (this.lines >= LINES) {
      this.held++
      return null
    }
    this.lines++
    const held = this.held
    this.held = 0
    return held
  }
}
