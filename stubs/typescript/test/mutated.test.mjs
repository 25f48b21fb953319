// Frames with a few bytes changed, cut and repeated, against a whole robot and a whole client. They throw no error, and
// other connections are served.

import assert from 'node:assert/strict'
import { test } from 'node:test'
import { Client, commands, ExampleRobot, Fc, serve } from 'fc-protocol'
import { nodeAlgorithms } from 'fc-protocol/node'
import { Framing } from 'fc-protocol/runtime'
import { bytesOf, vectors } from './support.mjs'
import { FakePlatform, pipe, Raw, settle } from './toy.mjs'

const FRAMES = 10_000

/** Returns pseudo-random numbers, the same in each run. */
function dice(seed) {
  let state = seed
  return (sides) => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0
    return Math.floor((state / 2 ** 32) * sides)
  }
}

const frames = vectors.flatMap(({ accepted, rejected }) =>
  [...accepted, ...rejected].flatMap(({ frame }) => (frame ? [bytesOf(frame)] : [])),
)
const framing = new Framing(Fc.wire.frame, Fc.wire.defaults.limits, nodeAlgorithms)

/**
 * Returns a changed frame of the vectors. Either its body changes and the frame is sealed again, or any byte changes.
 */
async function mutated(roll, idOf = (id) => id) {
  const source = frames[roll(frames.length)]
  const bytes = Uint8Array.from(source)
  const whole = framing.begins(bytes) === bytes.length ? await framing.open(bytes) : null
  if (whole?.data && roll(4) > 0) {
    const data = Uint8Array.from(whole.data)
    for (let changes = roll(4); changes > 0 && data.length > 0; changes--) data[roll(data.length)] = roll(256)
    return await framing.encode(
      idOf(whole.id),
      data.subarray(0, roll(20) ? data.length : roll(data.length)),
      roll(3) ? null : 0,
    )
  }
  for (let changes = 1 + roll(3); changes > 0; changes--) bytes[roll(bytes.length)] = roll(256)
  return roll(10) ? bytes : bytes.subarray(0, roll(bytes.length))
}

test('a robot serves others, whatever one app sends', { timeout: 120_000 }, async () => {
  assert.ok(frames.length > 1000)
  const platform = new FakePlatform()
  let accept = null
  platform.listen = (_host, port, _options, then) => {
    if (port === Fc.wire.commandPort) accept = then
    return Promise.resolve({ port, close() {} })
  }
  const log = []
  const server = await serve(platform, new ExampleRobot({ pretendMotion: true }), {
    log: (level, message) => level === 'error' && log.push(message),
    connectionsPerAddress: 1000,
    limits: { connections: 1000 },
  })
  const join = () => {
    const [theirs, ours] = pipe()
    accept(theirs)
    return ours
  }
  const roll = dice(7)
  let raw = new Raw(join(), framing)
  let sent = 0
  for (; sent < FRAMES; sent++) {
    await raw.sendBytes(await mutated(roll))
    if (sent % 20 === 0) await settle()
    if (sent % 200 === 0) await platform.clock.advance(2000)
    if (!raw.isClosed && sent % 50 !== 0) continue
    raw.end.close()
    raw = new Raw(join(), framing)
  }
  const good = new Raw(join(), framing)
  await good.sendBytes(
    framing.encode({ response: false, kind: 1, code: commands.getRobotSn.code, id: 5 }, bytesOf('7b7d'), null),
  )
  await settle()
  assert.equal(good.got.length, 1)
  assert.deepEqual(log, [])
  const { callsSucceeded, callsInvalid, badFrames } = server.counters()
  assert.ok(callsSucceeded > 100 && callsInvalid > 100 && badFrames > 100, JSON.stringify(server.counters()))
})

test('a client goes on, whatever a robot sends', { timeout: 120_000 }, async () => {
  const platform = new FakePlatform()
  const pipes = []
  const dial = () => {
    const [theirs, ours] = pipe()
    platform.give(theirs)
    pipes.push(new Raw(ours, framing))
  }
  dial()
  const client = await Client.connect(platform, { reconnect: { first: 0, longest: 0 } })
  const reports = client.reports()
  let taken = 0
  void (async () => {
    for await (const { code } of reports) taken += code > 0 ? 1 : 0
  })()
  const roll = dice(11)
  for (let sent = 0; sent < FRAMES; sent++) {
    const raw = pipes.at(-1)
    if (client.inFlight < 20) client.callAny(Fc.commands[roll(Fc.commands.length)], {}).catch(() => {})
    // Most responses belong to a call in flight.
    const asked = [...client.core.session.requests.values()]
    const idOf = (id) =>
      id.response && asked.length > 0 && roll(5) ? { ...asked[roll(asked.length)].frame, response: true } : id
    await raw.sendBytes(await mutated(roll, idOf))
    if (sent % 20 === 0) await settle()
    if (sent % 200 === 0) await platform.clock.advance(2000)
    if (!raw.isClosed && sent % 50 !== 0) continue
    raw.end.close()
    dial()
    await settle()
  }
  pipes.at(-1).end.close()
  dial()
  await settle()
  const call = client.getRobotSn()
  await settle()
  const { id } = pipes.at(-1).got.at(-1)
  const answer = '{"cmdTime":1,"resultCode":1001,"data":{"robotSn":"100132001234567","robotModel":"Indoor"}}'
  await pipes.at(-1).sendBytes(framing.encode({ ...id, response: true }, new TextEncoder().encode(answer), null))
  assert.ok((await call).data.robotSn)
  const { answers, badFrames, reportsInvalid } = client.counters()
  assert.ok(taken > 5 && answers > 100 && badFrames > 100 && reportsInvalid > 50, JSON.stringify(client.counters()))
  client.close()
})
