// Settings and call options out of range are refused by name, before anything starts.

import assert from 'node:assert/strict'
import { readFileSync } from 'node:fs'
import path from 'node:path'
import { test } from 'node:test'
import { nodePlatform } from 'fc-protocol/node'
import { dial, dialLater, serveRobot } from 'fc-protocol/runtime'
import { root } from './support.mjs'
import { FakePlatform, client, echo, moved, pictures, robot, service, settle, toy } from './toy.mjs'

/** Returns the numbers of an interface, read from its declaration, so that a new one is tested as well. */
function numbersOf(file, name) {
  const declarations = readFileSync(path.join(root, 'dist/src', file), 'utf8')
  const [, body] = new RegExp(`interface ${name} \\{([^]*?)\n\\}`).exec(declarations)
  return [...body.matchAll(/readonly (\w+)\??: number/g)].map(([, member]) => member)
}

const nested = (group, names) => names.map((name) => [`${group}.${name}`, (value) => ({ [group]: { [name]: value } })])
const plain = (names) => names.map((name) => [name, (value) => ({ [name]: value })])
const shared = [...nested('limits', numbersOf('wire.d.ts', 'Limits')), ...nested('gzip', ['fromBytes'])]

const CLIENT = [
  ...plain(numbersOf('client/config.d.ts', 'ClientConfig')),
  ...nested('reconnect', numbersOf('client/config.d.ts', 'Backoff')),
  ...shared,
]
const SERVER = [...plain(numbersOf('server/config.d.ts', 'ServerConfig')), ...shared]
const CALL = plain(numbersOf('client/config.d.ts', 'CallOptions'))

/** Settings where `null` means no limit, or none. */
const NULLABLE = ['keepalive', 'maxAge', 'idleTimeout', 'reconnect.attempts']

const NO_NUMBERS = [Number.NaN, -1, Number.POSITIVE_INFINITY, '5', '', true, {}, 5n]

/** Returns the result or the error of a promise, or of a call that throws. */
const ends = async (begin) => {
  try {
    return await begin()
  } catch (problem) {
    return problem
  }
}

/** Asserts that an error names a setting and the expected values. */
function assertNames(problem, setting, what) {
  assert.ok(problem instanceof TypeError || problem instanceof RangeError, `${what}: ${problem}`)
  assert.match(problem.message, new RegExp(`^\`(?:\\w+\\.)?${setting.replace('.', '\\.')}\` is .+, expected .+`), what)
}

test('every_number_of_the_declarations_is_found', () => {
  assert.ok(CLIENT.length >= 18 && SERVER.length >= 22, `${CLIENT.length} ${SERVER.length}`)
  assert.deepEqual(CALL, [['timeout', CALL[0][1]]])
})

for (const [title, settings, begin] of [
  ['connect', CLIENT, (config) => dial(toy, new FakePlatform(), config)],
  ['connect_lazily', CLIENT, (config) => dialLater(toy, new FakePlatform(), config)],
  ['robot', SERVER, (config) => robot({}, config)],
  ['serve', SERVER, (config) => serveRobot(toy, service, nodePlatform, {}, config)],
]) {
  test(`${title}_refuses_numbers_that_make_no_sense`, async () => {
    for (const [name, config] of settings) {
      const others = NULLABLE.includes(name) ? [] : [null]
      for (const value of [...NO_NUMBERS, ...others]) {
        assertNames(await ends(() => begin(config(value))), name, `${name}: ${String(value)}`)
      }
    }
  })
}

test('connect_refuses_other_settings_that_make_no_sense', async () => {
  for (const [name, config] of [
    ['host', { host: '' }],
    ['host', { host: '  ' }],
    ['host', { host: null }],
    ['host', { host: 1 }],
    ['commandPort', { commandPort: 0 }],
    ['commandPort', { commandPort: 65_536 }],
    ['dataPort', { dataPort: 1.5 }],
    ['reconnect', { reconnect: false }],
    ['gzip', { gzip: false }],
    ['limits', { limits: 5 }],
    ['limits.inFlight', { limits: { inFlight: 0 } }],
    ['verifyDigest', { verifyDigest: 'no' }],
    ['resync', { resync: 'yes' }],
    ['log', { log: 'console' }],
    ['ClientConfig', null],
    ['ClientConfig', []],
  ]) {
    assertNames(await ends(() => dial(toy, new FakePlatform(), config)), name, JSON.stringify(config))
  }
})

