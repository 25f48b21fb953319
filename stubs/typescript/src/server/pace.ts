// The penalty of a connection whose frames cost work and are useless: nothing is read from it for a while.

/** Rate of free decompression beyond the bytes received, in bytes per millisecond. */
const INFLATED = (128 * 1024 * 1024) / 1000

/** Cost of a useless frame, in milliseconds. */
const UNUSABLE = 1

/**
 * Number of useless frames without a penalty. They are free again after the time they cost, so an app of another
 * version does not notice.
 */
const FREE = 256

/** The penalty of one connection. */
export class Pace {
  private owed = 0
  private at = 0

  /** Returns the time the connection rests after a useless frame, in milliseconds. */
  unusable(now: number): number {
    this.owed = Math.max(0, this.owed - (now - this.at)) + UNUSABLE
    this.at = now
    return Math.max(0, this.owed - UNUSABLE * FREE)
  }
}

/** Returns the time a connection rests after decompressing `surplus` bytes more than it sent, in milliseconds. */
export const inflated = (surplus: number): number => Math.floor(Math.max(0, surplus) / INFLATED)
