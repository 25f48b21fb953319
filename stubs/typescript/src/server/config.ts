// Configuration of a robot.

import { gzipCheck, limitsCheck } from '../client/config.ts'
import type { Gzip } from '../client/config.ts'
import type { EndedCall } from '../ended.ts'
import type { Log } from '../log.ts'
import type { Effect } from '../operation.ts'
import { callback, duration, flag, group, host, integer, kind, listOf, orNull, rate } from '../settings.ts'
import type { Check } from '../settings.ts'
import type { Limits } from '../wire.ts'
import type { Allowed } from './allow.ts'
import type { Context } from './types.ts'

/** Configuration of a robot; times in milliseconds. An unset value means the protocol's default. */
export interface ServerConfig {
  /** Address to listen on: all addresses unless set. */
  readonly address?: string
  /** Port of commands and reports; 0 for any free port. */
  readonly commandPort?: number
  /** Port of streams; 0 for any free port. */
  readonly dataPort?: number
  /** Time a handler may take before the app gets the result for a timeout. */
  readonly handlerTimeout?: number
  /** Oldest request that is still served, by the time in its envelope; `null` for any. */
  readonly maxAge?: number | null
  /** Limits on everything that grows with the bytes from apps. */
  readonly limits?: Partial<Limits>
  /** Most bytes of reports waiting for one app; unless set, as many as the longest body. */
  readonly queuedBytes?: number
  /** Most connections from one address, at each port: 8 unless set. */
  readonly connectionsPerAddress?: number
  /**
   * Networks that apps may connect from, at both ports, with the effects of the commands that they may call. Once set,
   * all other addresses are refused, and so are commands with another effect. An address does not authenticate the
   * sender.
   */
  readonly allow?: readonly Allowed[]
  /**
   * Most memory that the apps of both ports may occupy, in bytes: 256 MiB unless set. It counts received parts of
   * frames, requests in handlers, and unsent responses, reports and streams. Beyond it, the connection that holds most
   * is closed.
   */
  readonly memory?: number
  /** Most handlers that may still run after their response is no longer awaited: 64 unless set. */
  readonly abandonedHandlers?: number
  /** Message id of the first report on each connection; the time of day unless set. */
  readonly firstId?: number
  /** Compresses responses and reports, for apps that support it; `null`, the default, does not. */
  readonly gzip?: Gzip | null
  /** Verifies the digests of received frames: `true` unless set. */
  readonly verifyDigest?: boolean
  /** Searches for the next frame after invalid bytes, instead of closing the connection: `false` unless set. */
  readonly resync?: boolean
  /** Time for a frame header, from its first byte to its last: 5000 unless set. */
  readonly headerTimeout?: number
  /**
   * Time without progress inside a frame, or while an app has bytes to read, before a connection is closed: 30 000
   * unless set.
   */
  readonly stallTimeout?: number
  /** Least rate that counts as progress, averaged over the stall timeout, in bytes per second: 1024 unless set. */
  readonly leastRate?: number
  /** Time a connection may be silent between frames; `null`, the default, for any time. */
  readonly idleTimeout?: number | null
  /** Silence before TCP probes the app: 30 000 unless set; `null` for no probes. */
  readonly keepalive?: number | null
  /** Receives log messages. Unless set, errors are written to the console. */
  readonly log?: Log
  /**
   * Receives each error of a handler: an exception other than a `Refusal`, also after the timeout, or an invalid
   * response. The error may quote the request; the log has only its class and place. An error in this function is
   * logged.
   */
  readonly onHandlerError?: (error: unknown, context: Context) => void
  /** Receives the end of each call, for metrics. An error in this function is logged. */
  readonly onCall?: (call: EndedCall) => void
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
  resync: flag,
  headerTimeout: duration,
  stallTimeout: duration,
  leastRate: rate,
  idleTimeout: orNull(duration),
  keepalive: orNull(duration),
  log: callback,
  onHandlerError: callback,
  onCall: callback,
})
