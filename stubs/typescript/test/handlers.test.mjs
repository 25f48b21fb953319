// Handlers that fail or return something invalid: the programmer is told, the app gets a refusal, and other calls go
// on.

import assert from 'node:assert/strict'
import { test } from 'node:test'
import { nodeAlgorithms } from 'fc-protocol/node'
import { BodyError, PushError, Refusal } from 'fc-protocol/runtime'
import { KINDS, bodyOf, client, go, moved, pictures, robot, scans, settle } from './toy.mjs'

const ask = (id, code = 100) => ({ kind: KINDS.command, code, id })
const ends = (promise) =>
  promise.then(
    (value) => value,
    (error) => error,
  )

/** Serves a robot whose log and hook write into lists. */
function watched(methods, config = {}) {
  const [lines, told] = [[], []]
  const log = (level, message, fields) => lines.push({ level, message, fields })
  const onHandlerError = (error, context) => told.push({ error, context })
  const errors = () => lines.filter(({ level }) => level === 'error')
  return { lines, errors, told, ...robot(methods, { log, onHandlerError, ...config }) }
}

class Stuck extends Error {}

/** Calls `echo` once, and returns the response. */
async function callEcho({ join }, text = '') {
  const raw = join()
  await raw.send(ask(1), { text })
  await settle()
  const [answer] = raw.take()
  return bodyOf(answer)
}

test('handler_error_is_logged_with_class_and_own_line', async () => {
  for (const [handler, error] of [
    [() => undefined.text, 'TypeError'],
    [async () => JSON.parse('{'), 'SyntaxError'],
    [
      async ({ text }) => {
        throw new Stuck(text)
      },
      'Stuck',
    ],
    [
      async () => {
        await null
        throw new RangeError('late')
      },
      'RangeError',
    ],
    // The innermost line is inside the runtime; the first line of user code is here.
    [() => Refusal.declared(go, 'No such name'), 'TypeError'],
  ]) {
    const one = watched({ echo: handler })
    assert.deepEqual((await callEcho(one, 'secret')).result, 1)
    const [line] = one.errors()
    assert.equal(line.message, 'a handler threw')
    const { at, ...fields } = line.fields
    assert.deepEqual(fields, { protocol: 'toy', connection: 1, name: 'echo', code: 100, id: 1, error })
    assert.match(at, /\/handlers\.test\.mjs:\d+:\d+$/)
    assert.equal(one.server.counters().handlersPanicked, 1)
  }
})

test('handler_error_is_logged_without_its_message', async () => {
  const place = '    at leak (/secret/place.js:1:2)'
  class Odd extends Error {
    get message() {
      throw new Error('secret')
    }
  }
  /** The stack keeps the message from its first use. */
  const changed = (isSeen) => {
    const error = new Error('before')
    if (isSeen) assert.ok(error.stack)
    error.message = `secret\n${place}`
    return error
  }
  const proxy = new Proxy(new Error('secret'), {
    get: () => {
      throw new Error('secret')
    },
  })
  for (const [problem, error, hasPlace] of [
    [new Error('secret'), 'Error', true],
    [new Error(`secret\n${place}`), 'Error', true],
    [changed(false), 'Error', true],
    [changed(true), 'Error', false],
    [Object.assign(new Error('secret'), { stack: undefined }), 'Error', false],
    [new Odd(), 'unknown', false],
    [proxy, 'unknown', false],
    ['secret', 'string', false],
    [{ secret: 1 }, 'object', false],
    [null, 'null', false],
    [undefined, 'undefined', false],
  ]) {
    const one = watched({
      echo: () => {
        throw problem
      },
    })
    await callEcho(one)
    const [{ fields }] = one.errors()
    assert.deepEqual([fields.error, fields.at !== undefined], [error, hasPlace])
    assert.ok(!JSON.stringify(one.lines).includes('secret'), JSON.stringify(fields))
    assert.equal(one.told[0].error, problem)
  }
})

