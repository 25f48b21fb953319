// One app's command connection: its requests, their handlers, and the reports on their way to it.

import { Alarm, Change } from '../alarm.ts'
import { because, keys } from '../bodies.ts'
import { BodyError } from '../fault.ts'
import type { WholeFrame } from '../framing.ts'
import type { Effect, ResultText } from '../operation.ts'
import { Outlet, goodbye } from '../outlet.ts'
import type { Transport } from '../platform.ts'
import { Refusal } from '../refusal.ts'
import { Session } from '../session.ts'
import type { FrameId } from '../session.ts'
import { isLater } from '../thrown.ts'
import type { Results } from '../wire.ts'
import { Called } from './called.ts'
import { Inlet } from './inlet.ts'
import { Pace, inflated } from './pace.ts'
import { spread } from './queued.ts'
import type { Queued } from './queued.ts'
import type { RequestRead, Route } from './routes.ts'
import type { Shared } from './shared.ts'
import type { ConnectionId } from './types.ts'

/** Most unsent bytes, or bytes being compressed, before reading and sending of reports pause. */
const HIGH_WATER = 256 * 1024

/** A peer that holds no more than this, in bytes, does not trigger a check of the memory limit. */
const WEIGHTY = 64 * 1024

/** A running handler whose response is awaited. */
interface Work {
  /** Bytes of the request. */
  readonly weight: number
  readonly request: FrameId
  readonly deadline: number
  readonly context: Called
  readonly outlives: boolean
}

/** One app. */
export class Peer {
  /** Its number. */
  readonly id: ConnectionId
  /** Its address. */
  readonly address: string
  /** At least one frame has been received. */
  isHeard = false
  /** Resolves when it has ended. */
  readonly over: Promise<void>
  private readonly shared: Shared
  private readonly transport: Transport
  private readonly outlet: Outlet
  private readonly inlet: Inlet
  private readonly session: Session<Queued>
  private readonly queue: Queued[] = []
  private queuedBytes = 0
  /** Bytes that the platform is compressing. */
  private packing = 0
  private readonly effects: 'all' | readonly Effect[]
  private readonly works = new Set<Work>()
  private readonly pace = new Pace()
  private readonly alarm: Alarm
  private readonly deadlines: Alarm
  /** Fires when a handler has ended or there is room again. */
  private readonly changed = new Change()
  private isDraining = false
  private isGone = false
  private resolve: () => void = () => {}

  /** Serves a connection. */
  constructor(shared: Shared, id: ConnectionId, transport: Transport) {
    const { clock } = shared.platform
    const { settings, framing } = shared
    this.shared = shared
    this.id = id
    this.address = transport.remote
    this.transport = transport
    this.effects = shared.access.effects(transport.remote) ?? []
    this.over = new Promise((resolve) => {
      this.resolve = resolve
    })
    this.session = new Session({
      report: framing.kind('report'),
      stream: framing.kind('stream'),
      inFlight: settings.limits.inFlight,
      remembers: 0,
      ack: shared.protocol.wire.defaults.ack,
      firstId: shared.firstId(),
      idMax: framing.idMax,
    })
    this.alarm = new Alarm(
      clock,
      () => this.session.nextDue,
      () => {
        this.repeat()
      },
    )
    this.deadlines = new Alarm(
      clock,
      () => this.works.values().next().value?.deadline ?? null,
      () => {
        this.expire()
      },
    )
    this.outlet = new Outlet(transport, clock, settings.patience.stall, settings.patience.least, {
      stalled: () => {
        shared.counters.connectionsTimedOut++
        this.end('the app does not read')
      },
      broke: () => {
        this.end('the connection broke')
      },
    })
    this.inlet = new Inlet(transport, framing, clock, settings.patience, {
      frame: (frame) => this.take(frame),
      received: (bytes) => {
        this.isHeard = true
        shared.counters.bytesIn += bytes
        if (this.held > WEIGHTY) shared.weigh()
      },
      ended: (why, isBroken) => {
        if (isBroken) this.end(why)
        else this.drain(why)
      },
      late: () => {
        shared.counters.connectionsTimedOut++
      },
      isIdle: () => this.works.size === 0,
    })
  }

