// What a client can be told beforehand.

import type { Log } from '../log.ts'
import { callback, duration, flag, group, host, integer, kind, orNull } from '../settings.ts'
import type { Check } from '../settings.ts'
import type { Limits } from '../wire.ts'

/** How to wait between attempts to connect; times in milliseconds. */
export interface Backoff {
  /** The first wait. */
  readonly first: number
  /** The longest wait. Each is twice the one before, minus up to a quarter at random. */
  readonly longest: number
  /** Failed attempts in a row after which the connection is given up; `null`: never. */
  readonly attempts: number | null
}

/** How waits are made unless told otherwise. */
export const defaultBackoff: Backoff = { first: 100, longest: 10_000, attempts: null }

/** When what is sent is compressed. */
export interface Gzip {
  /** Least length of the data that is compressed, in bytes; 1024 unless set. */
  readonly fromBytes?: number
}

/** What a client can be told beforehand; times in milliseconds. Whatever is not set is the protocol's default. */
export interface ClientConfig {
  /** Name or address of the robot. */
  readonly host?: string
  /** Port of commands and reports. */
  readonly commandPort?: number
  /** Port of streams. */
  readonly dataPort?: number
  /** How long one attempt to connect may take: 3000 unless set. */
  readonly connectTimeout?: number
  /** How long a call waits for its response, reconnecting included. */
  readonly callTimeout?: number
  /** How to reconnect, or `null` to give up with the first loss. */
  readonly reconnect?: Partial<Backoff> | null
  /** After how much silence TCP asks whether the robot is still there, or `null` not to ask: 30 000 unless set. */
  readonly keepalive?: number | null
  /** How long a connection may make no progress in the middle of a frame, or while the robot has something to read: 10 000. */
  readonly stallTimeout?: number
  /** Bounds of everything that grows with what the robot sends. */
  readonly limits?: Partial<Limits>
  /** Most bytes of reports that wait for the app; as many as the longest body may have, unless set. */
  readonly queuedBytes?: number
  /** Message id of the first call; the time of day unless set. */
  readonly firstId?: number
  /** Compresses requests, for robots known to take it; `null`, the default, does not. */
  readonly gzip?: Gzip | null
  /** Whether to verify the digests of what is received: yes, unless set. */
  readonly verifyDigest?: boolean
  /** Is told what happens. Unless set, errors are written to the console. */
  readonly log?: Log
}

/** What one call can be told. */
export interface CallOptions {
  /** How long to wait for the response, in milliseconds. */
  readonly timeout?: number
  /**
   * Whether to send the call once more when the connection was lost before its answer came. Unless set, only what merely
   * reads; on anything else it may do it twice.
   */
  readonly repeat?: boolean
  /** Ends the call early: it rejects with the reason of the signal. The robot acts all the same once the request is on its way. */
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
  log: callback,
})

const isSignal = (value: unknown): boolean => typeof (value as AbortSignal | null)?.addEventListener === 'function'

/** Checks the options of a call. */
export const callCheck: Check = group<CallOptions>({
  timeout: duration,
  repeat: flag,
  signal: kind('an AbortSignal', isSignal),
})
