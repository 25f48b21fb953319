// What a connection runs on. It is handed in: Node.js has sockets, a browser WebSockets, a test pipes and a clock of its own.

import type { GunzipFault } from './algorithms.ts'

/** A stream of bytes in both directions. */
export interface Transport {
  /** Address of the other side, without its port. */
  readonly remote: string
  /** The next bytes, which must not change afterwards; `null` once the other side sends no more. Rejects if it broke. */
  read(): Promise<Uint8Array | null>
  /** Sends bytes; resolves when there is room for more. Rejects if it broke. */
  write(bytes: Uint8Array): Promise<void>
  /** Sends no more; what has been written still arrives. */
  end(): void
  /** Ends both directions at once. */
  close(): void
}

/** Why a transport broke, or could not be made: the name that the platform has for it, such as `ECONNRESET`. */
export class TransportError extends Error {
  /** The name. */
  readonly reason: string

  /** A break for this reason. */
  constructor(reason: string) {
    super(reason)
    this.name = 'TransportError'
    this.reason = reason
  }
}

/** What a connection is made with. */
export interface DialOptions {
  /** After how much silence the other side is asked whether it is there, in milliseconds; `null` not to ask. */
  readonly keepalive: number | null
  /** Says that nobody waits for it any more. */
  readonly signal: AbortSignal
}

/** Time, and when it is over. */
export interface Clock {
  /** Milliseconds that never go back. */
  now(): number
  /** Milliseconds since 1970. */
  wallTime(): number
  /** Calls back after so many milliseconds, unless what it gives is called before. */
  after(milliseconds: number, then: () => void): () => void
}

/** Something, now or later. */
export type Soon<T> = T | Promise<T>

/** Calls back with the value, at once if it is there. */
export function soon<T>(value: Soon<T>, then: (value: T) => void): void {
  if (value instanceof Promise) void value.then(then)
  else then(value)
}

/** MD5 and gzip, at once or later. */
export interface PlatformAlgorithms {
  /** The sixteen bytes of the MD5 digest. */
  md5(data: Uint8Array): Uint8Array
  /** Packs into one gzip member. */
  gzip(data: Uint8Array): Soon<Uint8Array>
  /**
   * Unpacks one gzip member, and gives up as soon as more than `limit` bytes come out. Bytes behind the member, such as
   * zeros or a second member, are `bad_gzip`.
   */
  gunzip(member: Uint8Array, limit: number): Soon<Uint8Array | GunzipFault>
}

/** What an app runs on. */
export interface Platform {
  /** MD5 and gzip. */
  readonly algorithms: PlatformAlgorithms
  /** Time. */
  readonly clock: Clock
  /** Makes a connection. */
  connect(host: string, port: number, options: DialOptions): Promise<Transport>
}

/** What accepts connections. */
export interface Listener {
  /** The port at which it listens. */
  readonly port: number
  /** Accepts no more. */
  close(): void
}

/** How connections are accepted. */
export interface ListenOptions {
  /** After how much silence an app is asked whether it is there, in milliseconds; `null` not to ask. */
  readonly keepalive: number | null
}

/** What a robot runs on. */
export interface ServerPlatform extends Platform {
  /** Accepts connections. */
  listen(host: string, port: number, options: ListenOptions, accept: (transport: Transport) => void): Promise<Listener>
}