  /** Bytes held for the peer. */
  get held(): number {
    let sum = this.inlet.pending + this.outlet.unsent + this.packing + this.queuedBytes
    for (const { weight } of this.works) sum += weight
    return sum
  }

  /** Handles one frame. Does so later if the connection must rest first, or the app does not read its responses. */
  private take(frame: WholeFrame): Promise<void> | void {
    const { shared } = this
    const { settings } = shared
    const rest = this.deal(frame)
    if (this.works.size >= settings.limits.inFlight) {
      shared.counters.inFlightReached++
      shared.log.tellThinly('info', 'not read: too many requests', {
        connection: this.id,
        inFlight: settings.limits.inFlight,
      })
    } else if (rest === 0 && this.outlet.unsent < HIGH_WATER && this.packing < HIGH_WATER) return
    return this.pause(rest)
  }

  /** Handles a frame. Returns the time to rest if it was useless, in milliseconds. */
  private deal(frame: WholeFrame): number {
    const { shared, pace } = this
    const { results } = shared.protocol.wire
    const now = shared.now
    const { id } = frame
    if (frame.fault !== null || frame.data === null) {
      shared.counters.badFrames++
      shared.log.tellThinly('warn', 'bad frame', { connection: this.id, error: frame.fault, code: id.code })
      if (id.response) return pace.unusable(now)
      return this.refuse(id, results.protocol)
    }
    const surplus = inflated(frame.data.length - frame.sent)
    if (!id.response && id.kind === shared.framing.kind('command')) return Math.max(surplus, this.call(id, frame.data))
    if (!id.response) return Math.max(surplus, this.refuse(id, results.protocol))
    const meaning = this.session.receive(id, null, now)
    if (meaning.is !== 'answer') return Math.max(surplus, pace.unusable(now))
    this.acknowledged(meaning.token, frame.data)
    this.send()
    return surplus
  }

  private async pause(rest: number): Promise<void> {
    const { clock } = this.shared.platform
    if (rest > 0) {
      this.shared.counters.connectionsPaced++
      await this.changed.until(clock, clock.now() + rest, () => this.isDraining || this.isGone)
    }
    const { inFlight } = this.shared.settings.limits
    while (!this.isDraining && !this.isGone) {
      if (this.works.size >= inFlight) await this.changed.wait()
      else if (this.outlet.unsent >= HIGH_WATER) await this.outlet.below(HIGH_WATER)
      else if (this.packing >= HIGH_WATER) await this.changed.wait()
      else return
    }
  }

  private acknowledged(queued: Queued, data: Uint8Array): void {
    const { counters, bodies } = this.shared
    this.queuedBytes -= queued.data.length
    const connection = this.id
    try {
      const read = bodies.readResponse(keys, data)
      if (read instanceof Refusal) {
        counters.reportsRefused++
        queued.ended({ connection, outcome: 'refused', refusal: read })
        return
      }
      counters.reportsAcknowledged++
      queued.ended({ connection, outcome: 'acknowledged' })
    } catch (problem) {
      if (!(problem instanceof BodyError)) throw problem
      counters.reportsRefused++
      queued.ended({ connection, outcome: 'invalid', body: problem })
    }
  }

