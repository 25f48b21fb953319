// History of connection attempts, and the wait before the next one.

import { ConnectError } from './error.ts'
import type { Backoff } from './config.ts'
import { TransportError } from '../platform.ts'
import type { Platform, Transport } from '../platform.ts'
import type { Loss } from '../loss.ts'

/** Upper limit of the wait between two attempts, for any configuration: a day, in milliseconds. */
const LONGEST_WAIT = 24 * 60 * 60 * 1000

/** Computes the wait before each attempt. */
export class Tries {
  private readonly backoff: Backoff | null
  /** `true` before the first attempt, which needs no wait. */
  private first = true
  /** Failed attempts in a row. */
  private failures = 0
  /** Waits since the robot last sent a frame. */
  private waits = 0

  /** Creates the history. `null` allows only the first attempt. */
  constructor(backoff: Backoff | null) {
    this.backoff = backoff
  }

  /** Notes a failed attempt. */
  failed(): void {
    this.failures++
  }

  /** Notes a connection that has ended. If the robot only accepts and closes, the waits grow as for failed attempts. */
  connected(heard: boolean): void {
    this.first = false
    this.failures = 0
    if (heard) this.waits = 0
  }

  /** Returns the time to wait before the next attempt, in milliseconds; `null` to give up. */
  next(): number | null {
    if (this.first) {
      this.first = false
      return 0
    }
    const { backoff } = this
    if (!backoff || (backoff.attempts !== null && this.failures >= backoff.attempts)) return null
    const doubled = backoff.first * 2 ** Math.min(this.waits, 20)
    this.waits++
    return Math.min(doubled, backoff.longest, LONGEST_WAIT) * (1 - 0.25 * Math.random())
  }
}

/** Address to connect to, with options. */
export interface Address {
  /** Name or address of the robot. */
  readonly host: string
  /** Port. */
  readonly port: number
  /** Time for one attempt, in milliseconds. */
  readonly timeout: number
  /** Silence before TCP probes the robot, in milliseconds; `null` for no probes. */
  readonly keepalive: number | null
}

/** Makes one attempt to connect. Rejects with a `ConnectError`, or with `null` if it was ended. */
export async function attempt(platform: Platform, address: Address, ended: AbortSignal): Promise<Transport> {
  const { host, port, timeout, keepalive } = address
  const abort = new AbortController()
  let late = false
  const end = (): void => {
    abort.abort()
  }
  const cancel = platform.clock.after(timeout, () => {
    late = true
    end()
  })
  ended.addEventListener('abort', end, { once: true })
  const over = new Promise<never>((_, reject) => {
    const stop = (): void => {
      reject(new Error('ended'))
    }
    if (abort.signal.aborted) stop()
    else abort.signal.addEventListener('abort', stop, { once: true })
  })
  // The platform may ignore the signal: a connection that comes too late is closed.
  const dialled = (async () => await platform.connect(host, port, { keepalive, signal: abort.signal }))()
  dialled.then(
    (transport) => {
      if (abort.signal.aborted) transport.close()
    },
    () => {},
  )
  try {
    return await Promise.race([dialled, over])
  } catch (problem) {
    if (late) throw new ConnectError('timeout', `${host}:${port}`, '')
    throw new ConnectError('io', `${host}:${port}`, reasonOf(problem))
  } finally {
    cancel()
    ended.removeEventListener('abort', end)
  }
}

/** Returns the platform's description of the error. */
export const reasonOf = (problem: unknown): string =>
  problem instanceof TransportError ? problem.reason : String(problem)

/** Returns the loss for an error of connecting. */
export const lossOf = (error: ConnectError): Loss =>
  error.kind === 'timeout' ? { is: 'connect_timeout' } : { is: 'unreachable', reason: error.reason }

/** Returns the loss for an error of the transport. `heard`: the robot had sent a frame over the connection. */
export function brokenBy(problem: unknown, heard: boolean): Loss {
  const reason = reasonOf(problem)
  // A socket closed with unread data in it is reset.
  const isClosed = ['EPIPE', 'ECONNABORTED', 'ECONNRESET', 'CLOSED'].includes(reason)
  return isClosed && !heard ? { is: 'closed_unheard' } : { is: 'broken', reason }
}
