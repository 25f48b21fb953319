// A small protocol for tests of behaviour over time, with a virtual clock, and pipes in place of sockets.

import { setImmediate as turn } from 'node:timers/promises'
import { nodeAlgorithms } from 'fc-protocol/node'
import {
  Connection,
  FrameStream,
  Framing,
  TransportError,
  dial,
  dialLater,
  robotWithoutPorts,
} from 'fc-protocol/runtime'

const struct = (name, fields) => ({ is: 'struct', name, fields })
const field = (key, type, more = {}) => ({ key, type, ...more })
const facts = (name, code) => ({ name, code, title: { zh: name, en: name }, docs: '', spec: '' })

export const State = {
  is: 'enum',
  name: 'State',
  repr: 'u8',
  values: { Idle: 0, Driving: 1, There: 2, Stuck: 3 },
  process: {
    order: 'complete',
    next: [
      [0, [1]],
      [1, [2]],
    ],
    final: [2],
    error: [3],
  },
}

export const Text = struct('Text', { text: field('text', 'string', { length: [0, 1000] }) })
export const Metres = struct('Metres', { metres: field('metres', 'i32') })
export const Progress = struct('Progress', {
  drive: field('drive', 'i32'),
  state: field('state', () => State, { optional: true }),
})

const command = (name, code, effect, request, response, more = {}) => ({
  is: 'command',
  ...facts(name, code),
  effect,
  request,
  response,
  requestExample: () => ({}),
  responseExample: () => ({}),
  errors: {},
  ...more,
})
const report = (name, code, body, more = {}) => ({
  is: 'report',
  ...facts(name, code),
  case: name,
  body,
  acknowledgement: struct('Ack', {}),
  example: () => ({}),
  ...more,
})

export const moved = report('Moved', 300, Metres)
export const progress = report('Progress', 301, Progress, { state: { schema: State, of: ({ state }) => state } })
export const beat = report('Beat', 302, Metres, { cadence: { is: 'every', ms: 1000 } })
export const echo = command('echo', 100, 'read', Text, Text)
export const go = command('go', 200, 'motion', Metres, struct('Done', {}), {
  errors: { Blocked: { code: 10, text: 'blocked' } },
  preconditions: { states: [{ of: State, values: [0] }], after: [] },
})
export const drive = command('drive', 201, 'motion', Metres, struct('Begun', { drive: field('drive', 'i32') }), {
  setsOff: { report: progress, tied: [{ call: (_, answer) => answer.drive, report: (body) => body.drive }] },
})
export const pictures = { is: 'stream', ...facts('pictures', 400), from: 'robot', content: null }
export const scans = { is: 'stream', ...facts('scans', 401), from: 'robot', content: Metres }

const time = field('time', 'i64', { optional: true })
const uint = (role, offset, size) => ({
  offset,
  size,
  type: 'uint',
  role,
  algorithm: null,
  value: 0,
  zeroWhenPlain: false,
})
const bytes = (role, offset, size, algorithm = null) => ({ ...uint(role, offset, size), type: 'bytes', algorithm })
const RESULTS = { success: 0, protocol: 1, timeout: 2, invalid: 3, expired: 4 }

export const results = Object.fromEntries(Object.entries(RESULTS).map(([text, code]) => [text, { code, text }]))

export const wire = {
  name: 'toy',
  host: 'nowhere',
  commandPort: 1,
  dataPort: 2,
  frame: {
    byteOrder: 'big',
    headerLength: 34,
    header: [
      bytes('head', 0, 2),
      uint('kind', 2, 1),
      uint('code', 3, 2),
      uint('id', 5, 4),
      uint('encoding', 9, 1),
      uint('total_length', 10, 4),
      uint('plain_length', 14, 4),
      bytes('digest', 18, 16, 'md5'),
    ],
    requestHead: [0x70, 1],
    responseHead: [0x70, 2],
    kinds: [
      { value: 0, role: 'stream' },
      { value: 1, role: 'command' },
      { value: 2, role: 'reserved' },
      { value: 3, role: 'report' },
    ],
    encodings: [
      { value: 0, role: 'plain' },
      { value: 1, role: 'gzip' },
    ],
  },
  envelope: {
    request: { struct: struct('Request', { time }), time: 'time' },
    response: {
      struct: struct('Response', {
        time,
        code: field('result', 'i32'),
        said: field('said', 'string', { optional: true }),
      }),
      time: 'time',
      code: 'code',
      text: 'said',
    },
  },
  results,
  defaults: {
    callTimeout: 3000,
    handlerTimeout: 2000,
    maxAge: null,
    ack: { timeout: 2000, retries: 3 },
    limits: {
      frameBytes: 65536,
      inflatedBytes: 1 << 20,
      inflateRatio: 256,
      jsonDepth: 64,
      jsonValues: 100_000,
      inFlight: 64,
      queuedReports: 16,
      connections: 64,
    },
  },
}

export const toy = { wire, commands: [echo, go, drive], reports: [moved, progress, beat], streams: [pictures, scans] }
export const service = {
  methods: { echo, go, drive },
  ranges: [{ first: 500, last: 510, method: 'passThrough' }],
  unknown: 'unknown',
}

/** A clock that the test moves. */
export class FakeClock {
  time = 1000
  timers = new Set()

  now() {
    return this.time
  }

  wallTime() {
    return 1_700_000_000_000 + this.time
  }

  after(milliseconds, then) {
    const timer = { at: this.time + Math.max(0, milliseconds), then }
    this.timers.add(timer)
    return () => this.timers.delete(timer)
  }

