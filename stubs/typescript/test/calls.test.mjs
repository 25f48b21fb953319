// Ends of calls, for any behaviour of the robot.

import assert from 'node:assert/strict'
import { test } from 'node:test'
import { CallError, acceptedIn } from 'fc-protocol/runtime'
import { State, bodyOf, client, echo, framing, go, lazyClient, settle } from './toy.mjs'

const ends = (call) =>
  call.then(
    (value) => value,
    (error) => error,
  )

test('an answer comes to its call, with unknown keys', async () => {
  const { raw, connection } = await client()
  const [one, two] = [connection.call(echo, { text: 'one' }), connection.call(echo, { text: 'two' })]
  await settle()
  const [first, second] = raw.take()
  assert.equal(bodyOf(first).text, 'one')
  assert.equal(typeof bodyOf(first).time, 'number')
  await raw.answer(second, { result: 0, text: '2', more: [1] })
  await raw.answer(first, { text: '1', result: 0 })
  assert.deepEqual(await Promise.all([one, two]), [{ text: '1' }, { text: '2', extra: [{ key: 'more', json: '[1]' }] }])
  assert.equal(connection.inFlight, 0)
  assert.equal(connection.counters().answers, 2)
})

test('each end of a call has its name and its cause', async () => {
  const { raw, connection, clock } = await client()
  const answered = async (body) => {
    const end = ends(connection.call(go, { metres: 1 }))
    await settle()
    await raw.answer(raw.take()[0], body)
    return end
  }
  const blocked = await answered({ result: 10, said: 'no', drive: [] })
  assert.deepEqual([blocked.kind, blocked.refusal.code, blocked.refusal.text], ['refused', 10, 'no'])
  assert.equal(blocked.declared(go), 'Blocked')
  assert.equal((await answered({ result: 11 })).declared(go), null)
  const lacks = await answered({})
  assert.deepEqual([lacks.kind, lacks.body.kind, lacks.body.path], ['invalid_response', 'missing_field', 'result'])
  const end = ends(connection.call(echo, { text: 'a' }))
  await settle()
  const [frame] = raw.take()
  await raw.answer(frame, { result: 0, text: 7 })
  assert.deepEqual([(await end).kind, (await end).body.path], ['invalid_response', 'text'])
  assert.ok((await end) instanceof CallError)
  const late = ends(connection.call(echo, { text: 'a' }, { timeout: 50 }))
  await clock.advance(50)
  assert.equal((await late).kind, 'timeout')
  raw.take()
  assert.equal(connection.counters().timeouts, 1)
})

test('a refusal stays a refusal with other keys', async () => {
  const { raw, connection } = await client()
  const end = ends(connection.call(echo, { text: 'a' }))
  await settle()
  await raw.answer(raw.take()[0], { text: 7, result: 4, said: 'too old' })
  assert.deepEqual([(await end).kind, (await end).refusal.code, (await end).refusal.text], ['refused', 4, 'too old'])
})

test('a request that breaks a constraint or is too long is not sent', async () => {
  const { raw, connection } = await client()
  const invalid = await ends(connection.call(echo, { text: 'x'.repeat(1001) }))
  assert.deepEqual([invalid.kind, invalid.body.kind, invalid.body.path], ['invalid_request', 'bad_length', 'text'])
  const long = await ends(connection.call(go, { metres: 1, extra: [{ key: 'more', json: `"${'x'.repeat(70_000)}"` }] }))
  assert.deepEqual([long.kind, long.frame], ['frame', 'frame_too_long'])
  await settle()
  assert.deepEqual(raw.take(), [])
  assert.equal(connection.inFlight, 0)
})

test('a broken response ends only its call', async () => {
  const { raw, connection } = await client()
  const end = ends(connection.call(echo, { text: 'a' }))
  await settle()
  const [{ id }] = raw.take()
  const bytes = framing.encode({ ...id, response: true }, new TextEncoder().encode('{"result":0,"text":""}'), null)
  bytes[bytes.length - 1] ^= 1
  await raw.sendBytes(bytes)
  assert.deepEqual([(await end).kind, (await end).frame], ['frame', 'bad_digest'])
  assert.equal(connection.state.is, 'connected')
  assert.equal(connection.counters().badFrames, 1)
})

test('connection with resync over garbage', async () => {
  const { raw, connection } = await client({ resync: true })
  const call = connection.call(echo, { text: 'a' })
  await settle()
  const [{ id }] = raw.take()
  await raw.sendBytes(new TextEncoder().encode('garbage'))
  await raw.answer({ id }, { result: 0, text: 'b' })
  assert.equal((await call).text, 'b')
  assert.equal(connection.state.is, 'connected')
})