  /** Handles a request. Returns the time to rest if it was useless, in milliseconds. */
  private call(id: FrameId, data: Uint8Array): number {
    const { shared } = this
    const { results } = shared.protocol.wire
    const route = shared.routes.of(id.code)
    if (!route) return this.refuse(id, results.protocol)
    if (this.effects !== 'all' && !this.effects.includes(route.effect)) {
      shared.counters.callsForbidden++
      shared.log.tellThinly('warn', 'refused: not allowed from this address', { connection: this.id, code: id.code })
      return this.refuse(id, because(results.protocol, 'not allowed from this address'))
    }
    let read: RequestRead
    try {
      read = route.read(shared.bodies, id.code, data)
    } catch (problem) {
      if (!(problem instanceof BodyError)) throw problem
      return this.refuse(id, because(results.invalid, problem.message))
    }
    const { maxAge } = shared.settings
    if (maxAge !== null && read.time !== null && shared.platform.clock.wallTime() - read.time > maxAge) {
      return this.refuse(id, results.expired)
    }
    if (route.outlives && shared.abandoned.isFull) {
      shared.counters.abandonedReached++
      shared.log.tellThinly('warn', 'too many abandoned handlers', { connection: this.id, code: id.code })
      return this.refuse(id, because(results.protocol, 'too many handlers are still at work'))
    }
    return this.handle(route, id, read, data.length)
  }

  private handle(route: Route, id: FrameId, { request, time }: RequestRead, weight: number): number {
    const { shared } = this
    const context = new Called(this.address, this.id, id, time, shared.now, () =>
      shared.notImplemented(id.code, this.id),
    )
    let answer: unknown
    try {
      answer = route.handle(request, context)
    } catch (problem) {
      return this.fail(context, id, problem)
    }
    if (!isLater(answer)) {
      this.answer(route, context, id, answer)
      return 0
    }
    const work: Work = {
      weight,
      request: id,
      deadline: this.shared.now + this.shared.settings.handlerTimeout,
      context,
      outlives: route.outlives,
    }
    this.works.add(work)
    this.deadlines.by(work.deadline)
    void Promise.resolve(answer).then(
      (response: unknown) => {
        if (this.release(work)) this.answer(route, context, id, response)
        this.settled()
      },
      (problem: unknown) => {
        if (this.release(work)) this.fail(context, id, problem)
        else if (!(problem instanceof Refusal) && !isAbort(problem)) this.panicked(context, problem)
        this.settled()
      },
    )
    return 0
  }

  /** Notes that a handler has ended. Returns `true` if its response is still awaited. */
  private release(work: Work): boolean {
    if (this.works.delete(work)) return true
    if (work.outlives) this.shared.abandoned.ended()
    return false
  }

  private settled(): void {
    this.changed.tell()
    this.inlet.look()
    this.leaveIfDone()
  }

  /** Ends the handlers whose time is over: the app gets the result for a timeout, and the handlers run on. */
  private expire(): void {
    const { now } = this.shared
    for (const work of this.works) {
      if (work.deadline > now) break
      this.abandon(work)
      this.refuse(work.request, this.shared.protocol.wire.results.timeout, work.context.since)
    }
    this.settled()
  }

  private abandon(work: Work): void {
    this.works.delete(work)
    if (work.outlives) {
      this.shared.abandoned.begun()
      this.shared.counters.handlersAbandoned++
    }
    work.context.abandon()
  }

  /** Handles a refusal or an error of a handler. Returns the time to rest, as `refuse` does. */
  private fail(context: Called, id: FrameId, problem: unknown): number {
    const { success, protocol } = this.shared.protocol.wire.results
    if (problem instanceof Refusal && problem.code !== success.code) {
      try {
        return this.refuse(id, problem, context.since)
      } catch (invalid) {
        if (!(invalid instanceof BodyError)) throw invalid
        this.invalid(context, id, invalid)
        return 0
      }
    }
    this.panicked(context, problem)
    this.refuse(id, because(protocol, 'the handler threw'), context.since)
    return 0
  }

  private panicked(context: Called, problem: unknown): void {
    this.shared.counters.handlersPanicked++
    this.shared.handlerFailed('a handler threw', problem, context)
  }

  /** Handles a response that breaks the spec: the app does not get it. */
  private invalid(context: Called, id: FrameId, problem: BodyError): void {
    const { kind: error, path, expected } = problem
    this.shared.handlerFailed("the handler's response breaks the spec", problem, context, { error, path, expected })
    this.refuse(id, this.shared.protocol.wire.results.protocol, context.since)
  }