test('handler_error_reaches_the_hook_with_its_call', async () => {
  const problem = new Stuck('secret')
  const one = watched({ echo: () => Promise.reject(problem) })
  assert.equal((await callEcho(one)).said, 'protocol: the handler threw')
  assert.equal(one.told.length, 1)
  const [{ error, context }] = one.told
  assert.equal(error, problem)
  assert.deepEqual([context.code, context.id, context.connection, context.peer], [100, 1, 1, '127.0.0.1'])
  const refuses = watched({
    echo: () => {
      throw new Refusal(7, 'no')
    },
  })
  await callEcho(refuses)
  assert.deepEqual([refuses.told, refuses.errors()], [[], []])
})

test('hook_error_is_logged_with_class_and_own_line', async () => {
  const handler = () => {
    throw new Error('handler')
  }
  for (const onHandlerError of [
    () => {
      throw new Stuck('secret')
    },
    async () => {
      throw new Stuck('secret')
    },
  ]) {
    const one = watched({ echo: handler }, { onHandlerError })
    await callEcho(one)
    const [, { message, fields }] = one.errors()
    assert.deepEqual([message, fields.error, fields.id], ['`onHandlerError` threw', 'Stuck', 1])
    assert.match(fields.at, /\/handlers\.test\.mjs:\d+:\d+$/)
    assert.ok(!JSON.stringify(one.lines).includes('secret'))
  }
})

test('hook_and_log_that_throw_harm_nothing', async () => {
  const throws = () => {
    throw new Error('hook')
  }
  const rejects = async () => {
    throw new Error('hook')
  }
  for (const hook of [throws, rejects]) {
    const one = robot({ echo: throws }, { log: hook, onHandlerError: hook })
    assert.equal((await callEcho(one)).result, 1)
    assert.equal(one.server.connections().length, 1)
  }
})

test('handler_error_after_its_timeout_is_logged_too', async () => {
  const open = []
  const handler = (_, { signal }) => new Promise((_, reject) => open.push({ signal, reject }))
  const one = watched({ echo: handler, go: handler }, { handlerTimeout: 100 })
  const raw = one.join()
  for (const [id, code] of [
    [1, 100],
    [2, 200],
    [3, 100],
  ])
    await raw.send(ask(id, code), { text: '', metres: 1 })
  await settle()
  await one.clock.advance(100)
  assert.deepEqual(
    raw.take().map((frame) => bodyOf(frame).result),
    [2, 2, 2],
  )
  open[0].reject(new Stuck('late'))
  open[1].reject(new Refusal(7, 'late'))
  // It stops because its signal has aborted.
  open[2].reject(open[2].signal.reason)
  await settle()
  assert.deepEqual(
    one.errors().map(({ fields }) => [fields.error, fields.id]),
    [['Stuck', 1]],
  )
  assert.deepEqual([one.told.length, raw.take()], [1, []])
})

test('without_a_log_errors_are_on_the_console', async (context) => {
  const { mock } = context.mock.method(console, 'error', () => {})
  await callEcho(
    robot({
      echo: () => {
        throw new Stuck('secret')
      },
    }),
  )
  await callEcho(robot({}))
  const lines = mock.calls.map(({ arguments: line }) => line)
  mock.restore()
  assert.equal(lines.length, 1)
  assert.deepEqual([lines[0][0], lines[0][1].error], ['a handler threw', 'Stuck'])
})

test('errors_of_handlers_do_not_flood_the_log', async () => {
  for (const echo of [
    () => {
      throw new Error('')
    },
    () => undefined,
  ]) {
    const one = watched({ echo })
    const raw = one.join()
    for (let id = 0; id < 100; id++) await raw.send(ask(id), { text: '' })
    await settle()
    assert.equal(raw.take().length, 100)
    assert.equal(one.told.length, 100)
    assert.ok(one.errors().length < 10, String(one.errors().length))
  }
})

