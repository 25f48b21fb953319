// Pushed bytes go out in order, in few writes, and not only at the end of the turn.

import assert from 'node:assert/strict'
import { test } from 'node:test'
import { Outlet } from '../dist/src/outlet.js'

const clock = { now: () => 0, wallTime: () => 0, after: () => () => {} }

/** Returns a transport whose writes the test completes. */
function transport() {
  const writes = []
  return {
    writes,
    write: (bytes) =>
      new Promise((resolve, reject) => {
        writes.push({ bytes, resolve, reject })
      }),
  }
}

const events = { stalled: () => assert.fail('stalled'), broke: () => assert.fail('broke') }
const sent = (writes) => Buffer.concat(writes.map(({ bytes }) => bytes))
const turn = () => new Promise((resolve) => setImmediate(resolve))

test('small writes of one turn are combined', async () => {
  const to = transport()
  const outlet = new Outlet(to, clock, 1000, 1, events)
  for (let count = 0; count < 10; count++) outlet.push(Uint8Array.of(count))
  assert.equal(to.writes.length, 0)
  await turn()
  assert.equal(to.writes.length, 1)
  to.writes[0].resolve()
  await turn()
  assert.equal(outlet.unsent, 0)
  for (let count = 0; count < 10; count++) outlet.push(new Uint8Array(1000))
  // The first frames are being written before the last is pushed.
  assert.equal(to.writes.length, 3)
  await turn()
  assert.equal(outlet.unsent, 10_000)
  for (const { resolve } of to.writes) resolve()
  await turn()
  to.writes[3]?.resolve()
  await turn()
  assert.equal(outlet.unsent, 0)
  assert.equal(sent(to.writes).length, 10_010)
})

test('order holds around chunked writes that end late', async () => {
  const to = transport()
  const outlet = new Outlet(to, clock, 1000, 1, events)
  const pushed = []
  const push = (length, byte) => {
    const bytes = new Uint8Array(length).fill(byte)
    pushed.push(bytes)
    outlet.push(bytes)
  }
  let ended = 0
  for (let count = 0; count < 60; count++) {
    push(count % 7 === 3 ? 700_000 : 1 + ((count * 977) % 6000), count)
    if (count % 3 === 0) await turn()
    // Completes the latest write first, if there are several.
    if (count % 2 === 0) to.writes[to.writes.length - 1]?.resolve()
    if (count % 5 === 0) for (; ended < to.writes.length; ended++) to.writes[ended].resolve()
  }
  while (outlet.unsent > 0) {
    for (const { resolve } of to.writes) resolve()
    await turn()
  }
  assert.ok(sent(to.writes).equals(Buffer.concat(pushed)))
})

test('a broken transport is reported once', async () => {
  const to = transport()
  let broke = 0
  const outlet = new Outlet(to, clock, 1000, 1, { ...events, broke: () => broke++ })
  for (let count = 0; count < 9; count++) outlet.push(new Uint8Array(5000))
  assert.ok(to.writes.length > 1)
  for (const { reject } of to.writes) reject(new Error('gone'))
  await turn()
  assert.equal(broke, 1)
  outlet.push(new Uint8Array(5000))
  await turn()
  assert.equal(await outlet.below(1), false)
})
