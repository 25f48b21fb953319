// The session scripts of level `session`: behaviour over time, as data for all implementations.

import assert from 'node:assert/strict'
import { readdirSync, readFileSync } from 'node:fs'
import path from 'node:path'
import { test } from 'node:test'
import { Session } from 'fc-protocol/runtime'
import { holds, root } from './support.mjs'

const KINDS = { stream: 0, command: 1, report: 3 }
/** Steps and keys that a runner of this level must know. */
const VERBS = ['call', 'report', 'receive', 'advance', 'lose', 'reconnect', 'handed_on', 'cancel', 'repeat']

class Run {
  constructor(given) {
    const { ack = { timeout: 2000, retries: 3 }, in_flight: inFlight = 64, queued_reports: queued = 16 } = given
    const { call_timeout: timeout = 3000, first_id: firstId, id_bits: idBits = 32 } = given
    this.ids = 2 ** idBits
    this.policies = { call: { timeout, retries: 0 }, report: ack }
    const remembers = Math.max(inFlight, queued, 64)
    if (given.remembers !== undefined) assert.equal(remembers, given.remembers)
    this.session = new Session({
      report: KINDS.report,
      stream: KINDS.stream,
      inFlight,
      remembers,
      ack,
      firstId,
      idMax: this.ids - 1,
    })
    this.now = 0
    this.requests = new Map()
    /** Ids of requests in flight. */
    this.inFlight = new Set()
    this.arrived = new Map()
  }

  steps(steps, turn = 0) {
    for (const [index, step] of steps.entries()) {
      if (step.repeat) {
        for (let inner = 0; inner < step.repeat.times; inner++) this.steps(step.repeat.steps, inner)
        continue
      }
      const got = this.step(step, turn)
      const expected = (step.expect ?? []).map((event) => this.filled(event))
      const sorted = (events) => events.map((event) => JSON.stringify(event)).sort()
      const where = `step ${index + 1}: ${JSON.stringify(step)}`
      assert.deepEqual(sorted(got), sorted(expected), where)
      const { in_flight: inFlight, next_due: nextDue, next_due_by: by } = step.then ?? {}
      const due = this.session.nextDue === null ? null : this.session.nextDue - this.now
      if (inFlight !== undefined) assert.equal(this.session.inFlight, inFlight, where)
      if (nextDue !== undefined) assert.equal(due, nextDue, where)
      if (by !== undefined) assert.ok(due !== null && due <= by, where)
    }
  }

  /** Returns an expected event with the id of its request. */
  filled(event) {
    const [verb] = Object.keys(event)
    if (verb !== 'sends' && verb !== 'again') return event
    const { as, id = this.requests.get(as).id } = event[verb]
    return { [verb]: { as, id } }
  }

  step(step, turn) {
    const { session, now } = this
    const [verb, ...others] = VERBS.filter((known) => step[known] !== undefined)
    assert.deepEqual(others, [])
    switch (verb) {
      case 'call':
      case 'report': {
        const { as, code, ...said } = step[verb]
        const kind = verb === 'call' ? KINDS.command : KINDS.report
        const frame = session.open(kind, code, { ...this.policies[verb], ...said }, now, as)
        if (!frame) return [{ busy: as }]
        assert.ok(!this.inFlight.has(frame.id), `${as} has the id of one in flight: ${frame.id}`)
        this.inFlight.add(frame.id)
        this.requests.set(as, frame)
        return [{ sends: { as, id: frame.id } }]
      }
      case 'receive': {
        const { answer_to: to, kind, code, id, as, data = null } = step.receive
        const asked = this.requests.get(to) ?? {}
        const frame = {
          response: to !== undefined,
          kind: kind === undefined ? asked.kind : KINDS[kind],
          code: code ?? asked.code,
          id: id === undefined ? asked.id : (id + turn) % this.ids,
        }
        if (as !== undefined) this.arrived.set(as, [frame, data])
        const meaning = session.receive(frame, data, now)
        if (meaning.is !== 'answer') return [meaning.is]
        this.inFlight.delete(frame.id)
        return [{ answer: meaning.token }]
      }
      case 'advance': {
        this.now += step.advance
        return session.due(this.now).map(({ is, frame, token }) => {
          if (is === 'again') return { again: { as: token, id: frame.id } }
          this.inFlight.delete(frame.id)
          return { expired: token }
        })
      }
      case 'lose': {
        const kept = step.lose.keeps ?? []
        return session
          .endIf((_, token) => !kept.includes(token))
          .map(({ frame, token }) => {
            this.inFlight.delete(frame.id)
            return { ended: token }
          })
      }
      case 'cancel': {
        const ended = session.cancel(this.requests.get(step.cancel))
        if (!ended) return []
        this.inFlight.delete(ended.frame.id)
        return [{ ended: ended.token }]
      }
      case 'handed_on':
        session.handedOn(...this.arrived.get(step.handed_on), now)
        return []
      case 'reconnect':
        session.reconnected()
        return []
    }
    throw new Error(`a step of no known verb: ${JSON.stringify(step)}`)
  }
}

const folder = path.join(root, '../../conformance/sessions')
const files = readdirSync(folder)
  .filter((name) => name.endsWith('.json'))
  .sort()
let scripts = 0
for (const file of files) {
  const contents = JSON.parse(readFileSync(path.join(folder, file), 'utf8'))
  if (contents.level !== 'session') continue
  for (const script of contents.scripts) {
    scripts++
    test(`${file}: ${script.name}`, () => {
      new Run(script.given).steps(script.steps)
      holds('session')
    })
  }
}

test('all scripts of the level were run', () => assert.ok(scripts >= 60, String(scripts)))
