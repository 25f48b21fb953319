// Losses of a connection, and reconnecting.

import assert from 'node:assert/strict'
import { test } from 'node:test'
import { bodyOf, client, echo, framing, go, pipe, settle, Raw } from './toy.mjs'

const ends = (call) =>
  call.then(
    (value) => value,
    (error) => error,
  )
const NEVER = { reconnect: null }

test('invalid bytes end the connection with the reason', async () => {
  for (const [bytes, fault] of [
    [new TextEncoder().encode('HTTP/1.1 400 Bad Request\r\n'), 'bad_head'],
    [Uint8Array.of(0x70, 2, 1, 0, 100, 0, 0, 0, 1, 0, 0, 0, 0, 5, 0, 0, 0, 0), 'short_frame'],
    [Uint8Array.of(0x70, 2, 1, 0, 100, 0, 0, 0, 1, 0, 0xff, 0, 0, 5, 0, 0, 0, 0), 'frame_too_long'],
  ]) {
    const { raw, connection } = await client(NEVER)
    const end = ends(connection.call(go, { metres: 1 }))
    await raw.sendBytes(bytes)
    assert.deepEqual((await end).loss, { is: 'frame', fault })
    assert.deepEqual(await connection.closed(), { is: 'frame', fault })
    await settle()
    assert.ok(raw.isClosed)
  }
})

test('the stream may end inside, between and before frames', async () => {
  const inside = await client(NEVER)
  await inside.raw.sendBytes(Uint8Array.of(0x70))
  inside.raw.end.end()
  assert.deepEqual(await inside.connection.closed(), { is: 'frame', fault: 'truncated' })
  const unheard = await client(NEVER)
  unheard.raw.end.end()
  assert.deepEqual(await unheard.connection.closed(), { is: 'closed_unheard' })
  const heard = await client(NEVER)
  void ends(heard.connection.call(echo, { text: 'a' }))
  await settle()
  await heard.raw.answer(heard.raw.take()[0], { result: 0, text: '' })
  heard.raw.end.end()
  assert.deepEqual(await heard.connection.closed(), { is: 'closed_by_robot' })
})

test('a frame that does not go on is stalled', async () => {
  const { raw, connection, clock } = await client({ ...NEVER, stallTimeout: 1000 })
  const frame = framing.encode({ response: true, kind: 1, code: 100, id: 1 }, new Uint8Array(1000), null)
  await raw.sendBytes(frame.subarray(0, 50))
  await settle()
  await clock.advance(999)
  assert.equal(connection.state.is, 'connected')
  await clock.advance(1)
  assert.deepEqual(await connection.closed(), { is: 'stalled', received: 50, total: 1034 })
})

test('a frame that comes byte by byte is stalled as well', async () => {
  const { raw, connection, clock } = await client({ ...NEVER, stallTimeout: 1000 })
  const frame = framing.encode({ response: true, kind: 1, code: 100, id: 1 }, new Uint8Array(1000), null)
  for (let at = 0; at < 10 && connection.state.is === 'connected'; at++) {
    await raw.sendBytes(frame.subarray(at, at + 1))
    await clock.advance(500)
  }
  assert.equal((await connection.closed()).is, 'stalled')
})

test('a robot that does not read is unread', async () => {
  const { FakePlatform, toy } = await import('./toy.mjs')
  const { Connection, dial } = await import('fc-protocol/runtime')
  const platform = new FakePlatform()
  const [theirs] = pipe(10)
  platform.give(theirs)
  const connection = new Connection(await dial(toy, platform, { ...NEVER, stallTimeout: 1000, callTimeout: 10_000 }))
  const end = ends(connection.call(go, { metres: 1 }))
  await settle()
  await platform.clock.advance(1000)
  assert.deepEqual((await end).loss, { is: 'unread' })
})

test('waits between attempts double up to a limit and reset after a frame', async () => {
  const { platform, clock, raw, connection } = await client({ reconnect: { first: 100, longest: 400 } })
  raw.end.close()
  const waits = []
  for (let attempt = 0; attempt < 5; attempt++) {
    await settle()
    const before = clock.time
    while (platform.waiting.length === 0) await clock.advance(1)
    waits.push(clock.time - before)
    platform.give(new Error('no'))
    await settle()
  }
  for (const [index, longest] of [100, 200, 400, 400, 400].entries()) {
    assert.ok(waits[index] <= longest + 1 && waits[index] >= longest * 0.75, JSON.stringify(waits))
  }
  const next = platform.join()
  await clock.advance(400)
  void ends(connection.call(echo, { text: 'a' }))
  await settle()
  await next.answer(next.take()[0], { result: 0, text: '' })
  await settle()
  next.end.close()
  await settle()
  await clock.advance(100)
  assert.equal(platform.waiting.length, 1)
})

test('a robot that accepts and closes is given up after the limit', async () => {
  const { platform, clock, raw, connection } = await client({ reconnect: { first: 100, longest: 10_000, attempts: 2 } })
  raw.end.close()
  await settle()
  await clock.advance(100)
  platform.join().end.close()
  await settle()
  await clock.advance(100)
  assert.equal(platform.waiting.length, 0, 'the second wait is longer')
  for (const wait of [200, 400]) {
    await clock.advance(wait)
    platform.give(new Error('no'))
    await settle()
  }
  assert.equal((await connection.closed()).is, 'unreachable')
})

test('reads are sent again once after a loss, motions are not', async () => {
  const { platform, raw, connection } = await client()
  const [read, moves] = [ends(connection.call(echo, { text: 'r' })), ends(connection.call(go, { metres: 1 }))]
  await settle()
  const before = raw.take()
  raw.end.close()
  await settle()
  assert.equal((await moves).kind, 'lost')
  const next = platform.join()
  await settle()
  const [again, ...others] = next.take()
  assert.deepEqual(others, [])
  assert.deepEqual(again.id, before[0].id)
  assert.equal(bodyOf(again).text, 'r')
  next.end.close()
  await settle()
  assert.equal((await read).kind, 'lost')
  assert.equal(connection.state.is, 'connecting')
  connection.close()
})

test('closing while connecting leaves nothing open', async () => {
  const { platform, raw, connection, clock } = await client()
  raw.end.close()
  await settle()
  connection.close()
  const [theirs, ours] = pipe()
  platform.give(theirs)
  const late = new Raw(ours)
  await settle()
  assert.ok(late.isClosed)
  await clock.advance(5000)
  assert.equal(clock.timers.size, 0)
})
