// The platform that a connection runs on. The caller supplies it: sockets in Node.js, WebSockets in a browser, pipes
// and a virtual clock in a test.

import type { GunzipFault } from './algorithms.ts'

/** A stream of bytes in both directions. */
export interface Transport {
  /** Address of the other side, without its port. */
  readonly remote: string
  /**
   * Returns the next bytes, which must not change afterwards; `null` once the other side has ended. Rejects if the
   * transport broke.
   */
  read(): Promise<Uint8Array | null>
  /** Sends bytes. Resolves when there is room for more. Rejects if the transport broke. */
  write(bytes: Uint8Array): Promise<void>
  /** Ends this direction. Bytes written before still arrive. */
  end(): void
  /** Ends both directions at once. */
  close(): void
}

/**
 * The error of a transport that broke or was not made. `reason` is the platform's name for it, such as `ECONNRESET`.
 */
export class TransportError extends Error {
  /** The name. */
  readonly reason: string

  /** Creates the error for a reason. */
  constructor(reason: string) {
    super(reason)
    this.name = 'TransportError'
    this.reason = reason
  }
}

/** Options of a new connection. */
export interface DialOptions {
  /** Silence before TCP probes the other side, in milliseconds; `null` for no probes. */
  readonly keepalive: number | null
  /** Aborts when the connection is no longer needed. */
  readonly signal: AbortSignal
}

/** Time and timers. */
export interface Clock {
  /** Monotonic time, in milliseconds. */
  now(): number
  /** Milliseconds since 1970. */
  wallTime(): number
  /** Calls `then` after so many milliseconds. Returns a function that cancels this. */
  after(milliseconds: number, then: () => void): () => void
}

/** A value, now or later. */
export type Soon<T> = T | Promise<T>

/** Calls `then` with the value, at once if it is not a promise. */
export function soon<T>(value: Soon<T>, then: (value: T) => void): void {
  if (value instanceof Promise) void value.then(then)
  else then(value)
}

/** MD5 and gzip, synchronous or not. */
export interface PlatformAlgorithms {
  /** The sixteen bytes of the MD5 digest. */
  md5(data: Uint8Array): Uint8Array
  /** Packs into one gzip member. */
  gzip(data: Uint8Array): Soon<Uint8Array>
  /**
   * Unpacks one gzip member, and gives up once the output exceeds `limit` bytes. Bytes after the member, such as zeros
   * or a second member, are `bad_gzip`.
   */
  gunzip(member: Uint8Array, limit: number): Soon<Uint8Array | GunzipFault>
}

/** The platform of an app. */
export interface Platform {
  /** MD5 and gzip. */
  readonly algorithms: PlatformAlgorithms
  /** The clock. */
  readonly clock: Clock
  /** Makes a connection. */
  connect(host: string, port: number, options: DialOptions): Promise<Transport>
}

/** A listening socket. */
export interface Listener {
  /** The port that it listens on. */
  readonly port: number
  /** Accepts no more connections. */
  close(): void
}

/** Options of a listener. */
export interface ListenOptions {
  /** Silence before TCP probes an app, in milliseconds; `null` for no probes. */
  readonly keepalive: number | null
}

/** The platform of a robot. */
export interface ServerPlatform extends Platform {
  /** Accepts connections. */
  listen(host: string, port: number, options: ListenOptions, accept: (transport: Transport) => void): Promise<Listener>
}
