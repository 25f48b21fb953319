// Browsers: a WebSocket to a bridge in front of the robot, and MD5 and gzip without dependencies.

import { md5 } from './md5.ts'
import { joined } from './frames.ts'
import { deflatedOf } from './gzip.ts'
import { TransportError } from './platform.ts'
import type { Clock, DialOptions, Platform, PlatformAlgorithms, Transport } from './platform.ts'

/** A stream of the platform that transforms bytes. */
interface ByteTransform {
  /** Output. */
  readonly readable: {
    getReader(): { read(): Promise<{ done: boolean; value?: Uint8Array }>; cancel(): Promise<void> }
  }
  /** Input. */
  readonly writable: { getWriter(): { write(bytes: Uint8Array): Promise<void>; close(): Promise<void> } }
}

type MakesTransform = new (format: 'gzip' | 'deflate-raw') => ByteTransform

/** Globals of a browser and of Node.js that the TypeScript settings for Node.js do not declare. */
const globals = globalThis as unknown as {
  readonly CompressionStream: MakesTransform
  readonly DecompressionStream: MakesTransform
  readonly WebSocket: new (url: string) => Socket
}

/** Returns the transform's whole output; `null` beyond the limit. Rejects if the input is not in its format. */
async function through(transform: ByteTransform, data: Uint8Array, limit: number): Promise<Uint8Array | null> {
  const writer = transform.writable.getWriter()
  // The reader gets the error.
  const written = writer.write(data).then(() => writer.close())
  written.catch(() => {})
  const reader = transform.readable.getReader()
  const chunks: Uint8Array[] = []
  let length = 0
  for (;;) {
    const { done, value } = await reader.read()
    if (done || !value) return joined(chunks, length)
    length += value.length
    if (length > limit) {
      await reader.cancel()
      return null
    }
    chunks.push(value)
  }
}

const inflate = (deflated: Uint8Array, limit: number): Promise<Uint8Array | null> =>
  through(new globals.DecompressionStream('deflate-raw'), deflated, limit)

const isDeflated = (data: Uint8Array): Promise<boolean> =>
  inflate(data, Number.POSITIVE_INFINITY).then(
    () => true,
    () => false,
  )

/** An empty deflated stream with one extra byte. */
const TOO_LONG = Uint8Array.of(3, 0, 0)
let isLenient: Promise<boolean> | null = null

/**
 * Returns `true` if deflated data ends before its last byte. Browsers follow the standard and have refused it already.
 * Node.js 20 has not: there, such data still inflates without its last byte.
 */
async function endsEarly(deflated: Uint8Array): Promise<boolean> {
  isLenient ??= isDeflated(TOO_LONG)
  return (await isLenient) && (await isDeflated(deflated.subarray(0, -1)))
}

/** MD5 in TypeScript, gzip by the platform's streams. */
export const webAlgorithms: PlatformAlgorithms = {
  md5,
  gzip: async (data) => (await through(new globals.CompressionStream('gzip'), data, Number.POSITIVE_INFINITY)) ?? data,
  async gunzip(member, limit) {
    const deflated = deflatedOf(member)
    if (!deflated) return 'bad_gzip'
    try {
      const plain = await inflate(deflated, limit)
      if (plain === null) return 'inflated_too_long'
      return (await endsEarly(deflated)) ? 'bad_gzip' : plain
    } catch {
      return 'bad_gzip'
    }
  },
}

/** The clock of the browser. */
export const webClock: Clock = {
  now: () => performance.now(),
  wallTime: () => Date.now(),
  after(milliseconds, then) {
    const timer = setTimeout(then, Math.min(milliseconds, 2 ** 31 - 1))
    return () => {
      clearTimeout(timer)
    }
  },
}

/** The used part of a WebSocket. */
interface Socket {
  binaryType: string
  readonly bufferedAmount: number
  send(bytes: Uint8Array): void
  close(): void
  addEventListener(type: 'open' | 'error' | 'close', listener: () => void): void
  addEventListener(type: 'message', listener: (event: { data: unknown }) => void): void
}

/** Interval for checking if a WebSocket has sent its data, in milliseconds: it has no event for that. */
const LOOK = 10

/** Most bytes waiting to be read. A WebSocket cannot pause the other side, so it is closed beyond this. */
const WAITING = 64 * 1024 * 1024

class SocketTransport implements Transport {
  readonly remote: string
  private readonly socket: Socket
  private chunks: Uint8Array[] = []
  /** Bytes of the chunks. */
  private waiting = 0
  private closed = false
  private broken: TransportError | null = null
  private reader: ((chunk: Uint8Array | null) => void) | null = null

  constructor(socket: Socket, remote: string) {
    this.socket = socket
    this.remote = remote
    socket.addEventListener('message', ({ data }) => {
      if (!(data instanceof ArrayBuffer)) return
      const chunk = new Uint8Array(data)
      if (this.reader) this.give(chunk)
      else this.keep(chunk)
    })
    socket.addEventListener('close', () => {
      this.closed = true
      this.give(null)
    })
  }

  private give(chunk: Uint8Array | null): void {
    const { reader } = this
    this.reader = null
    reader?.(chunk)
  }

  private keep(chunk: Uint8Array): void {
    if (this.broken) return
    this.chunks.push(chunk)
    this.waiting += chunk.length
    if (this.waiting <= WAITING) return
    this.broken = new TransportError('UNREAD')
    this.chunks = []
    this.socket.close()
  }

  read(): Promise<Uint8Array | null> {
    if (this.broken) return Promise.reject(this.broken)
    const chunk = this.chunks.shift()
    this.waiting -= chunk?.length ?? 0
    if (chunk || this.closed) return Promise.resolve(chunk ?? null)
    return new Promise((resolve) => {
      this.reader = resolve
    })
  }

  async write(bytes: Uint8Array): Promise<void> {
    if (this.closed) throw new TransportError('CLOSED')
    this.socket.send(bytes)
    while (this.socket.bufferedAmount > 0 && !this.closed) {
      await new Promise<void>((resolve) => {
        setTimeout(resolve, LOOK)
      })
    }
  }

  end(): void {
    this.socket.close()
  }

  close(): void {
    this.socket.close()
  }
}

/**
 * Returns the platform of a browser, which cannot open sockets. `url` returns the address of a WebSocket for a host and
 * port. A bridge behind it forwards the bytes of each message to the robot's port.
 */
export function webPlatform(url: (host: string, port: number) => string): Platform {
  return {
    algorithms: webAlgorithms,
    clock: webClock,
    connect: (host: string, port: number, { signal }: DialOptions): Promise<Transport> =>
      new Promise((resolve, reject) => {
        const socket = new globals.WebSocket(url(host, port))
        socket.binaryType = 'arraybuffer'
        signal.addEventListener('abort', () => {
          socket.close()
          reject(new TransportError('ABORTED'))
        })
        socket.addEventListener('open', () => {
          resolve(new SocketTransport(socket, host))
        })
        socket.addEventListener('error', () => {
          reject(new TransportError('UNREACHABLE'))
        })
      }),
  }
}