test('listener_error_is_logged_with_class_and_own_line', async () => {
  for (const listener of [
    () => {
      throw new Stuck('secret')
    },
    async () => {
      throw new Stuck('secret')
    },
  ]) {
    const lines = []
    const { raw, connection } = await client({
      log: (level, message, fields) => lines.push({ level, message, fields }),
    })
    connection.on(moved, listener)
    await raw.send({ kind: KINDS.report, code: 300, id: 1 }, { metres: 1 })
    await settle()
    const [{ message, fields }] = lines.filter(({ level }) => level === 'error')
    assert.deepEqual([message, fields.name, fields.error], ['a listener threw', 'Moved', 'Stuck'])
    assert.match(fields.at, /\/handlers\.test\.mjs:\d+:\d+$/)
    assert.ok(!JSON.stringify(lines).includes('secret'))
    assert.equal(bodyOf(raw.take()[0]).result, 0)
  }
})

/** Values that are neither a message `{ text }` nor one without keys. */
const OTHERS = [
  ['nothing', undefined],
  ['null', null],
  ['a text', 'text'],
  ['a number', 5],
  ['a list', []],
  ['a date', new Date()],
  ['a map', new Map()],
  ['bytes', new Uint8Array(2)],
  ['a function', () => {}],
  ['an error', new Error('secret')],
  ['a refusal that is returned', new Refusal(7, 'no')],
  ['another message', { metres: 1 }],
  ['another message with unknown keys', { metres: 1, extra: [{ key: 'a', json: '1' }] }],
]

test('response_that_is_none_is_refused_by_name', async () => {
  const cases = [
    ...OTHERS.map(([what, response]) => [what, 'echo', response, undefined]),
    ...OTHERS.map(([what, response]) => [what, 'go', response, 'wrong_type']),
    ['a wrong type', 'echo', { text: 5 }, 'wrong_type'],
    ['too long', 'echo', { text: 'x'.repeat(1001) }, 'bad_length'],
    ['half a character', 'echo', { text: '\ud83d' }, 'lone_surrogate'],
    ['unknown keys that are no list', 'echo', { text: '', extra: 5 }, 'wrong_type'],
    ['an unknown key without a name', 'echo', { text: '', extra: [{ json: '1' }] }, 'wrong_type'],
    ['an unknown key that is none', 'echo', { text: '', extra: [null] }, 'wrong_type'],
    ['an unknown key without a value', 'echo', { text: '', extra: [{ key: 'a' }] }, 'wrong_type'],
    ['half a key', 'echo', { text: '', extra: [{ key: '\ud83d', json: '1' }] }, 'lone_surrogate'],
  ]
  for (const [what, name, response, error] of cases) {
    for (const handler of [() => response, async () => response]) {
      const one = watched({ [name]: handler })
      const raw = one.join()
      await raw.send(ask(1, name === 'go' ? 200 : 100), { text: '', metres: 1 })
      await settle()
      assert.deepEqual(
        raw.take().map((frame) => bodyOf(frame).result),
        [1],
        what,
      )
      const [{ message, fields }] = one.errors()
      assert.equal(message, "the handler's response breaks the spec", what)
      assert.equal(fields.name, name)
      if (error === undefined) assert.ok(['wrong_type', 'missing_field'].includes(fields.error), what)
      else assert.equal(fields.error, error, what)
      assert.ok(one.told[0].error instanceof BodyError, what)
    }
  }
})

test('response_of_more_than_is_asked_for_is_taken', async () => {
  class Answer {
    #private = 1
    text = 'a'
    get more() {
      return this.#private
    }
  }
  const bare = Object.assign(Object.create(null), { text: 'a' })
  for (const response of [new Answer(), bare, { text: 'a', more: 5 }]) {
    const one = watched({ echo: () => response })
    assert.deepEqual([(await callEcho(one)).text, one.errors()], ['a', []])
  }
  const one = watched({ go: () => ({ more: undefined, extra: [{ key: 'a', json: '1' }] }) })
  const raw = one.join()
  await raw.send(ask(1, 200), { metres: 1 })
  await settle()
  assert.equal(bodyOf(raw.take()[0]).a, 1)
})

test('response_that_throws_harms_its_own_call_alone', async () => {
  const throwing = {
    get text() {
      throw new Stuck('secret')
    },
  }
  for (const handler of [() => throwing, async () => throwing]) {
    const one = watched({ echo: handler })
    assert.equal((await callEcho(one)).result, 1)
    assert.deepEqual(
      one.errors().map(({ fields }) => fields.error),
      ['Stuck'],
    )
    assert.equal(one.server.connections().length, 1)
  }
})

