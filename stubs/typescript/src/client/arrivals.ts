// Handles each frame from the robot according to its meaning.

import { because, keys, textOf } from '../bodies.ts'
import type { Received } from '../bodies.ts'
import { BodyError } from '../fault.ts'
import { hexOf } from '../framing.ts'
import type { WholeFrame } from '../framing.ts'
import type { AnyReportOf, ResultText } from '../operation.ts'
import type { Struct } from '../schema.ts'
import type { FrameId } from '../session.ts'
import type { Core } from './core.ts'
import type { Link } from './link.ts'
import type { Arrived } from './queues.ts'

/**
 * Most unsent bytes up to which reports are acknowledged: a robot that does not read must not fill the app's memory.
 */
const ACKNOWLEDGE_UP_TO = 256 * 1024

/** Time of the last report of a kind that comes at intervals. */
interface Beat {
  readonly atMost: number
  last: number | null
}

/** Handles received frames. */
export class Arrivals {
  private readonly core: Core
  private readonly reports = new Map<number, AnyReportOf>()
  private readonly beats = new Map<number, Beat>()

  /** Creates the handler of a connection. */
  constructor(core: Core) {
    this.core = core
    for (const report of core.protocol.reports) {
      if (report.code === null) continue
      this.reports.set(report.code, report)
      const { cadence } = report
      if (cadence?.is === 'every') this.beats.set(report.code, { atMost: cadence.ms * 1.5, last: null })
    }
  }

  /** Starts a connection. Reports of an earlier connection do not count for the intervals. */
  begin(): void {
    for (const beat of this.beats.values()) beat.last = null
  }

  /** Handles one frame. */
  arrive(frame: WholeFrame, link: Link): void {
    const { core } = this
    const { id } = frame
    const { results } = core.protocol.wire
    if (frame.fault !== null) {
      core.counters.badFrames++
      core.log.tellThinly('warn', 'bad frame', { error: frame.fault, code: id.code, id: id.id })
      if (!id.response) {
        this.answer(link, id, results.protocol)
        return
      }
    }
    const isReport = !id.response && id.kind === core.framing.kind('report')
    let report: Arrived | null = null
    if (isReport && frame.data) {
      try {
        report = this.read(id, frame.data)
      } catch (problem) {
        if (!(problem instanceof BodyError)) throw problem
        core.counters.reportsInvalid++
        core.log.tellThinly('warn', 'report refused', { code: id.code, id: id.id, error: problem.kind })
        this.answer(link, id, because(results.invalid, problem.message))
        return
      }
    }
    const digest = isReport ? this.fingerprint(frame) : null
    const meaning = core.session.receive(id, digest, core.now)
    switch (meaning.is) {
      case 'answer':
        core.counters.answers++
        meaning.token.answered(frame)
        return
      case 'late':
        core.counters.lateAnswers++
        core.log.tell('debug', 'late answer', { code: id.code, id: id.id })
        return
      case 'report':
        if (report) this.take(report, id, digest, link)
        else this.answer(link, id, results.protocol)
        return
      case 'repeated':
        core.counters.repeatedReports++
        this.answer(link, id, results.success)
        return
      case 'command':
      case 'stream':
        // Apps handle no commands, and streams use the data port.
        this.answer(link, id, results.protocol)
    }
  }

  /**
   * Returns a key that tells reports with the same id apart. A short checksum is not enough: then the data is digested.
   */
  private fingerprint({ digest, data }: WholeFrame): string | null {
    if (digest !== null && digest.length >= 32) return digest
    return data && hexOf(this.core.platform.algorithms.md5(data))
  }

  private read({ code, id }: FrameId, data: Uint8Array): Arrived {
    const known = this.reports.get(code)
    if (!known) {
      const { message, time } = this.core.bodies.readRequest(keys, data)
      return { code, id, time, name: null, value: textOf(message), size: data.length }
    }
    const { message, time }: Received<unknown> = this.core.bodies.readRequest(known.body as Struct<unknown>, data)
    return { code, id, time, name: known.case, value: message, size: data.length }
  }

  private take(report: Arrived, id: FrameId, digest: string | null, link: Link): void {
    const { core } = this
    this.beat(id)
    const hasRoom = core.life.now.is !== 'closed' && link.outlet.unsent < ACKNOWLEDGE_UP_TO
    const missed = hasRoom ? core.queues.push(report) : null
    if (missed === null) {
      core.counters.reportsRefused++
      core.log.tellThinly('warn', 'report not taken: there is no receiver, or no room', { code: id.code, id: id.id })
      return
    }
    core.counters.reports++
    core.counters.reportsMissed += missed
    core.session.handedOn(id, digest, core.now)
    this.answer(link, id, core.protocol.wire.results.success)
  }

  private beat({ code, id }: FrameId): void {
    const beat = this.beats.get(code)
    if (!beat) return
    const { now } = this.core
    const since = beat.last === null ? 0 : now - beat.last
    beat.last = now
    if (since <= beat.atMost) return
    this.core.counters.reportsLate++
    this.core.log.tellThinly('warn', 'report late', { code, id, since })
  }

  /** Responds with a result alone, or not at all in a protocol without result codes. */
  private answer(link: Link, id: FrameId, result: ResultText): void {
    const { core } = this
    const canSay = core.bodies.hasResult || result === core.protocol.wire.results.success
    if (!canSay || link.outlet.unsent >= ACKNOWLEDGE_UP_TO) return
    const made = core.framing.encode({ ...id, response: true }, core.bodies.writeResponse(result, keys, {}), null)
    if (made instanceof Promise) return
    core.counters.bytesOut += made.length
    link.outlet.push(made)
  }
}
