// The data port from the app's side: frames of raw bytes, subscriptions, losses.

import assert from 'node:assert/strict'
import { test } from 'node:test'
import { bodyOf, client, framing, KINDS, pictures, scans, settle } from './toy.mjs'

const frame = (code, id) => ({ kind: KINDS.stream, code, id })
const bytes = (...values) => Uint8Array.from(values)
const ends = (promise) =>
  promise.then(
    (value) => value,
    (error) => error,
  )

async function data(config) {
  const all = await client({ callTimeout: 1000, ...config })
  const port = all.connection.data()
  const raw = all.platform.join()
  await port.connected()
  return { ...all, commands: all.raw, port, raw }
}

test('the data port connects after the command port', async () => {
  const { platform, raw, connection } = await client({ callTimeout: 1000, dataPort: 77 })
  raw.end.close()
  await settle()
  const port = connection.data()
  const early = ends(port.connected())
  const unsent = ends(port.send(400, 1, bytes(1)))
  await platform.clock.advance(1000)
  assert.equal((await early).kind, 'not_connected')
  assert.equal((await unsent).kind, 'not_connected')
  assert.deepEqual(
    platform.waiting.map(({ port }) => port),
    [1],
  )
  platform.join()
  await settle()
  assert.deepEqual(
    platform.waiting.map(({ port }) => port),
    [77],
  )
  platform.join()
  await port.connected()
})

test('frames flow both ways, and only the unread one waits', async () => {
  const { raw, port } = await data()
  await port.send(400, 9, bytes(1, 2, 3))
  await settle()
  const [sent] = raw.take()
  assert.deepEqual([sent.id, [...sent.data]], [{ response: false, kind: 0, code: 400, id: 9 }, [1, 2, 3]])
  for (const id of [1, 2, 3]) await raw.send(frame(400, id), bytes(id))
  await settle()
  for (const id of [1, 2, 3]) assert.deepEqual(await port.recv(), { code: 400, id, data: bytes(id) })
})

test('an invalid stream frame is reported, and the connection stays', async () => {
  const { raw, port } = await data()
  const broken = framing.encode({ response: false, ...frame(400, 1) }, bytes(1), null)
  broken[34] ^= 1
  await raw.sendBytes(broken)
  assert.deepEqual((await ends(port.recv())).frame, 'bad_digest')
  await raw.send({ kind: KINDS.command, code: 100, id: 1 }, '{}')
  assert.equal((await ends(port.recv())).kind, 'unexpected_frame')
  await raw.send({ response: true, ...frame(400, 1) }, { result: 1, said: 'no' })
  const refused = await ends(port.recv())
  assert.deepEqual([refused.kind, refused.refusal.code], ['refused', 1])
  await raw.send(frame(400, 2), bytes(7))
  assert.equal((await port.recv()).id, 2)
  assert.equal((await ends(port.send(400, 1, new Uint8Array(70_000)))).frame, 'frame_too_long')
})

test('each subscription has its own queue that drops the oldest', async () => {
  const { raw, port } = await data()
  const [all, json] = [port.subscribe(pictures), port.subscribe(scans)]
  for (let id = 1; id <= 6; id++) await raw.send(frame(400, id), bytes(id))
  await raw.send(frame(401, 9), { metres: 4 })
  await raw.send(frame(401, 10), { metres: 'far' })
  await raw.send(frame(402, 1), bytes(1))
  await raw.send(frame(402, 2), bytes(2))
  await settle()
  const got = []
  for (let count = 0; count < 4; count++) got.push((await all.next()).value)
  assert.deepEqual(
    got,
    [3, 4, 5, 6].map((id) => ({ id, content: bytes(id) })),
  )
  assert.deepEqual([all.missed(), all.missed(), port.missed()], [2, 0, 1])
  assert.deepEqual((await json.next()).value, { id: 9, content: { metres: 4 } })
  assert.deepEqual((await ends(json.next())).body.kind, 'wrong_type')
  assert.equal((await port.recv()).code, 402)
  all.close()
  assert.equal((await all.next()).done, true)
})

test('a `for await` that is left takes no more frames', async () => {
  const { raw, port } = await data()
  const subscribed = port.subscribe(pictures)
  await raw.send(frame(400, 1), bytes(1))
  await settle()
  for await (const { id } of subscribed) {
    assert.equal(id, 1)
    break
  }
  await raw.send(frame(400, 2), bytes(2))
  await settle()
  // The stream has no subscription any more, so its frame goes to `recv`.
  assert.equal((await Promise.race([port.recv(), settle()]))?.id, 2)
  assert.equal((await subscribed.next()).done, true)
})

test('typed content is checked before it is sent', async () => {
  const { raw, port } = await data()
  await port.sendStream({ ...scans, from: 'app' }, 5, { metres: 3 })
  await settle()
  assert.deepEqual(bodyOf(raw.take()[0]), { metres: 3 })
  assert.equal((await ends(port.sendStream(scans, 5, { metres: 2 ** 40 }))).kind, 'invalid')
})

test('a loss is reported once, and the next connection continues', async () => {
  const { platform, raw, port } = await data()
  const subscribed = port.subscribe(pictures)
  await port.send(401, 1, bytes(1))
  raw.end.close()
  await settle()
  assert.equal((await ends(port.send(401, 2, bytes(2)))).kind, 'lost')
  assert.equal((await ends(port.recv())).kind, 'lost')
  assert.equal((await ends(subscribed.next())).kind, 'lost')
  const next = platform.join()
  await settle()
  await port.send(401, 3, bytes(3))
  await settle()
  assert.deepEqual(
    next.take().map(({ id }) => id.id),
    [3],
  )
  await next.send(frame(400, 4), bytes(4))
  assert.equal((await subscribed.next()).value.id, 4)
})

test('the data connection follows the command connection', async () => {
  const { platform, commands, raw, port, connection } = await data()
  commands.end.close()
  await settle()
  platform.join()
  await settle()
  assert.ok(raw.isClosed)
  assert.deepEqual((await ends(port.recv())).loss, { is: 'renewed' })
  platform.join()
  await settle()
  assert.deepEqual(port.state, { is: 'connected', connects: 2 })
  connection.close()
  assert.deepEqual(await port.closed(), { is: 'closed_here' })
  assert.equal((await ends(port.recv())).kind, 'closed')
  assert.equal((await ends(port.send(400, 1, bytes(1)))).kind, 'closed')
})

test('a frame that stalls loses the connection', async () => {
  const { clock, raw, port } = await data({ stallTimeout: 500, callTimeout: 10_000 })
  const whole = framing.encode({ response: false, ...frame(400, 1) }, new Uint8Array(100), null)
  await raw.sendBytes(whole.subarray(0, 40))
  await settle()
  await clock.advance(500)
  assert.deepEqual((await ends(port.recv())).loss, { is: 'stalled', received: 40, total: 134 })
})