test('refusal_that_no_response_can_carry_is_an_error', async () => {
  for (const refusal of [
    new Refusal(5.5, 'a'),
    new Refusal(Number.NaN, 'a'),
    new Refusal('7', 'a'),
    new Refusal(undefined, 'a'),
    new Refusal(2 ** 31, 'a'),
    new Refusal(7, 'half: \ud83d'),
    new Refusal(7, 7),
    new Refusal(0, 'this says that all went well'),
  ]) {
    for (const handler of [
      () => {
        throw refusal
      },
      async () => {
        throw refusal
      },
    ]) {
      const one = watched({ echo: handler })
      assert.equal((await callEcho(one)).result, 1, String(refusal))
      assert.equal(one.errors().length, 1, String(refusal))
      assert.equal(one.told.length, 1, String(refusal))
      const { callsProtocol, callsRefused } = one.server.counters()
      assert.deepEqual([callsProtocol, callsRefused], [1, 0], String(refusal))
    }
  }
})

test('response_or_refusal_too_long_is_a_protocol_error', async () => {
  const noise = Array.from({ length: 60_000 }, (_, at) =>
    String.fromCharCode(0x4e00 + ((at * 2654435761) >>> 20)),
  ).join('')
  const extra = [{ key: 'more', json: JSON.stringify(noise) }]
  for (const gzip of [null, { fromBytes: 0 }]) {
    const one = watched({ echo: () => ({ text: '', extra }) }, { gzip })
    assert.equal((await callEcho(one)).result, 1)
    assert.deepEqual(
      one.errors().map(({ message }) => message),
      ['the response does not fit into a frame'],
    )
    assert.equal(one.told.length, 1)
    assert.equal(one.server.counters().callsSucceeded, 0)
    const refuses = watched(
      {
        echo: () => {
          throw new Refusal(7, noise)
        },
      },
      { gzip },
    )
    assert.equal((await callEcho(refuses)).result, 1)
    const { callsProtocol, callsRefused } = refuses.server.counters()
    assert.deepEqual([callsProtocol, callsRefused], [1, 0])
  }
  // Even the protocol's own result does not fit.
  const one = watched({ echo: () => ({ text: '' }) }, { limits: { frameBytes: 60 } })
  const raw = one.join()
  await raw.send(ask(1), { text: '' })
  await settle()
  assert.deepEqual(raw.take(), [])
  assert.equal(one.server.connections().length, 1)
  assert.equal(one.server.counters().callsProtocol, 1)
})

test('invalid_messages_are_refused_by_name', async () => {
  const { connection, raw } = await client()
  const data = connection.data()
  const { server, join } = robot({})
  const app = join()
  const texts = OTHERS.filter(([what]) => !what.startsWith('another message'))
  for (const [what, message] of [...texts, ['another message', { text: 'a' }]]) {
    assert.equal((await ends(connection.call(go, message))).kind, 'invalid_request', what)
    const pushed = await ends(server.push('all', moved, message))
    assert.ok(pushed instanceof PushError && pushed.body instanceof BodyError, what)
    assert.equal(pushed.kind, 'invalid_report', what)
    assert.equal((await ends(server.sendStream('all', scans, 1, message))).kind, 'invalid_report', what)
    assert.equal((await ends(data.sendStream(scans, 1, message))).kind, 'invalid', what)
    if (what === 'bytes') continue
    assert.equal((await ends(server.sendStream('all', pictures, 1, message))).kind, 'invalid_report', what)
    assert.equal((await ends(data.sendStream(pictures, 1, message))).kind, 'invalid', what)
  }
  for (const json of [undefined, null, 5, {}]) {
    assert.equal((await ends(connection.callRaw(100, json))).kind, 'invalid_request', String(json))
  }
  await settle()
  assert.deepEqual([raw.take(), app.take()], [[], []], 'nothing was sent')
})

