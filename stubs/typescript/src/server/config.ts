// What a robot can be told beforehand.

import { gzipCheck, limitsCheck } from '../client/config.ts'
import type { Gzip } from '../client/config.ts'
import type { Log } from '../log.ts'
import type { Effect } from '../operation.ts'
import { callback, duration, flag, group, host, integer, kind, listOf, orNull, rate } from '../settings.ts'
import type { Check } from '../settings.ts'
import type { Limits } from '../wire.ts'
import type { Allowed } from './allow.ts'
import type { Context } from './types.ts'

/** What a robot can be told beforehand; times in milliseconds. Whatever is not set is the protocol's default. */
export interface ServerConfig {
  /** Address to listen at: all of the machine unless set. */
  readonly address?: string
  /** Port of commands and reports; 0 for any that is free. */
  readonly commandPort?: number
  /** Port of streams; 0 for any that is free. */
  readonly dataPort?: number
  /** How long a handler may take before the app is answered with the result of a timeout. */
  readonly handlerTimeout?: number
  /** Oldest request that is still served, by the time in its envelope; `null` for any. */
  readonly maxAge?: number | null
  /** Bounds of everything that grows with what apps send. */
  readonly limits?: Partial<Limits>
  /** Most bytes of reports that wait for one app; as many as the longest body may have, unless set. */
  readonly queuedBytes?: number
  /** Most connections from one address, at each port: 8 unless set. */
  readonly connectionsPerAddress?: number
  /**
   * Networks that apps may connect from, at both ports, and the effects of the commands that they may call; nobody else, once it
   * is set. A command with another effect is refused. An address is no proof of who sends.
   */
  readonly allow?: readonly Allowed[]
  /**
   * How much memory apps may make the robot hold, those of both ports together, in bytes: what has come of frames, requests in the
   * hands of handlers, answers, reports and streams that are not sent yet. 256 MiB unless set. Beyond it, the connection that holds
   * most is closed.
   */
  readonly memory?: number
  /** Most handlers that may run on though nobody waits for their answer: 64 unless set. */
  readonly abandonedHandlers?: number
  /** Message id of the first report on each connection; the time of day unless set. */
  readonly firstId?: number
  /** Compresses responses and reports, for apps known to take it; `null`, the default, does not. */
  readonly gzip?: Gzip | null
  /** Whether to verify the digests of what is received: yes, unless set. */
  readonly verifyDigest?: boolean
  /** Time for a frame header, from its first byte to its last: 5000 unless set. */
  readonly headerTimeout?: number
  /** How long a connection may make no progress in the middle of a frame, or while it has something to read: 30 000. */
  readonly stallTimeout?: number
  /** What is slower, averaged over the stall timeout, is no progress; bytes per second: 1024 unless set. */
  readonly leastRate?: number
  /** How long a connection may be silent in between frames; `null`, the default, for any time. */
  readonly idleTimeout?: number | null
  /** After how much silence TCP asks whether the app is still there, or `null` not to ask: 30 000 unless set. */
  readonly keepalive?: number | null
  /** Is told what happens. Unless set, errors are written to the console. */
  readonly log?: Log
  /**
   * Is called with each error of a handler: what it threw besides a `Refusal`, also after its timeout, or why its response cannot
   * be sent. The error may quote the request; the log has only its class and place. An error of this function is logged.
   */
  readonly onHandlerError?: (error: unknown, context: Context) => void
}

const EFFECTS: Readonly<Record<Effect, true>> = { read: true, config: true, motion: true, unknown: true }
const isEffect = (value: unknown): boolean => typeof value === 'string' && Object.hasOwn(EFFECTS, value)

/** Checks the settings of a server. */
export const serverCheck: Check = group<ServerConfig>({
  address: host,
  commandPort: integer(0, 65_535),
  dataPort: integer(0, 65_535),
  handlerTimeout: duration,
  maxAge: orNull(duration),
  limits: limitsCheck,
  queuedBytes: integer(1),
  connectionsPerAddress: integer(1),
  allow: listOf(
    group<Allowed>({
      network: kind('an address or a network', (value) => typeof value === 'string'),
      effects: kind(
        `"all" or a list of ${Object.keys(EFFECTS).join(', ')}`,
        (value) => value === 'all' || (Array.isArray(value) && value.every(isEffect)),
      ),
    }),
  ),
  memory: integer(1),
  abandonedHandlers: integer(0),
  firstId: integer(0),
  gzip: gzipCheck,
  verifyDigest: flag,
  headerTimeout: duration,
  stallTimeout: duration,
  leastRate: rate,
  idleTimeout: orNull(duration),
  keepalive: orNull(duration),
  log: callback,
  onHandlerError: callback,
})
