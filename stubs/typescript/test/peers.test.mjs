// The session scripts of level `peer`: the behaviour of a whole client or robot over time, as data for all
// implementations.

import assert from 'node:assert/strict'
import { readdirSync, readFileSync } from 'node:fs'
import path from 'node:path'
import { test } from 'node:test'
import { Connection, Refusal, dial, robotWithoutPorts } from 'fc-protocol/runtime'
import { holds, root } from './support.mjs'
import { FakePlatform, KINDS, Raw, bodyOf, echo, go, moved, pipe, results, service, settle, toy } from './toy.mjs'

/** Longer than any script lasts. */
const PATIENT = 365 * 24 * 60 * 60 * 1000

class Run {
  platform = new FakePlatform()
  raw = null
  requests = new Map()
  arrived = new Map()
  handlers = new Map()
  /** Events of a step other than frames. */
  events = []

  constructor(given) {
    const { side, first_id: firstId, in_flight: inFlight = 64, queued_reports: queuedReports = 16 } = given
    this.side = side
    this.given = given
    this.config = { firstId, limits: { inFlight, queuedReports } }
  }

  async start() {
    const { given, config, platform } = this
    if (this.side === 'app') {
      this.connect()
      const settings = {
        ...config,
        callTimeout: given.call_timeout ?? 3000,
        connectTimeout: PATIENT,
        reconnect: { first: 0, longest: 0 },
      }
      this.app = new Connection(await dial(toy, platform, settings))
      void this.watch()
      this.receivers = Array.from({ length: given.receivers ?? 1 }, () => this.app.reports())
    } else {
      const handle = (request, { code, id }) =>
        new Promise((resolve, reject) => {
          const name = this.nameOf(code, id)
          this.handlers.set(name, { resolve: () => resolve(request), reject })
          this.events.push({ handles: name })
        })
      const settings = { ...config, handlerTimeout: given.handler_timeout ?? 2000 }
      this.robot = robotWithoutPorts(
        toy,
        service,
        platform,
        { echo: handle, go: (request, context) => handle(request, context).then(() => ({})) },
        settings,
      )
      this.connect()
    }
    await settle()
    this.events.length = 0
  }

  async watch() {
    for await (const { is } of this.app.states()) this.events.push(is)
  }

  connect() {
    const [theirs, ours] = pipe()
    this.raw = new Raw(ours)
    if (this.side === 'app') this.platform.give(theirs)
    else assert.notEqual(this.robot.serve(theirs), null)
  }

  /** Returns the name of the last frame with this code and id that was sent to the peer. */
  nameOf(code, id, body) {
    const found = [...this.arrived]
      .reverse()
      .find(
        ([, one]) =>
          one.frame.code === code &&
          one.frame.id === id &&
          (body === undefined || JSON.stringify(one.body) === JSON.stringify(body)),
      )
    return found?.[0] ?? ''
  }

  async step(step) {
    const [verb] = Object.keys(step).filter((key) => key !== 'expect' && key !== 'then')
    const what = step[verb]
    switch (verb) {
      case 'call':
        this.call(what)
        break
      case 'report':
        this.report(what)
        break
      case 'receive':
        await this.receive(what)
        break
      case 'advance':
        await this.platform.clock.advance(what)
        break
      case 'lose':
        this.raw.end.close()
        this.raw = null
        break
      case 'reconnect':
        this.connect()
        break
      case 'cancel':
        this.requests.get(what).abort.abort()
        break
      case 'take':
        this.take()
        break
      case 'close':
        this.app.close()
        break
      case 'finish':
        this.finish(what)
        break
      case 'shutdown':
        void this.robot.shutdown(what.grace).then(() => this.events.push('over'))
        break
      default:
        throw new Error(`a step of no known verb: ${JSON.stringify(step)}`)
    }
    const got = []
    for (let turn = 0; turn < 2; turn++) {
      await settle()
      got.push(...this.drain(), ...this.events.splice(0))
    }
    return got
  }

  /** Sends a request of the peer. Its body has a number, to recognise it. */
  request(name, code) {
    const number = this.requests.size
    assert.ok(!this.requests.has(name), name)
    const request = { name, code, number, frame: null, abort: new AbortController() }
    this.requests.set(name, request)
    return request
  }

  ends(name, ended) {
    ended.then(
      (result) => this.events.push({ ends: { as: name, with: result } }),
      (error) => {
        if (error.name !== 'AbortError') this.events.push({ ends: { as: name, with: error.kind } })
      },
    )
  }