test('requests_with_one_id_each_get_an_answer', async () => {
  const open = []
  const handler = ({ text }) => new Promise((resolve) => open.push(() => resolve({ text })))
  const { server, join, clock } = robot({ echo: handler }, { handlerTimeout: 100 })
  const raw = join()
  for (const text of ['a', 'b', 'c']) await raw.send(ask(7), { text })
  await settle()
  assert.equal(open.length, 3)
  for (const answer of open.reverse()) answer()
  await settle()
  assert.deepEqual(
    raw.take().map((frame) => [frame.id.id, bodyOf(frame).text]),
    [
      [7, 'c'],
      [7, 'b'],
      [7, 'a'],
    ],
  )
  for (const text of ['d', 'e', 'f']) await raw.send(ask(7), { text })
  await settle()
  open[4]()
  await settle()
  await clock.advance(100)
  assert.deepEqual(
    raw.take().map((frame) => [frame.id.id, bodyOf(frame).result]),
    [
      [7, 0],
      [7, 2],
      [7, 2],
    ],
  )
  assert.deepEqual([server.counters().callsSucceeded, server.counters().callsTimedOut], [4, 2])
})

/** Joins an app that sends many requests and reads nothing. */
async function pipelined(join, requests) {
  const raw = join(1000)
  raw.end.read = () => new Promise(() => {})
  await settle()
  for (let id = 0; id < requests; id++) void raw.send(ask(id), { text: '' })
  await settle()
  return raw
}

test('app_that_never_reads_is_not_read_either', async () => {
  const extra = [{ key: 'more', json: `"${'x'.repeat(50_000)}"` }]
  const slowly = { ...nodeAlgorithms, gzip: (data) => new Promise((resolve) => setImmediate(resolve, data)) }
  for (const [gzip, algorithms] of [
    [null, nodeAlgorithms],
    [{ fromBytes: 0 }, slowly],
  ]) {
    for (const echo of [() => ({ text: '', extra }), async () => ({ text: '', extra })]) {
      let asked = 0
      const one = robot(
        {
          echo: () => {
            asked++
            return echo()
          },
        },
        { gzip },
        algorithms,
      )
      await pipelined(one.join, 2000)
      // Of 100 MB of responses, only those up to the mark and those of running handlers exist.
      assert.ok(asked < 100, String(asked))
      assert.ok(one.server.memory() < 5_000_000, String(one.server.memory()))
      const other = one.join()
      await other.send(ask(1), { text: '' })
      await settle()
      assert.equal(bodyOf(other.take()[0]).result, 0, 'another app is served')
    }
  }
})

test('unread_responses_count_as_memory', async () => {
  const open = []
  const handler = () => new Promise((resolve) => open.push(resolve))
  const { server, join } = robot({ echo: handler }, { memory: 400_000 })
  const other = join()
  const raw = await pipelined(join, 64)
  assert.equal(open.length, 64)
  const extra = [{ key: 'more', json: `"${'x'.repeat(50_000)}"` }]
  for (const resolve of open) resolve({ text: '', extra })
  await settle()
  assert.ok(raw.isClosed || server.connections().length === 1)
  assert.equal(server.counters().connectionsEvicted, 1)
  assert.ok(server.memory() <= 400_000, String(server.memory()))
  assert.ok(!other.isClosed)
})

test('leaving_app_gets_responses_in_compression', async () => {
  for (const isBroken of [false, true]) {
    let pack = () => {}
    const gzip = (data) =>
      new Promise((resolve, reject) => {
        pack = () => (isBroken ? reject(new Error('full')) : resolve(nodeAlgorithms.gzip(data)))
      })
    const methods = { echo: () => ({ text: 'x'.repeat(900) }) }
    const { join } = robot(methods, { gzip: { fromBytes: 0 } }, { ...nodeAlgorithms, gzip })
    const raw = join()
    await raw.send(ask(1), { text: '' })
    raw.end.end()
    await settle()
    assert.ok(!raw.isClosed)
    pack()
    await settle()
    assert.equal(bodyOf(raw.take()[0]).text.length, 900)
    assert.ok(raw.isClosed)
  }
})
