// The robot's side: requests, handlers, reports and streams, for any behaviour of an app.

import assert from 'node:assert/strict'
import { test } from 'node:test'
import { Refusal } from 'fc-protocol/runtime'
import { bodyOf, framing, go, KINDS, moved, pictures, pipe, robot, scans, settle } from './toy.mjs'

const echoes = { echo: ({ text }) => ({ text: text.toUpperCase() }) }
const ask = (id, code = 100) => ({ kind: KINDS.command, code, id })
const answers = (raw) => raw.take().map((frame) => [frame.id.id, frame.data ? bodyOf(frame).result : frame.fault])
const ends = (promise) =>
  promise.then(
    (value) => value,
    (error) => error,
  )

/** Returns a handler that the test ends. */
function held() {
  const open = []
  const handler = (request, context) =>
    new Promise((resolve, reject) => open.push({ request, context, resolve, reject }))
  return { open, handler }
}

test('handlers answer at once or later, and an error ends only its call', async () => {
  const { open, handler } = held()
  const methods = {
    echo: handler,
    go: () => {
      throw Refusal.declared(go, 'Blocked')
    },
    drive: () => {
      throw new Error('secret')
    },
  }
  const { server, join } = robot(methods)
  const raw = join()
  await raw.send(ask(1), { text: 'a', time: 5 })
  await raw.send(ask(2, 200), { metres: 1 })
  await raw.send(ask(3, 201), { metres: 1 })
  await settle()
  const [refused, failed] = raw.take()
  assert.deepEqual([refused.id.id, bodyOf(refused).result, bodyOf(refused).said], [2, 10, 'blocked'])
  assert.deepEqual([bodyOf(failed).result, bodyOf(failed).said], [1, 'protocol: the handler threw'])
  assert.deepEqual([open[0].context.code, open[0].context.id, open[0].context.signal.aborted], [100, 1, false])
  assert.deepEqual([open[0].context.peer, open[0].context.time], ['127.0.0.1', 5])
  open[0].resolve({ text: 'b' })
  await settle()
  assert.deepEqual(bodyOf(raw.take()[0]).text, 'b')
  const { callsSucceeded, callsRefused, callsProtocol, handlersPanicked } = server.counters()
  assert.deepEqual([callsSucceeded, callsRefused, callsProtocol, handlersPanicked], [1, 1, 1, 1])
})

test('unimplemented and unknown commands are never a success', async () => {
  const log = []
  const { server, join } = robot(echoes, { log: (...line) => log.push(line) })
  const raw = join()
  for (const [id, code] of [
    [1, 200],
    [2, 505],
    [3, 999],
  ])
    await raw.send(ask(id, code), { metres: 1 })
  await settle()
  assert.deepEqual(
    raw.take().map((frame) => bodyOf(frame).said),
    ['protocol: not implemented', 'protocol', 'protocol'],
  )
  assert.equal(server.counters().callsNotImplemented, 1)
  assert.ok(log.some(([level, text, { name }]) => level === 'warn' && text === 'not implemented' && name === 'go'))
})

test('code ranges and other codes may have raw handlers', async () => {
  const asked = []
  const { join } = robot({
    passThrough: (request) => {
      asked.push(request)
      return '{"x": 1.0}'
    },
    unknown: async () => '[]',
  })
  const raw = join()
  await raw.send(ask(1, 505), '{"time":5,"a":  [1]}')
  await raw.send(ask(2, 999), '{}')
  await settle()
  assert.deepEqual(asked, [{ code: 505, json: '{"a":[1]}' }])
  const [one, two] = raw.take()
  assert.deepEqual([bodyOf(one).x, bodyOf(one).result, bodyOf(two).result], [1, 0, 1])
})

test('invalid requests and responses are stopped', async () => {
  let handled = 0
  const { server, join } = robot(
    {
      echo: () => {
        handled++
        return { text: 'x'.repeat(2000) }
      },
    },
    { maxAge: 1000 },
  )
  const raw = join()
  await raw.send(ask(1), { text: 7 })
  await raw.send(ask(2), { text: 'a', time: 5 })
  await raw.send(ask(3), { text: 'a', time: 1_700_000_000_500 })
  await raw.send(ask(4), '[]')
  await settle()
  assert.deepEqual(answers(raw), [
    [1, 3],
    [2, 4],
    [3, 1],
    [4, 3],
  ])
  assert.equal(handled, 1)
  assert.equal(server.counters().callsExpired, 1)
})

