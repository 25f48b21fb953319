// The log of a client or server.

import { callUser } from './thrown.ts'

/** Severity of a message. */
export type LogLevel = 'debug' | 'info' | 'warn' | 'error'

/** Names and numbers logged with a message, never the content of a body. */
export type LogFields = Readonly<Record<string, string | number | boolean | null>>

/** Receives log messages. */
export type Log = (level: LogLevel, message: string, fields: LogFields) => void

/** Writes only errors to the console: they are bugs of the program. */
const errorsOnly: Log = (level, message, fields) => {
  if (level === 'error') console.error(message, fields)
}

/** Lines that one cause may write in a minute. */
const LINES = 5
const WINDOW = 60_000

/** The lines of one cause. */
class Thin {
  private since = Number.NEGATIVE_INFINITY
  private lines = 0
  private held = 0

  /** Returns the number of lines held back before this one; `null` if this one is held back too. */
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

/** Writes to a log. If the log throws or rejects, the error is ignored. */
export class Logger {
  private readonly log: Log
  private readonly protocol: string
  private readonly now: () => number
  private readonly causes = new Map<string, Thin>()

  /** Writes to this log, or errors to the console. `now` returns monotonic milliseconds. */
  constructor(log: Log | undefined, protocol: string, now: () => number) {
    this.log = log ?? errorsOnly
    this.protocol = protocol
    this.now = now
  }

  /** Writes a line. */
  tell(level: LogLevel, message: string, fields: LogFields = {}): void {
    callUser(
      () => this.log(level, message, { protocol: this.protocol, ...fields }),
      () => {},
    )
  }

  /** Writes a few lines a minute of one message. The next line has the number of those held back. */
  tellThinly(level: LogLevel, message: string, fields: LogFields): void {
    let thin = this.causes.get(message)
    if (!thin) this.causes.set(message, (thin = new Thin()))
    const held = thin.line(this.now())
    if (held !== null) this.tell(level, message, held > 0 ? { ...fields, held } : fields)
  }
}
