// The session: matches responses to requests, tracks due times, and detects repeated reports.
//
// It has no sockets and no clock. The caller passes in each event with its time in milliseconds, and the session
// returns its meaning. App and robot use the same class: the app opens commands and receives reports, the robot the
// reverse.

/** Identity of a frame. A response has the kind, code and id of its request. */
export interface FrameId {
  /** `true` for a response or an acknowledgement. */
  readonly response: boolean
  /** Kind of frame. */
  readonly kind: number
  /** Command code. */
  readonly code: number
  /** Message id. */
  readonly id: number
}

/** Repetition of a request until its response comes. */
export interface AckPolicy {
  /** Time before the request is sent again, and after the last try, in milliseconds. */
  readonly timeout: number
  /** Number of repetitions after the first try. */
  readonly retries: number
}

/** Configuration of a session. */
export interface SessionConfig {
  /** The kind of reports. */
  readonly report: number
  /** The kind of streams. */
  readonly stream: number
  /** Most requests in flight. */
  readonly inFlight: number
  /** Number of delivered reports to remember. */
  readonly remembers: number
  /** Policy for acknowledgements. A report is remembered for twice the time that its repetitions take. */
  readonly ack: AckPolicy
  /** Id of the first request. */
  readonly firstId: number
  /** Largest id that the header has room for. */
  readonly idMax: number
}

/** The response to a request in flight, which ends with it. */
export interface Answer<T> {
  /** Always this word. */
  is: 'answer'
  /** The token given to `open`. */
  token: T
}

/** A frame that ends no request. */
export interface Arrival {
  /**
   * `late`: a response without a waiting request. `command`: to handle. `report`: to deliver, then pass to `handedOn`,
   * and acknowledge. `repeated`: a report already delivered, only to acknowledge. `stream`: raw bytes.
   */
  is: 'late' | 'command' | 'report' | 'repeated' | 'stream'
}

/** Meaning of a received frame. */
export type Incoming<T> = Answer<T> | Arrival

/** A request that ended without a response, with its token. */
export interface Ended<T> {
  /** The request. */
  frame: FrameId
  /** The token given to `open`. */
  token: T
}

/** A request in flight that is due. */
export interface Due<T> extends Ended<T> {
  /** `again`: to send again with the same id. `expired`: ended without a response. */
  is: 'again' | 'expired'
}

interface Request<T> {
  readonly frame: FrameId
  readonly policy: AckPolicy
  readonly token: T
  due: number
  retriesLeft: number
}

interface Seen {
  readonly frame: FrameId
  readonly digest: string | null
  connection: number
  /** Time of the last arrival. */
  at: number
}

const same = (a: FrameId, b: FrameId): boolean =>
  a.id === b.id && a.code === b.code && a.kind === b.kind && a.response === b.response

/** The state of one peer's exchange with another. Every token comes back exactly once. */
export class Session<T> {
  private readonly config: SessionConfig
  private readonly limit: number
  private readonly remembers: number
  private readonly rememberedFor: number
  private readonly requests = new Map<number, Request<T>>()
  /** Oldest first. */
  private seen: Seen[] = []
  private connection = 0
  private nextId: number

  /** Creates a session without requests. */
  constructor(config: SessionConfig) {
    // A recently used id must not be reused at once, so at most half of all ids are in flight.
    const halfOfIds = Math.floor(config.idMax / 2) + 1
    this.config = config
    this.limit = Math.min(config.inFlight, halfOfIds)
    this.remembers = Math.min(config.remembers, halfOfIds)
    this.rememberedFor = 2 * config.ack.timeout * (config.ack.retries + 1)
    this.nextId = config.firstId % (config.idMax + 1)
  }

  /** Number of requests in flight. */
  get inFlight(): number {
    return this.requests.size
  }

  /** Puts a request in flight and returns its frame id; `null` at the limit. */
  open(kind: number, code: number, policy: AckPolicy, now: number, token: T): FrameId | null {
    if (this.requests.size >= this.limit) return null
    while (this.requests.has(this.nextId)) this.nextId = this.after(this.nextId)
    const frame = { response: false, kind, code, id: this.nextId }
    this.nextId = this.after(this.nextId)
    this.requests.set(frame.id, { frame, policy, token, due: now + policy.timeout, retriesLeft: policy.retries })
    return frame
  }

  private after(id: number): number {
    return id >= this.config.idMax ? 0 : id + 1
  }

  /**
   * Classifies a received frame. `digest` is that of its data. It distinguishes reports from different connections,
   * since a peer that restarts may reuse an id.
   */
  receive(frame: FrameId, digest: string | null, now: number): Incoming<T> {
    if (frame.response) {
      const request = this.take(frame)
      return request ? { is: 'answer', token: request.token } : { is: 'late' }
    }
    if (frame.kind === this.config.stream) return { is: 'stream' }
    if (frame.kind !== this.config.report) return { is: 'command' }
    return { is: this.wasSeen(frame, digest, now) ? 'repeated' : 'report' }
  }

  private wasSeen(frame: FrameId, digest: string | null, now: number): boolean {
    for (let index = this.seen.length - 1; index >= 0; index--) {
      const entry = this.seen[index]
      if (!entry || !same(entry.frame, frame)) continue
      const isRecent = now - entry.at <= this.rememberedFor
      const isSame =
        digest === null || entry.digest === null
          ? isRecent
          : digest === entry.digest || (isRecent && entry.connection === this.connection)
      if (!isSame) continue
      // It may be repeated for the whole period again: its age counts from now.
      this.seen.splice(index, 1)
      this.seen.push({ ...entry, connection: this.connection, at: now })
      return true
    }
    return false
  }

  /** Remembers a delivered report. */
  handedOn(report: FrameId, digest: string | null, now: number): void {
    this.seen.push({ frame: report, digest, connection: this.connection, at: now })
    if (this.seen.length > this.remembers) this.seen.shift()
  }

  /** Notes a new connection: frames from now on come over it. */
  reconnected(): void {
    this.connection++
  }

  /** Ends a request that is no longer awaited. Returns its token; `null` if it has already ended. */
  cancel(frame: FrameId): Ended<T> | null {
    const request = this.take(frame)
    return request ? { frame: request.frame, token: request.token } : null
  }

  private take(frame: FrameId): Request<T> | null {
    const request = this.requests.get(frame.id)
    if (!request || request.frame.kind !== frame.kind || request.frame.code !== frame.code) return null
    this.requests.delete(frame.id)
    return request
  }

  /** Returns the requests that are due, and ends those without tries left. */
  due(now: number): Due<T>[] {
    const due: Due<T>[] = []
    for (const request of this.requests.values()) {
      if (request.due > now) continue
      const { frame, token, policy } = request
      if (request.retriesLeft > 0) {
        request.retriesLeft--
        request.due = now + policy.timeout
        due.push({ is: 'again', frame, token })
      } else {
        this.requests.delete(frame.id)
        due.push({ is: 'expired', frame, token })
      }
    }
    return due
  }

  /** Time the next request is due; `null` for none. */
  get nextDue(): number | null {
    let next: number | null = null
    for (const { due } of this.requests.values()) next = next === null ? due : Math.min(next, due)
    return next
  }

  /** Ends and returns every request in flight for which `ends` returns true, for example after a lost connection. */
  endIf(ends: (frame: FrameId, token: T) => boolean): Ended<T>[] {
    const ended: Ended<T>[] = []
    for (const { frame, token } of this.requests.values()) {
      if (!ends(frame, token)) continue
      this.requests.delete(frame.id)
      ended.push({ frame, token })
    }
    return ended
  }
}