  private answer(route: Route, context: Called, id: FrameId, response: unknown): void {
    const { shared } = this
    let data: Uint8Array
    try {
      data = route.write(shared.bodies, shared.protocol.wire.results.success, response)
    } catch (problem) {
      if (problem instanceof BodyError) this.invalid(context, id, problem)
      // Reading a property of the response may throw.
      else this.fail(context, id, problem)
      return
    }
    this.post(
      { ...id, response: true },
      data,
      () => {
        shared.counters.callsSucceeded++
        shared.callEnded(id.code, 'success', context.since)
      },
      () => {
        const problem = new RangeError('the response does not fit into a frame')
        shared.handlerFailed(problem.message, problem, context, {})
        this.refuse(id, shared.protocol.wire.results.protocol, context.since)
      },
    )
  }

  /**
   * Responds with a result alone, or not at all in a protocol without result codes. Returns the time to rest if the
   * request was useless, in milliseconds. The request came at `since`.
   */
  private refuse(id: FrameId, result: ResultText, since: number = this.shared.now): number {
    const { shared } = this
    const { results } = shared.protocol.wire
    const { counters } = shared
    // A handler's own result may be invalid, which throws a `BodyError`.
    const data = shared.bodies.hasResult ? shared.bodies.writeResponse(result, keys, {}) : null
    const { ended, counter, isUsable } = endOf(results, result)
    const tell = (): void => {
      counters[counter]++
      shared.callEnded(id.code, ended, since)
    }
    // The text of a result may quote the body: only the code is logged.
    shared.log.tell('debug', 'refused', { code: id.code, id: id.id, result: result.code })
    if (data) {
      // The protocol's own result is the shortest response.
      const tooLong = result === results.protocol ? tell : (): void => void this.refuse(id, results.protocol, since)
      this.post({ ...id, response: true }, data, tell, tooLong)
    } else tell()
    return isUsable ? 0 : this.pace.unusable(shared.now)
  }

  /** Sends a frame. Calls `sent` when it has been handed over, or `tooLong`. */
  private post(id: FrameId, data: Uint8Array, sent: () => void, tooLong: () => void): void {
    if (this.isGone) return
    const { framing, settings, counters } = this.shared
    if (settings.gzipFrom === null && !framing.fits(data)) {
      tooLong()
      return
    }
    const go = (bytes: Uint8Array): void => {
      if (bytes.length > framing.frameBytes) {
        tooLong()
        return
      }
      counters.bytesOut += bytes.length
      sent()
      this.outlet.push(bytes)
      if (this.outlet.unsent > WEIGHTY) this.shared.weigh()
    }
    const made = framing.encode(id, data, settings.gzipFrom)
    if (!(made instanceof Promise)) {
      go(made)
      return
    }
    this.packing += data.length
    void made.then((bytes) => {
      this.packing -= data.length
      go(bytes)
      this.settled()
    })
  }

  /** Queues a report, in place of the oldest ones if the queue is full. */
  push(report: Queued): void {
    const connection = this.id
    if (this.isGone || this.isDraining) {
      report.ended({ connection, outcome: 'closed' })
      return
    }
    const { limits, queuedBytes } = this.shared.settings
    const fits = (): boolean =>
      this.queue.length < limits.queuedReports && this.queuedBytes + report.data.length <= queuedBytes
    while (!fits()) {
      const oldest = this.queue.shift()
      this.shared.counters.reportsDropped++
      this.shared.log.tellThinly('warn', 'report dropped: the app is slow', {
        connection,
        code: (oldest ?? report).code,
      })
      ;(oldest ?? report).ended({ connection, outcome: 'dropped' })
      if (!oldest) return
      this.queuedBytes -= oldest.data.length
    }
    this.queuedBytes += report.data.length
    this.queue.push(report)
    if (this.held > WEIGHTY) this.shared.weigh()
    this.send()
  }

