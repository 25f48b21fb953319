// The session: which answer belongs to which request, what is due, what has been seen before.
//
// It has no sockets and no clock: it is told what happened and what time it is, in milliseconds, and says what that
// means. App and robot use the same machine: the one opens commands and receives reports, the other the reverse.

/** What a frame is about: an answer has the kind, code and id of what it answers. */
export interface FrameId {
  /** Whether it answers a request. */
  readonly response: boolean
  /** Kind of frame. */
  readonly kind: number
  /** Command code. */
  readonly code: number
  /** Message id. */
  readonly id: number
}

/** How an answer is awaited. */
export interface AckPolicy {
  /** How long to wait before sending the request again, and after the last time; milliseconds. */
  readonly timeout: number
  /** How often to send it again. */
  readonly retries: number
}

/** What a session is told beforehand. */
export interface SessionConfig {
  /** The kind of reports. */
  readonly report: number
  /** The kind of streams. */
  readonly stream: number
  /** Most requests in flight. */
  readonly inFlight: number
  /** How many reports that have been handed on are remembered. */
  readonly remembers: number
  /** How acknowledgements are awaited: a report is remembered for twice as long as it may be repeated. */
  readonly ack: AckPolicy
  /** Id of the first request. */
  readonly firstId: number
  /** Largest id that the header has room for. */
  readonly idMax: number
}

/** The answer to a request in flight, which has ended with it. */
export interface Answer<T> {
  /** Always this word. */
  is: 'answer'
  /** What the request was opened with. */
  token: T
}

/** A frame that ends no request. */
export interface Arrival {
  /**
   * `late`: an answer that nobody waits for; `command`: to be handled; `report`: to be handed on, which has to be told,
   * and acknowledged; `repeated`: a report that has been handed on, only to be acknowledged; `stream`: raw bytes.
   */
  is: 'late' | 'command' | 'report' | 'repeated' | 'stream'
}

/** What a frame that has arrived means. */
export type Incoming<T> = Answer<T> | Arrival

/** A request without an answer, and what it was opened with. */
export interface Ended<T> {
  /** The request. */
  frame: FrameId
  /** What it was opened with. */
  token: T
}

/** What time has brought about for a request in flight. */
export interface Due<T> extends Ended<T> {
  /** `again`: to be sent again with the same id; `expired`: it has ended without an answer. */
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
  /** When it last came. */
  at: number
}

const same = (a: FrameId, b: FrameId): boolean =>
  a.id === b.id && a.code === b.code && a.kind === b.kind && a.response === b.response

/** The state of one peer's conversation with another. Every token comes back exactly once. */
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

  /** A session without requests. */
  constructor(config: SessionConfig) {
    // An id that was in use a moment ago is not the next: at most half of all are in flight.
    const halfOfIds = Math.floor(config.idMax / 2) + 1
    this.config = config
    this.limit = Math.min(config.inFlight, halfOfIds)
    this.remembers = Math.min(config.remembers, halfOfIds)
    this.rememberedFor = 2 * config.ack.timeout * (config.ack.retries + 1)
    this.nextId = config.firstId % (config.idMax + 1)
  }

  /** How many requests are in flight. */
  get inFlight(): number {
    return this.requests.size
  }

  /** Puts a request in flight and gives what to send it with; `null` if too many are. */
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
   * Says what a frame that has arrived means. `digest` is that of its data: it tells apart reports that came over different
   * connections, since a peer that restarts may use an id again.
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
      // It may come again for as long as ever: its age counts from now.
      this.seen.splice(index, 1)
      this.seen.push({ ...entry, connection: this.connection, at: now })
      return true
    }
    return false
  }

  /** Remembers that a report has been handed on. */
  handedOn(report: FrameId, digest: string | null, now: number): void {
    this.seen.push({ frame: report, digest, connection: this.connection, at: now })
    if (this.seen.length > this.remembers) this.seen.shift()
  }

  /** Notes that what comes from now on comes over another connection. */
  reconnected(): void {
    this.connection++
  }

  /** Ends a request because nobody waits for its answer any more, and gives its token; `null` if it has ended before. */
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

  /** All that is due. */
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

  /** When something is due; `null` for never. */
  get nextDue(): number | null {
    let next: number | null = null
    for (const { due } of this.requests.values()) next = next === null ? due : Math.min(next, due)
    return next
  }

  /** Ends every request in flight that `ends` says so of, as when the connection is lost. */
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