test('robot_refuses_other_settings_that_make_no_sense', async () => {
  for (const [name, config] of [
    ['address', { address: '' }],
    ['commandPort', { commandPort: 65_536 }],
    ['dataPort', { dataPort: '5656' }],
    ['gzip', { gzip: true }],
    ['verifyDigest', { verifyDigest: 1 }],
    ['resync', { resync: 1 }],
    ['log', { log: {} }],
    ['onHandlerError', { onHandlerError: true }],
    ['onCall', { onCall: [] }],
    ['allow', { allow: '10.0.0.0/8' }],
    ['allow\\[0\\]', { allow: ['10.0.0.0/8'] }],
    ['allow\\[0\\].network', { allow: [{ network: 10, effects: 'all' }] }],
    ['allow\\[0\\].effects', { allow: [{ network: '10.0.0.0/8', effects: 'read' }] }],
    ['allow\\[0\\].effects', { allow: [{ network: '10.0.0.0/8', effects: ['raed'] }] }],
  ]) {
    assertNames(await ends(() => robot({}, config)), name, JSON.stringify(config))
  }
})

test('call_refuses_options_that_make_no_sense', async () => {
  const { raw, connection } = await client()
  for (const [name, option] of CALL) {
    for (const value of [...NO_NUMBERS, null]) {
      for (const call of [
        () => connection.call(echo, { text: '' }, option(value)),
        () => connection.callAny(echo, { text: '' }, option(value)),
        () => connection.callRaw(100, '{}', option(value)),
      ]) {
        assertNames(await ends(call), name, `${name}: ${String(value)}`)
      }
    }
  }
  for (const [name, options] of [
    ['repeat', { repeat: 'yes' }],
    ['signal', { signal: true }],
    ['CallOptions', null],
    ['CallOptions', 500],
  ]) {
    assertNames(await ends(() => connection.call(echo, { text: '' }, options)), name, JSON.stringify(options))
  }
  await settle()
  assert.deepEqual([connection.inFlight, raw.take()], [0, []], 'nothing was begun')
})

test('frames_refuse_codes_and_ids_that_no_header_holds', async () => {
  const { connection } = await client()
  const data = connection.data()
  const { server } = robot({})
  const bytes = new Uint8Array(1)
  for (const value of [Number.NaN, -1, 1.5, 2 ** 32, '5', undefined]) {
    assertNames(await ends(() => connection.callRaw(value, '{}')), 'code', String(value))
    assertNames(await ends(() => data.send(value, 1, bytes)), 'code', String(value))
    assertNames(await ends(() => data.send(1, value, bytes)), 'id', String(value))
    assertNames(await ends(() => server.sendBytes('all', value, 1, bytes)), 'code', String(value))
    assertNames(await ends(() => server.sendStream('all', pictures, value, bytes)), 'id', String(value))
  }
  assertNames(await ends(() => connection.callRaw(65_536, '{}')), 'code', 'beyond two bytes')
  assert.equal(connection.inFlight, 0)
})

test('shutdown_refuses_a_grace_that_makes_no_sense', async () => {
  const { server, join } = robot({})
  const raw = join()
  for (const grace of [Number.NaN, -1, '5', undefined]) {
    assertNames(await ends(() => server.shutdown(grace)), 'grace', String(grace))
  }
  await settle()
  assert.ok(!raw.isClosed, 'the robot goes on')
})

test('undefined_settings_keep_their_defaults', async () => {
  const all = (names) => Object.fromEntries(names.map((name) => [name, undefined]))
  const limits = all(numbersOf('wire.d.ts', 'Limits'))
  const app = await client({ limits, reconnect: { first: undefined, longest: undefined }, callTimeout: undefined })
  const calls = Array.from({ length: 65 }, () => ends(() => app.connection.call(echo, { text: '' })))
  assert.equal(app.connection.inFlight, 64)
  assert.equal((await calls[64]).kind, 'busy')
  await app.clock.advance(3000)
  assert.equal((await calls[0]).kind, 'timeout')
  const { server, join } = robot({}, { limits, handlerTimeout: undefined, queuedBytes: undefined })
  const raw = join()
  const pushes = Array.from({ length: 90 }, () => server.push('all', moved, { metres: 1 }))
  await settle()
  assert.equal(raw.take().length, 64)
  assert.equal((await pushes[64])[0].outcome, 'dropped')
})
