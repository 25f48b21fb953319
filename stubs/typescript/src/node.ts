// Node.js: sockets, MD5, gzip and the clock.

import * as crypto from 'node:crypto'
import { connect, createServer } from 'node:net'
import type { AddressInfo, Socket } from 'node:net'
import { gzipSync, inflateRawSync } from 'node:zlib'
import type { Algorithms } from './algorithms.ts'
import { deflatedOf } from './gzip.ts'
import { TransportError } from './platform.ts'
import type { Clock, DialOptions, Listener, ListenOptions, ServerPlatform, Transport } from './platform.ts'

/** The digest as a text with one character per byte. Node.js creates it in half the time of a buffer. */
function md5AtOnce(data: Uint8Array): Uint8Array {
  const text = crypto.hash('md5', data, 'binary')
  const digest = new Uint8Array(text.length)
  for (let at = 0; at < digest.length; at++) digest[at] = text.charCodeAt(at)
  return digest
}

/** The result of inflating with `info`. */
interface Inflated {
  /** The plain data. */
  readonly buffer: Uint8Array
  /** The stream, with the number of bytes that it used. */
  readonly engine: { readonly bytesWritten: number }
}

/** The algorithms of Node.js. */
export const nodeAlgorithms: Algorithms = {
  // One step where available, since Node.js 20.12.
  md5: typeof crypto.hash === 'function' ? md5AtOnce : (data) => crypto.createHash('md5').update(data).digest(),
  gzip: (data) => gzipSync(data, { level: 1 }),
  gunzip(member, limit) {
    const deflated = deflatedOf(member)
    if (!deflated) return 'bad_gzip'
    try {
      const options = { maxOutputLength: Math.max(1, limit), info: true }
      // The types do not declare the result of `info`: the number of bytes used.
      const { buffer, engine } = inflateRawSync(deflated, options) as unknown as Inflated
      return engine.bytesWritten === deflated.length ? buffer : 'bad_gzip'
    } catch (problem) {
      return (problem as { code?: unknown }).code === 'ERR_BUFFER_TOO_LARGE' ? 'inflated_too_long' : 'bad_gzip'
    }
  },
}

/** The clock of the machine. */
export const nodeClock: Clock = {
  now: () => performance.now(),
  wallTime: () => Date.now(),
  after(milliseconds, then) {
    // Node.js fires longer timeouts at once.
    const timer = setTimeout(then, Math.min(milliseconds, 2 ** 31 - 1))
    return () => {
      clearTimeout(timer)
    }
  },
}

const reasonOf = (problem: unknown): string => {
  const code = (problem as { code?: unknown }).code
  return typeof code === 'string' ? code : 'EIO'
}

/** A socket that is read only on request. */
class SocketTransport implements Transport {
  readonly remote: string
  private readonly socket: Socket
  private readonly chunks: Uint8Array[] = []
  private ended = false
  private broken: TransportError | null = null
  private reader: { resolve(chunk: Uint8Array | null): void; reject(problem: unknown): void } | null = null

  constructor(socket: Socket, keepalive: number | null) {
    this.socket = socket
    this.remote = socket.remoteAddress ?? ''
    socket.setNoDelay(true)
    // Node.js drops fractions of a second. With 0 the system uses its default.
    if (keepalive !== null) socket.setKeepAlive(true, Math.max(1000, keepalive))
    socket.on('data', (chunk: Uint8Array) => {
      if (this.reader === null) {
        this.chunks.push(chunk)
        socket.pause()
      } else this.give(chunk)
    })
    socket.on('end', () => {
      this.ended = true
      if (this.chunks.length === 0) this.give(null)
    })
    socket.on('error', (problem) => {
      this.fail(new TransportError(reasonOf(problem)))
    })
    socket.on('close', () => {
      this.fail(new TransportError('ECONNABORTED'))
    })
  }

  private give(chunk: Uint8Array | null): void {
    const { reader } = this
    this.reader = null
    reader?.resolve(chunk)
  }

  private fail(problem: TransportError): void {
    this.broken ??= problem
    const { reader } = this
    this.reader = null
    if (this.ended) reader?.resolve(null)
    else reader?.reject(this.broken)
  }

  read(): Promise<Uint8Array | null> {
    const chunk = this.chunks.shift()
    if (chunk) return Promise.resolve(chunk)
    if (this.ended) return Promise.resolve(null)
    if (this.broken) return Promise.reject(this.broken)
    return new Promise((resolve, reject) => {
      this.reader = { resolve, reject }
      if (this.socket.isPaused()) this.socket.resume()
    })
  }

  write(bytes: Uint8Array): Promise<void> {
    if (this.broken) return Promise.reject(this.broken)
    return new Promise((resolve, reject) => {
      this.socket.write(bytes, (problem) => {
        if (problem) reject(new TransportError(reasonOf(problem)))
        else resolve()
      })
    })
  }

  end(): void {
    this.socket.end()
  }

  close(): void {
    this.socket.destroy()
  }
}

/** The platform of Node.js, for app and robot. */
export const nodePlatform: ServerPlatform = {
  algorithms: nodeAlgorithms,
  clock: nodeClock,
  connect: (host: string, port: number, { keepalive, signal }: DialOptions): Promise<Transport> =>
    new Promise((resolve, reject) => {
      const socket = connect({ host, port, allowHalfOpen: true, noDelay: true })
      const giveUp = (): void => {
        socket.destroy()
        reject(new TransportError('ABORTED'))
      }
      signal.addEventListener('abort', giveUp, { once: true })
      socket.once('connect', () => {
        signal.removeEventListener('abort', giveUp)
        socket.removeAllListeners('error')
        resolve(new SocketTransport(socket, keepalive))
      })
      socket.once('error', (problem) => {
        signal.removeEventListener('abort', giveUp)
        reject(new TransportError(reasonOf(problem)))
      })
    }),
  listen: (
    host: string,
    port: number,
    { keepalive }: ListenOptions,
    accept: (transport: Transport) => void,
  ): Promise<Listener> =>
    new Promise((resolve, reject) => {
      const server = createServer({ allowHalfOpen: true, noDelay: true }, (socket) => {
        accept(new SocketTransport(socket, keepalive))
      })
      server.once('error', (problem) => {
        reject(new TransportError(reasonOf(problem)))
      })
      server.listen(port, host, () => {
        server.removeAllListeners('error')
        // The system retries a connection that it could not accept for lack of file descriptors.
        server.on('error', () => {})
        resolve({ port: (server.address() as AddressInfo).port, close: () => void server.close() })
      })
    }),
}