test('a slow motion runs on and frees its place', async () => {
  const { open, handler } = held()
  const { server, join, clock } = robot({ go: handler, echo: handler }, { handlerTimeout: 100, abandonedHandlers: 1 })
  const raw = join()
  await raw.send(ask(1, 200), { metres: 1 })
  await raw.send(ask(2), { text: '' })
  await settle()
  await clock.advance(100)
  assert.deepEqual(answers(raw), [
    [1, 2],
    [2, 2],
  ])
  assert.deepEqual(
    open.map(({ context }) => context.signal.aborted),
    [true, true],
  )
  await raw.send(ask(3, 200), { metres: 1 })
  await raw.send(ask(4), { text: '' })
  await settle()
  assert.deepEqual(
    raw.take().map((frame) => [frame.id.id, bodyOf(frame).said]),
    [[3, 'protocol: too many handlers are still at work']],
  )
  open[0].resolve({})
  await settle()
  await raw.send(ask(5, 200), { metres: 1 })
  await settle()
  assert.equal(open.length, 4)
  assert.deepEqual(answers(raw), [], 'no second answer')
  assert.deepEqual([server.counters().handlersAbandoned, server.counters().abandonedReached], [1, 1])
})

test('requests before a close or invalid bytes are answered', async () => {
  for (const end of [(raw) => raw.end.end(), (raw) => raw.sendBytes(new TextEncoder().encode('GET / HTTP/1.1'))]) {
    const { open, handler } = held()
    const { server, join } = robot({ echo: handler })
    const raw = join()
    await raw.send(ask(1), { text: 'a' })
    await settle()
    await end(raw)
    await settle()
    assert.ok(!raw.isClosed)
    open[0].resolve({ text: 'b' })
    await settle()
    assert.deepEqual(answers(raw), [[1, 0]])
    assert.ok(raw.isClosed)
    assert.deepEqual(server.connections(), [])
  }
})

test('the frame after a broken one is read', async () => {
  const { server, join } = robot(echoes)
  const raw = join()
  const broken = framing.encode({ response: false, ...ask(1) }, new TextEncoder().encode('{}'), null)
  broken[broken.length - 1] ^= 1
  await raw.sendBytes(broken)
  await raw.send({ kind: 2, code: 100, id: 2 }, '{}')
  await raw.send({ kind: KINDS.report, code: 300, id: 3 }, { metres: 1 })
  await raw.send(ask(4), { text: 'a' })
  await settle()
  assert.deepEqual(answers(raw), [
    [1, 1],
    [2, 'reserved_kind'],
    [3, 1],
    [4, 0],
  ])
  assert.equal(server.counters().badFrames, 2)
})

test('no more requests are read than may be at work', async () => {
  const { open, handler } = held()
  const { server, join } = robot({ echo: handler }, { limits: { inFlight: 2 } })
  const raw = join()
  for (let id = 1; id <= 5; id++) await raw.send(ask(id), { text: '' })
  await settle()
  assert.equal(open.length, 2)
  open[0].resolve({ text: '' })
  await settle()
  assert.equal(open.length, 3)
  assert.ok(server.counters().inFlightReached > 0)
})

test('an app that reads no responses is closed', async () => {
  let asked = 0
  const { server, join, clock } = robot(
    {
      echo: () => {
        asked++
        return { text: 'x'.repeat(1000) }
      },
    },
    { stallTimeout: 1000 },
  )
  const raw = join(100)
  raw.end.read = () => new Promise(() => {})
  for (let id = 0; id < 1000; id++) void raw.send(ask(id), { text: '' })
  await settle()
  const before = asked
  assert.ok(before < 600, String(before))
  await clock.advance(1000)
  await settle()
  assert.equal(server.counters().connectionsTimedOut, 1)
  assert.deepEqual(server.connections(), [])
})

test('a header, a frame and a silence have their time', async () => {
  for (const [sent, config, wait] of [
    [10, { headerTimeout: 100 }, 100],
    [40, { stallTimeout: 200 }, 200],
    [0, { idleTimeout: 300 }, 300],
  ]) {
    const { server, join, clock } = robot(echoes, config)
    const raw = join()
    await raw.send(ask(1), { text: '' })
    const frame = framing.encode({ response: false, ...ask(2) }, new Uint8Array(100), null)
    await raw.sendBytes(frame.subarray(0, sent))
    await settle()
    await clock.advance(wait - 1)
    assert.equal(server.connections().length, 1, `${wait}`)
    await clock.advance(1)
    assert.deepEqual(server.connections(), [], `${wait}`)
    assert.equal(server.counters().connectionsTimedOut, 1)
  }
})

test('bytes that come one by one are no progress', async () => {
  const { server, join, clock } = robot(echoes, { stallTimeout: 1000 })
  const raw = join()
  const frame = framing.encode({ response: false, ...ask(2) }, new Uint8Array(100), null)
  await raw.sendBytes(frame.subarray(0, 40))
  for (let at = 40; at < 60 && server.connections().length > 0; at++) {
    await raw.sendBytes(frame.subarray(at, at + 1))
    await clock.advance(100)
  }
  assert.deepEqual(server.connections(), [])
})

