// How connecting has gone of late.

import { ConnectError } from './error.ts'
import type { Backoff } from './config.ts'
import { TransportError } from '../platform.ts'
import type { Platform, Transport } from '../platform.ts'
import type { Loss } from '../loss.ts'

/** No wait between two attempts to connect is longer, whatever is configured: a day, in milliseconds. */
const LONGEST_WAIT = 24 * 60 * 60 * 1000

/** Says how long to wait before each attempt. */
export class Tries {
  private readonly backoff: Backoff | null
  /** Nothing has been attempted yet: there is nothing to wait for. */
  private first = true
  /** Attempts in a row that did not connect. */
  private failures = 0
  /** Waits since the robot was last heard. */
  private waits = 0

  /** `null`: the first attempt alone. */
  constructor(backoff: Backoff | null) {
    this.backoff = backoff
  }

  /** An attempt has failed. */
  failed(): void {
    this.failures++
  }

  /** An attempt has connected, and the connection has ended. A robot that only accepts and closes is waited for longer. */
  connected(heard: boolean): void {
    this.first = false
    this.failures = 0
    if (heard) this.waits = 0
  }

  /** How long to wait before the next attempt; `null` to give up. */
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

/** Whom to connect to, and how. */
export interface Address {
  /** Name or address of the robot. */
  readonly host: string
  /** Port. */
  readonly port: number
  /** How long one attempt may take. */
  readonly timeout: number
  /** After how much silence the robot is asked whether it is there. */
  readonly keepalive: number | null
}

/** One attempt to connect. Rejects with a `ConnectError`, or with `null` if it was ended. */
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
  // The platform may not look at the signal: a connection that comes too late is closed.
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

/** The platform's word for what went wrong. */
export const reasonOf = (problem: unknown): string =>
  problem instanceof TransportError ? problem.reason : String(problem)

/** Why there is no connection, when it could not be made. */
export const lossOf = (error: ConnectError): Loss =>
  error.kind === 'timeout' ? { is: 'connect_timeout' } : { is: 'unreachable', reason: error.reason }

/** What an error of the transport means on a connection over which the robot was heard, or not. */
export function brokenBy(problem: unknown, heard: boolean): Loss {
  const reason = reasonOf(problem)
  // A socket that is closed while a request lies unread in it is reset.
  const isClosed = ['EPIPE', 'ECONNABORTED', 'ECONNRESET', 'CLOSED'].includes(reason)
  return isClosed && !heard ? { is: 'closed_unheard' } : { is: 'broken', reason }
}
