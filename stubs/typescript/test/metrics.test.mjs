// The hook for metrics: the end of each call.

import assert from 'node:assert/strict'
import { test } from 'node:test'
import { KINDS, client, echo, go, lazyClient, robot, settle } from './toy.mjs'

const ask = (id, code = 100) => ({ kind: KINDS.command, code, id })
const ends = (promise) =>
  promise.then(
    (value) => value,
    (error) => error,
  )

/** A hook that keeps what it gets. */
function recorder() {
  const calls = []
  return { calls, onCall: (call) => calls.push(call) }
}

test('client_tells_the_end_of_each_call', async () => {
  const { calls, onCall } = recorder()
  const { raw, connection, clock } = await client({ onCall })
  const good = connection.call(echo, { text: 'a' })
  const refused = ends(connection.call(go, { metres: 1 }))
  const late = ends(connection.call(echo, { text: 'b' }, { timeout: 50 }))
  const given = new AbortController()
  const dropped = ends(connection.call(go, { metres: 2 }, { signal: given.signal }))
  const unknown = connection.callRaw(999, '{}')
  const invalid = ends(connection.call(echo, { text: 'x'.repeat(1001) }))
  await settle()
  const [first, second, , , fifth] = raw.take()
  await clock.advance(20)
  await raw.answer(first, { result: 0, text: 'a' })
  await raw.answer(second, { result: 10 })
  await raw.answer(fifth, { result: 1 })
  await settle()
  given.abort()
  await settle()
  await clock.advance(30)
  await Promise.all([good, refused, late, dropped, unknown, invalid])
  assert.deepEqual(calls, [
    { operation: 'echo', result: 'invalid_request', time: 0 },
    { operation: 'echo', result: 'success', time: 20 },
    { operation: 'go', result: 'refused', time: 20 },
    { operation: 'unknown', result: 'success', time: 20 },
    { operation: 'go', result: 'dropped', time: 20 },
    { operation: 'echo', result: 'timeout', time: 50 },
  ])
})

test('call_without_a_connection_ends_too', async () => {
  const { calls, onCall } = recorder()
  const { connection, clock } = lazyClient({ onCall })
  const end = ends(connection.call(echo, { text: 'a' }, { timeout: 40 }))
  await clock.advance(40)
  await end
  assert.deepEqual(calls, [{ operation: 'echo', result: 'not_connected', time: 40 }])
})

test('robot_tells_the_result_and_the_time_of_each_call', async () => {
  const { calls, onCall } = recorder()
  let finish
  const methods = {
    echo: ({ text }) => {
      if (text === 'fail') throw new Error('secret')
      return { text }
    },
    go: () =>
      new Promise((resolve) => {
        finish = () => resolve({})
      }),
  }
  const { join, clock } = robot(methods, { onCall, handlerTimeout: 500 })
  const raw = join()
  await raw.send(ask(1), { text: 'a' })
  await raw.send(ask(2), { text: 'fail' })
  await raw.send(ask(3), { text: 7 })
  await raw.send(ask(4, 999), {})
  await raw.send(ask(5, 200), { metres: 1 })
  await settle()
  await clock.advance(30)
  finish()
  await settle()
  await raw.send(ask(6, 200), { metres: 1 })
  await settle()
  await clock.advance(500)
  assert.deepEqual(calls, [
    { operation: 'echo', result: 'success', time: 0 },
    { operation: 'echo', result: 'protocol', time: 0 },
    { operation: 'echo', result: 'invalid', time: 0 },
    { operation: 'unknown', result: 'protocol', time: 0 },
    { operation: 'go', result: 'success', time: 30 },
    { operation: 'go', result: 'timeout', time: 500 },
  ])
  assert.equal(raw.take().length, 6)
})

test('hook_that_throws_harms_nothing', async () => {
  const lines = []
  const config = {
    log: (level, message) => lines.push(`${level} ${message}`),
    onCall: () => {
      throw new Error('secret')
    },
  }
  const { raw, connection } = await client(config)
  const end = connection.call(echo, { text: 'a' })
  await settle()
  await raw.answer(raw.take()[0], { result: 0, text: 'a' })
  assert.deepEqual(await end, { text: 'a' })
  const served = robot({ echo: ({ text }) => ({ text }) }, config)
  const app = served.join()
  await app.send(ask(1), { text: 'a' })
  await settle()
  assert.equal(app.take().length, 1)
  assert.deepEqual(
    lines.filter((line) => line.startsWith('error')),
    ['error `onCall` threw', 'error `onCall` threw'],
  )
})
