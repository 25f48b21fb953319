// Configuration of a client.

import type { EndedCall } from '../ended.ts'
import type { Log } from '../log.ts'
import { callback, duration, flag, group, host, integer, kind, orNull } from '../settings.ts'
import type { Check } from '../settings.ts'
import type { Limits } from '../wire.ts'

/** Waits between attempts to connect; times in milliseconds. */
export interface Backoff {
  /** The first wait. */
  readonly first: number
  /** The longest wait. Each wait is twice the one before, minus a random part of up to a quarter. */
  readonly longest: number
  /** Failed attempts in a row after which the client gives up; `null` for never. */
  readonly attempts: number | null
}

/** Default waits. */
export const defaultBackoff: Backoff = { first: 100, longest: 10_000, attempts: null }

/** Settings for compressing sent data. */
export interface Gzip {
  /** Least length of the data that is compressed, in bytes; 1024 unless set. */
  readonly fromBytes?: number
}

/** Configuration of a client; times in milliseconds. An unset value means the protocol's default. */
export interface ClientConfig {
  /** Name or address of the robot. */
  readonly host?: string
  /** Port of commands and reports. */
  readonly commandPort?: number
  /** Port of streams. */
  readonly dataPort?: number
  /** Time for one attempt to connect: 3000 unless set. */
  readonly connectTimeout?: number
  /** Time a call waits for its response, including reconnecting. */
  readonly callTimeout?: number
  /** Waits between attempts to connect; `null` to give up at the first loss. */
  readonly reconnect?: Partial<Backoff> | null
  /** Silence before TCP probes the robot: 30 000 unless set; `null` for no probes. */
  readonly keepalive?: number | null
  /**
   * Time without progress inside a frame, or while the robot has bytes to read, before a connection is lost: 10 000
   * unless set.
   */
  readonly stallTimeout?: number
  /** Limits on everything that grows with the bytes from the robot. */
  readonly limits?: Partial<Limits>
  /** Most bytes of reports waiting for the app; unless set, as many as the longest body. */
  readonly queuedBytes?: number
  /** Message id of the first call; the time of day unless set. */
  readonly firstId?: number
  /** Compresses requests, for robots that support it; `null`, the default, does not. */
  readonly gzip?: Gzip | null
  /** Verifies the digests of received frames: `true` unless set. */
  readonly verifyDigest?: boolean
  /** Searches for the next frame after invalid bytes, instead of closing the connection: `false` unless set. */
  readonly resync?: boolean
  /** Receives log messages. Unless set, errors are written to the console. */
  readonly log?: Log
  /** Receives the end of each call, for metrics. An error in this function is logged. */
  readonly onCall?: (call: EndedCall) => void
}

/** Options of one call. */
export interface CallOptions {
  /** Time to wait for the response, in milliseconds. */
  readonly timeout?: number
  /**
   * Sends the call again if the connection is lost before its response comes. Unless set, only commands that just read
   * are repeated. Any other command may then run twice.
   */
  readonly repeat?: boolean
  /** Ends the call early: it rejects with the signal's reason. The robot still handles a request that has been sent. */
  readonly signal?: AbortSignal
}

/** Checks `gzip`. */
export const gzipCheck: Check = orNull(group<Gzip>({ fromBytes: integer(0) }))

/** Checks limits. */
export const limitsCheck: Check = group<Limits>({
  frameBytes: integer(1),
  inflatedBytes: integer(1),
  inflateRatio: integer(1),
  jsonDepth: integer(1),
  jsonValues: integer(1),
  inFlight: integer(1),
  queuedReports: integer(1),
  connections: integer(1),
})

/** Checks the settings of a client. */
export const clientCheck: Check = group<ClientConfig>({
  host,
  commandPort: integer(1, 65_535),
  dataPort: integer(1, 65_535),
  connectTimeout: duration,
  callTimeout: duration,
  reconnect: orNull(group<Backoff>({ first: duration, longest: duration, attempts: orNull(integer(0)) })),
  keepalive: orNull(duration),
  stallTimeout: duration,
  limits: limitsCheck,
  queuedBytes: integer(1),
  firstId: integer(0),
  gzip: gzipCheck,
  verifyDigest: flag,
  resync: flag,
  log: callback,
  onCall: callback,
})

const isSignal = (value: unknown): boolean => typeof (value as AbortSignal | null)?.addEventListener === 'function'

/** Checks the options of a call. */
export const callCheck: Check = group<CallOptions>({
  timeout: duration,
  repeat: flag,
  signal: kind('an AbortSignal', isSignal),
})