  call({ as, code, timeout, repeat }) {
    const { number, abort } = this.request(as, code)
    const options = {
      signal: abort.signal,
      ...(timeout === undefined ? {} : { timeout }),
      ...(repeat === undefined ? {} : { repeat }),
    }
    const called =
      code === 100
        ? this.app.call(echo, { text: String(number) }, options)
        : this.app.call(go, { metres: number }, options)
    this.ends(
      as,
      called.then(() => 'success'),
    )
  }

  report({ as, code }) {
    assert.equal(code, 300)
    const { number } = this.request(as, code)
    this.ends(
      as,
      this.robot.push('all', moved, { metres: number }).then(([first]) => first?.outcome ?? 'nobody'),
    )
  }

  async receive({ answer_to: to, kind, code, id, as, result = 'success', broken = false, data }) {
    const asked = to === undefined ? null : this.requests.get(to).frame
    if (to !== undefined) assert.ok(asked, `${to} has not been sent`)
    const frame = {
      response: to !== undefined,
      kind: kind === undefined ? asked.kind : KINDS[kind],
      code: code ?? asked.code,
      id: id ?? asked.id,
    }
    let body = frame.response
      ? { result: results[result].code, text: '' }
      : frame.code === 100
        ? { text: '' }
        : { metres: 1 }
    if (broken) body = { text: 1, metres: '' }
    if (data !== undefined) body.data = data
    if (as !== undefined) {
      this.arrived.delete(as)
      this.arrived.set(as, { frame, body })
    }
    await this.raw.send(frame, body)
  }

  take() {
    const [receiver] = this.receivers
    // A receiver without a report does not wait.
    if (receiver.queue.length === 0) return
    void receiver.next().then(({ value }) => this.events.push({ hands_on: this.nameOf(value.code, value.id) }))
  }

  finish({ handler_of: name, result, fails }) {
    const { resolve, reject } = this.handlers.get(name)
    if (fails) reject(new Error('as the script says'))
    else if (result === 'success') resolve()
    else reject(new Refusal(results[result].code, 'as the script says'))
  }

  drain() {
    const { raw } = this
    if (!raw) return []
    const events = raw.take().map((frame) => this.event(frame))
    if (raw.isClosed) {
      raw.end.close()
      this.raw = null
      events.push('closes')
    }
    return events
  }

  event({ id, ...frame }) {
    const body = bodyOf(frame)
    if (id.response) {
      const to = this.nameOf(id.code, id.id)
      assert.notEqual(to, '', 'an answer to nothing')
      return { answers: { to, result: Object.keys(results).find((name) => results[name].code === body.result) } }
    }
    const number = body.metres ?? Number(body.text)
    const request = [...this.requests.values()].find((one) => one.number === number)
    assert.ok(request, 'a frame of nobody')
    if (request.frame) {
      assert.deepEqual(id, request.frame, `${request.name} is sent as another`)
      return { again: { as: request.name, id: id.id } }
    }
    assert.deepEqual([id.kind, id.code], [request.code === 300 ? KINDS.report : KINDS.command, request.code])
    request.frame = id
    return { sends: { as: request.name, id: id.id } }
  }

  /** Returns an expected event with the id of its request. */
  filled(event) {
    const [verb] = Object.keys(event)
    if (verb !== 'sends' && verb !== 'again') return event
    const { as, id = this.requests.get(as)?.frame?.id } = event[verb]
    return { [verb]: { as, id } }
  }

  async run(steps) {
    await this.start()
    for (const [index, step] of steps.entries()) {
      const where = `step ${index + 1}: ${JSON.stringify(step)}`
      const got = await this.step(step)
      const expected = (step.expect ?? []).map((event) => this.filled(event))
      const sorted = (events) => events.map((event) => JSON.stringify(event)).sort()
      assert.deepEqual(sorted(got), sorted(expected), where)
      if (step.then?.in_flight !== undefined) assert.equal(this.app.inFlight, step.then.in_flight, where)
    }
  }
}

const folder = path.join(root, '../../conformance/sessions')
let scripts = 0
for (const file of readdirSync(folder)
  .filter((name) => name.endsWith('.json'))
  .sort()) {
  const contents = JSON.parse(readFileSync(path.join(folder, file), 'utf8'))
  if (contents.level !== 'peer') continue
  for (const script of contents.scripts) {
    scripts++
    test(`${file}: ${script.name}`, async () => {
      await new Run(script.given).run(script.steps)
      holds('peer')
    })
  }
}

test('all scripts of the level were run', () => assert.ok(scripts >= 56, String(scripts)))