test('useless frames delay only their sender', async () => {
  const { server, join, clock } = robot(echoes)
  const [bad, good] = [join(), join()]
  for (let id = 0; id < 400; id++) await bad.send(ask(id, 999), '{}')
  await settle()
  const answered = bad.take().length
  assert.ok(answered >= 256 && answered < 300, String(answered))
  await good.send(ask(1), { text: '' })
  await settle()
  assert.deepEqual(answers(good), [[1, 0]])
  await clock.advance(10_000)
  assert.equal(answered + bad.take().length, 400)
  assert.ok(server.counters().connectionsPaced > 0)
})

test('at the limit, a silent connection gives way', async () => {
  const { server, join } = robot(echoes, { connectionsPerAddress: 2 })
  const [one, two] = [join(), join()]
  await two.send(ask(1), { text: '' })
  await settle()
  const three = join()
  await settle()
  assert.ok(one.isClosed && !two.isClosed && !three.isClosed)
  await three.send(ask(1), { text: '' })
  await settle()
  const four = join()
  await settle()
  assert.equal(four.connection, null)
  assert.ok(four.isClosed)
  const { connectionsDisplaced, connectionsRefused } = server.counters()
  assert.deepEqual([connectionsDisplaced, connectionsRefused], [1, 1])
})

test('a report to one or all apps has an outcome for each', async () => {
  const { server, join, clock } = robot({})
  const [one, two] = [join(), join()]
  const push = server.push('all', moved, { metres: 1 })
  await settle()
  const [[first], [second]] = [one.take(), two.take()]
  await one.answer(first, { result: 3, said: 'no' })
  await two.answer(second, '{"result":"x"}')
  const ended = await push
  assert.deepEqual(
    ended.map(({ outcome }) => outcome),
    ['refused', 'invalid'],
  )
  assert.equal(ended[0].refusal.code, 3)
  const alone = server.push(two.connection, moved, { metres: 2 })
  await settle()
  assert.deepEqual(one.take(), [])
  assert.equal(bodyOf(two.take()[0]).metres, 2)
  await clock.advance(60_000)
  for (let turn = 0; turn < 4; turn++) await clock.advance(3000)
  assert.deepEqual(
    (await alone).map(({ outcome }) => outcome),
    ['timed_out'],
  )
  assert.deepEqual((await ends(server.push(99, moved, { metres: 1 }))).kind, 'no_connection')
  assert.deepEqual((await ends(server.push('all', moved, { metres: 'x' }))).kind, 'invalid_report')
  assert.equal(server.counters().reportsTimedOut, 1)
})

test('a slow app loses its own oldest reports', async () => {
  const { server, join } = robot({}, { limits: { queuedReports: 2, inFlight: 1 } })
  const raw = join()
  const pushes = [1, 2, 3, 4].map((metres) => server.push('all', moved, { metres }))
  await settle()
  assert.deepEqual(
    (await pushes[1]).map(({ outcome }) => outcome),
    ['dropped'],
  )
  const seen = []
  for (let turn = 0; turn < 3; turn++) {
    const [frame] = raw.take()
    seen.push(bodyOf(frame).metres)
    await raw.answer(frame)
    await settle()
  }
  assert.deepEqual(seen, [1, 3, 4])
  assert.equal(server.counters().reportsDropped, 1)
})

test('a stream for one app reaches no other', async () => {
  const { server, join, joinData } = robot({})
  assert.equal(await ends(server.sendStream('all', pictures, 1, new Uint8Array(2))), 0)
  const app = join()
  assert.equal((await ends(server.sendStream(app.connection, pictures, 1, new Uint8Array(2)))).kind, 'no_connection')
  const data = joinData()
  assert.equal(await server.sendStream(app.connection, pictures, 1, new Uint8Array(2)), 1)
  assert.equal(await server.sendStream('all', scans, 2, { metres: 3 }), 1)
  await settle()
  assert.deepEqual(
    data.take().map(({ id, data }) => [id.code, id.id, data.length]),
    [
      [400, 1, 2],
      [401, 2, '{"metres":3}'.length],
    ],
  )
  const other = join()
  assert.equal((await ends(server.sendStream(app.connection, pictures, 1, new Uint8Array(2)))).kind, 'ambiguous')
  assert.equal((await ends(server.sendStream(other.connection, pictures, 1, new Uint8Array(2)))).kind, 'ambiguous')
  assert.equal(await server.sendStream(data.connection, pictures, 1, new Uint8Array(2)), 1)
  assert.equal((await ends(server.sendStream(data.connection, scans, 1, { metres: 'x' }))).kind, 'invalid_report')
})