  /** Moves the clock in one step: due timers fire late. */
  async advance(milliseconds) {
    this.time += milliseconds
    for (;;) {
      const due = [...this.timers].filter(({ at }) => at <= this.time).sort((a, b) => a.at - b.at)
      if (due.length === 0) break
      for (const timer of due) if (this.timers.delete(timer)) timer.then()
      await settle()
    }
    await settle()
  }
}

/** Lets all tasks run as far as possible without time passing. */
export async function settle() {
  for (let turns = 0; turns < 30; turns++) await turn()
}

/** One end of a pipe. It takes `room` bytes before the other end reads. */
class End {
  remote = '127.0.0.1'
  chunks = []
  held = 0
  reader = null
  writers = []
  isEnded = false
  isBroken = false
  other = null
  room

  constructor(room) {
    this.room = room
  }

  take() {
    const chunk = this.chunks.shift()
    this.held -= chunk.length
    for (const writer of this.writers.splice(0)) writer()
    return chunk
  }

  wake() {
    const { reader } = this
    if (!reader) return
    if (this.chunks.length > 0) reader.resolve(this.take())
    else if (this.isBroken) reader.reject(new TransportError('ECONNRESET'))
    else if (this.isEnded) reader.resolve(null)
    else return
    this.reader = null
  }

  read() {
    return new Promise((resolve, reject) => {
      this.reader = { resolve, reject }
      this.wake()
    })
  }

  async write(bytes) {
    const { other } = this
    if (this.isBroken || other.isBroken) throw new TransportError('EPIPE')
    other.chunks.push(bytes)
    other.held += bytes.length
    other.wake()
    while (other.held > other.room && !other.isBroken) await new Promise((resolve) => other.writers.push(resolve))
  }

  end() {
    this.other.isEnded = true
    this.other.wake()
  }

  close() {
    this.isBroken = true
    this.other.isEnded = true
    for (const writer of this.writers.splice(0)) writer()
    this.wake()
    this.other.wake()
  }
}

/** Returns both ends of a pipe. */
export function pipe(room = 1 << 20) {
  const [one, two] = [new End(room), new End(room)]
  one.other = two
  two.other = one
  return [one, two]
}

export const framing = new Framing(wire.frame, wire.defaults.limits, nodeAlgorithms)
export const KINDS = { stream: 0, command: 1, report: 3 }

/** The test's end of a connection: sends frames, and records received ones. */
export class Raw {
  got = []
  isClosed = false
  constructor(end, frames = framing) {
    this.end = end
    this.stream = new FrameStream(frames)
    void this.read()
  }

  async read() {
    try {
      for (;;) {
        const chunk = await this.end.read()
        if (chunk === null) break
        this.stream.push(chunk)
        for (let next = this.stream.next(); next; next = next.fatal ? null : this.stream.next()) this.got.push(next)
      }
    } catch {
      // Closes its end as well.
    }
    this.isClosed = true
  }

  /** Returns the frames received since the last call. */
  take() {
    return this.got.splice(0)
  }

  send(id, body) {
    const data =
      typeof body === 'string'
        ? new TextEncoder().encode(body)
        : body instanceof Uint8Array
          ? body
          : new TextEncoder().encode(JSON.stringify(body))
    return this.sendBytes(framing.encode({ response: false, kind: KINDS.command, code: 100, id: 1, ...id }, data, null))
  }

  async sendBytes(bytes) {
    await this.end.write(bytes).catch(() => {})
  }

  /** Responds to a frame. */
  answer({ id }, body = { result: 0 }) {
    return this.send({ ...id, response: true }, body)
  }
}

/** Returns the body of a frame. */
export const bodyOf = ({ data }) => JSON.parse(new TextDecoder().decode(data))

/** A platform whose connections are pipes: each attempt to connect waits until the test gives it one. */
export class FakePlatform {
  algorithms = nodeAlgorithms
  clock = new FakeClock()
  waiting = []
  pipes = []

  connect(_host, port) {
    return new Promise((resolve, reject) => {
      this.waiting.push({ port, resolve, reject })
      this.match()
    })
  }

  match() {
    while (this.waiting.length > 0 && this.pipes.length > 0) {
      const [attempt, end] = [this.waiting.shift(), this.pipes.shift()]
      if (end instanceof Error) attempt.reject(end)
      else attempt.resolve(end)
    }
  }

  /** Gives this end to the next attempt to connect. */
  give(end) {
    this.pipes.push(end)
    this.match()
  }

  /** Lets the next attempt connect. Returns the other end. */
  join(room) {
    const [theirs, ours] = pipe(room)
    this.give(theirs)
    return new Raw(ours)
  }
}

/** Returns a client over a pipe; the test is its robot. */
export async function client(config = {}) {
  const platform = new FakePlatform()
  const raw = platform.join()
  const connection = new Connection(
    await dial(toy, platform, { firstId: 500, reconnect: { first: 0, longest: 0 }, ...config }),
  )
  return { platform, clock: platform.clock, raw, connection }
}

/** Returns a client that connects in the background. */
export function lazyClient(config = {}) {
  const platform = new FakePlatform()
  return {
    platform,
    clock: platform.clock,
    connection: new Connection(dialLater(toy, platform, { firstId: 500, ...config })),
  }
}

/** Returns a robot; the test is its app. */
export function robot(methods, config = {}, algorithms = nodeAlgorithms) {
  const platform = Object.assign(new FakePlatform(), { algorithms })
  const server = robotWithoutPorts(toy, service, platform, methods, { firstId: 500, ...config })
  const join = (room) => {
    const [theirs, ours] = pipe(room)
    const connection = server.serve(theirs)
    return Object.assign(new Raw(ours), { connection })
  }
  const joinData = (room) => {
    const [theirs, ours] = pipe(room)
    const connection = server.serveData(theirs)
    return Object.assign(new Raw(ours), { connection })
  }
  return { platform, clock: platform.clock, server, join, joinData }
}
