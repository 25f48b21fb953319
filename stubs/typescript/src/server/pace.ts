// What a connection pays for when its frames make work and cannot be used: for a while nothing is read from it.

/** How much a connection may have decompressed for it beyond what it has sent, in bytes per millisecond. */
const INFLATED = (128 * 1024 * 1024) / 1000

/** What a frame costs that cannot be used, in milliseconds. */
const UNUSABLE = 1

/** So many of these are free, and are so again once the time they cost has passed: an app of another version notices nothing. */
const FREE = 256

/** What one connection has to pay for. */
export class Pace {
  private owed = 0
  private at = 0

  /** How long the connection rests after a frame that could not be used, in milliseconds. */
  unusable(now: number): number {
    this.owed = Math.max(0, this.owed - (now - this.at)) + UNUSABLE
    this.at = now
    return Math.max(0, this.owed - UNUSABLE * FREE)
  }
}

/** How long a connection rests after so many bytes more than it sent were decompressed for it, in milliseconds. */
export const inflated = (surplus: number): number => Math.floor(Math.max(0, surplus) / INFLATED)