test('frames of apps are taken in turn and apply back pressure', async () => {
  const { server, joinData } = robot({})
  const data = joinData()
  await data.send({ kind: KINDS.stream, code: 400, id: 1 }, Uint8Array.of(1))
  await settle()
  assert.equal(server.counters().streamFramesDropped, 1)
  const streams = server.streams()
  for (let id = 2; id < 12; id++) await data.send({ kind: KINDS.stream, code: 400, id }, Uint8Array.of(id))
  await data.send({ kind: KINDS.command, code: 100, id: 99 }, '{}')
  await settle()
  assert.ok(server.counters().streamFramesIn < 8)
  for (let id = 2; id < 12; id++) assert.deepEqual((await streams.next()).value.id, id)
  await settle()
  assert.deepEqual(answers(data), [[99, 1]])
})

test('a shutdown answers running calls within its grace', async () => {
  const { open, handler } = held()
  const { server, join, clock } = robot({ echo: handler, go: handler })
  const raw = join()
  await raw.send(ask(1), { text: '' })
  await raw.send(ask(2, 200), { metres: 1 })
  await settle()
  let isOver = false
  const over = server.shutdown(1000).then(() => {
    isOver = true
  })
  await raw.send(ask(3), { text: '' })
  await settle()
  assert.equal(open.length, 2, 'nothing more is begun')
  open[0].resolve({ text: '' })
  await settle()
  assert.deepEqual(answers(raw), [[1, 0]])
  assert.ok(!isOver)
  await clock.advance(1000)
  await over
  assert.ok(raw.isClosed)
  assert.equal(open[1].context.signal.aborted, true)
  assert.equal(server.serve({ remote: '', close() {} }), null)
})

test('bodies of many brackets or values are refused', async () => {
  const { server, join } = robot(echoes, { limits: { jsonValues: 1000 } })
  const raw = join()
  await raw.send(ask(1), `{"text":"","x":${'['.repeat(60_000)}`)
  await raw.send(ask(2), `{"text":"","x":${'[1],'.repeat(2)}`)
  await raw.send(ask(3), `{"text":"","x":[${'1,'.repeat(2000)}1]}`)
  await raw.send(ask(4), { text: 'a' })
  await settle()
  const said = raw.take().map((frame) => bodyOf(frame).said)
  assert.deepEqual(
    said.map((text) => /too_deep|bad_json|too_many_values/.exec(text)?.[0]),
    ['too_deep', 'bad_json', 'too_many_values', undefined],
  )
  assert.equal(server.counters().callsInvalid, 3)
})

test('addresses limit connections and commands', async () => {
  const allow = [
    { network: '127.0.0.0/8', effects: ['read'] },
    { network: '10.1.0.0/16', effects: 'all' },
    { network: 'fd00::/8', effects: 'all' },
  ]
  const { server, join } = robot({ ...echoes, go: () => ({}) }, { allow })
  const raw = join()
  await raw.send(ask(1), { text: 'a' })
  await raw.send(ask(2, 200), { metres: 1 })
  await settle()
  assert.deepEqual(answers(raw), [
    [1, 0],
    [2, 1],
  ])
  const serve = (remote) => {
    const [theirs, ours] = pipe()
    theirs.remote = remote
    const connection = server.serve(theirs)
    ours.close()
    return connection !== null
  }
  for (const [remote, isAllowed] of [
    ['10.1.2.3', true],
    ['::ffff:10.1.2.3', true],
    ['10.2.2.3', false],
    ['fd12::1', true],
    ['fe80::1%eth0', false],
    ['', false],
  ]) {
    assert.equal(serve(remote), isAllowed, remote)
  }
  assert.deepEqual([server.counters().connectionsForbidden, server.counters().callsForbidden], [3, 1])
  for (const network of ['10.0.0.0/33', '10.0.0', 'robot', '1::2::3', '10.0.0.0/']) {
    assert.throws(() => robot({}, { allow: [{ network, effects: 'all' }] }), TypeError, network)
  }
})

test('the connection with most memory is closed when it is short', async () => {
  const { open, handler } = held()
  const { server, join } = robot({ echo: handler }, { memory: 400_000 })
  const [small, large] = [join(), join()]
  const whole = framing.encode({ response: false, ...ask(1) }, new Uint8Array(60_000), null)
  await small.sendBytes(whole.subarray(0, 50_000))
  for (let id = 1; id < 20; id++) await large.send(ask(id), `{"text":"","x":"${'x'.repeat(30_000)}"}`)
  await settle()
  assert.equal(server.counters().connectionsEvicted, 1)
  assert.ok(large.isClosed && !small.isClosed)
  assert.ok(server.memory() <= 60_000, String(server.memory()))
  assert.ok(open.length > 5)
})