  /** Sends queued reports, as many as there is room for. */
  private send(): void {
    const { shared } = this
    while (!this.isDraining && !this.isGone && this.outlet.unsent < HIGH_WATER) {
      if (this.session.inFlight >= shared.settings.limits.inFlight) return
      const queued = this.queue.shift()
      if (!queued) return
      const policy = { ...queued.policy, timeout: queued.policy.timeout + spread(queued.policy.timeout, this.id) }
      const id = this.session.open(shared.framing.kind('report'), queued.code, policy, shared.now, queued)
      if (!id) return
      shared.counters.reportsSent++
      this.post(id, queued.data, nothing, nothing)
      this.alarm.by(shared.now + policy.timeout)
    }
    if (this.queue.length > 0 && !this.isDraining)
      void this.outlet.below(HIGH_WATER).then((goesOn) => {
        if (goesOn) this.send()
      })
  }

  private repeat(): void {
    const { counters, now } = this.shared
    for (const { is, frame, token } of this.session.due(now)) {
      if (is === 'again') {
        counters.reportsRepeated++
        if (this.outlet.unsent < HIGH_WATER) this.post(frame, token.data, nothing, nothing)
      } else {
        counters.reportsTimedOut++
        this.queuedBytes -= token.data.length
        token.ended({ connection: this.id, outcome: 'timed_out' })
      }
    }
    this.send()
  }

  /** Ends the connection once every request has its response. */
  drain(why: string = 'drained'): void {
    if (this.isDraining || this.isGone) return
    this.isDraining = true
    this.inlet.stop(why)
    this.changed.tell()
    this.leaveIfDone()
  }

  private leaveIfDone(): void {
    if (this.isDraining && this.works.size === 0 && this.packing === 0 && !this.isGone) this.end('drained')
  }

  /** Ends responding. Responses made before are still sent. */
  end(why: string): void {
    if (this.isGone) return
    this.isGone = true
    this.isDraining = true
    this.inlet.stop(why)
    this.alarm.stop()
    this.deadlines.stop()
    for (const work of [...this.works]) this.abandon(work)
    const ended = [...this.session.endIf(() => true).map(({ token }) => token), ...this.queue.splice(0)]
    for (const queued of ended) queued.ended({ connection: this.id, outcome: 'closed' })
    this.changed.tell()
    this.shared.log.tell('info', 'connection ended', { connection: this.id, peer: this.address, port: 'command', why })
    this.shared.left(this.id)
    void goodbye(this.transport, this.outlet, this.shared.platform.clock, this.inlet.over).then(this.resolve)
  }

  /** Closes the connection at once. */
  cut(): void {
    this.end('cut off')
    this.outlet.stop()
    this.transport.close()
  }
}

const nothing = (): void => {}

/** The end of a refused call. */
interface End {
  readonly ended: string
  readonly counter: 'callsProtocol' | 'callsTimedOut' | 'callsInvalid' | 'callsExpired' | 'callsRefused'
  /** The request was not useless. */
  readonly isUsable: boolean
}

/** Returns the end of a call by its result. */
function endOf(results: Results, { code }: ResultText): End {
  switch (code) {
    case results.protocol.code:
      return { ended: 'protocol', counter: 'callsProtocol', isUsable: false }
    case results.timeout.code:
      return { ended: 'timeout', counter: 'callsTimedOut', isUsable: true }
    case results.invalid.code:
      return { ended: 'invalid', counter: 'callsInvalid', isUsable: false }
    case results.expired.code:
      return { ended: 'expired', counter: 'callsExpired', isUsable: false }
    default:
      return { ended: 'refused', counter: 'callsRefused', isUsable: true }
  }
}

/** A handler whose signal was aborted may end with this error. */
const isAbort = (problem: unknown): boolean => problem instanceof Error && problem.name === 'AbortError'