test('an aborted call frees its place before and after sending', async () => {
  const { raw, connection } = await client({ limits: { inFlight: 1 } })
  const abort = new AbortController()
  const end = ends(connection.call(echo, { text: 'a' }, { signal: abort.signal }))
  await settle()
  assert.equal((await ends(connection.call(echo, { text: 'b' }))).kind, 'busy')
  abort.abort(new Error('enough'))
  assert.equal((await end).message, 'enough')
  assert.equal(connection.inFlight, 0)
  assert.equal((await ends(connection.call(echo, { text: 'c' }, { signal: abort.signal }))).message, 'enough')
  const [frame, ...others] = raw.take()
  assert.deepEqual(others, [])
  await raw.answer(frame, { result: 0, text: 'late' })
  await settle()
  assert.equal(connection.counters().lateAnswers, 1)
})

test('raw calls are not checked', async () => {
  const { raw, connection } = await client()
  const call = connection.callRaw(0x1234, '{"a": 1.50, "b":null}')
  await settle()
  const [frame] = raw.take()
  assert.equal(frame.id.code, 0x1234)
  assert.deepEqual(Object.keys(bodyOf(frame)), ['time', 'a', 'b'])
  await raw.answer(frame, '{"result":0,"x": [1,  2]}')
  assert.deepEqual(await call, { refusal: null, json: '{"x":[1,  2]}' })
  const refused = connection.callRaw(1, '{}')
  await settle()
  await raw.answer(raw.take()[0], { result: 3 })
  assert.equal((await refused).refusal.code, 3)
  assert.equal((await ends(connection.callRaw(1, '[]'))).kind, 'invalid_request')
})

test('requests are compressed if that makes them shorter', async () => {
  const { raw, connection } = await client({ gzip: { fromBytes: 100 } })
  void ends(connection.call(echo, { text: 'x'.repeat(900) }))
  void ends(connection.call(echo, { text: 'short' }))
  await settle()
  const [long, short] = raw.take().sort((a, b) => b.data.length - a.data.length)
  assert.equal(bodyOf(long).text.length, 900)
  assert.ok(long.sent < 200, String(long.sent))
  assert.equal(short.sent, short.data.length)
})

test('a call waits for a connection and reports why there is none', async () => {
  const { platform, clock, connection } = lazyClient({ reconnect: { first: 100, longest: 100 } })
  assert.deepEqual(connection.state, { is: 'connecting', connects: 0, why: { is: 'not_yet' } })
  const gone = ends(connection.call(go, { metres: 1 }, { timeout: 500 }))
  platform.give(new Error('refused'))
  await settle()
  await clock.advance(600)
  const error = await gone
  assert.deepEqual([error.kind, error.loss.is], ['not_connected', 'unreachable'])
  const waits = connection.call(go, { metres: 2 })
  const raw = platform.join()
  await clock.advance(200)
  const [frame] = raw.take()
  await raw.answer(frame)
  assert.deepEqual(await waits, {})
})

test('the first attempt may fail by the network or by time', async () => {
  const { FakePlatform, toy } = await import('./toy.mjs')
  const { dial, ConnectError, TransportError } = await import('fc-protocol/runtime')
  const platform = new FakePlatform()
  platform.give(new TransportError('ECONNREFUSED'))
  const refused = await ends(dial(toy, platform, {}))
  assert.ok(refused instanceof ConnectError)
  assert.deepEqual([refused.kind, refused.reason], ['io', 'ECONNREFUSED'])
  const late = ends(dial(toy, platform, { connectTimeout: 70 }))
  await platform.clock.advance(70)
  assert.equal((await late).kind, 'timeout')
  // A connection that comes too late is closed.
  const raw = platform.join()
  await settle()
  assert.ok(raw.isClosed)
})

test('closing ends everything that waits', async () => {
  const { raw, connection, clock } = await client()
  const [sent, reports] = [ends(connection.call(echo, { text: 'a' })), connection.reports()]
  const states = []
  const watching = (async () => {
    for await (const { is } of connection.states()) states.push(is)
  })()
  await settle()
  const next = reports.next()
  connection.close()
  assert.deepEqual([(await sent).kind, (await sent).loss.is], ['lost', 'closed_here'])
  assert.equal((await next).done, true)
  assert.equal((await ends(connection.call(echo, { text: 'a' }))).kind, 'closed')
  assert.deepEqual(await connection.closed(), { is: 'closed_here' })
  await watching
  assert.deepEqual(states, ['connected', 'closed'])
  await clock.advance(1000)
  assert.ok(raw.isClosed)
})

test('preconditions are asked for by the state', () => {
  assert.equal(acceptedIn(go, State, 0), true)
  assert.equal(acceptedIn(go, State, 1), false)
  assert.equal(acceptedIn(echo, State, 1), true)
})
