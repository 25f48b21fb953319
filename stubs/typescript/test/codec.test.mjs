// Messages beyond the vectors: the order of errors, checks before sending, and the limits of reading.

import assert from 'node:assert/strict'
import { test } from 'node:test'
import { BodyError, Session, bytesOf, readEnveloped, readMessage, writeEnveloped, toJson } from 'fc-protocol/runtime'

const ANY = { depth: 64, values: 1 << 20 }
const inner = { is: 'struct', name: 'Inner', fields: { of: { key: 'of', type: 'u8', max: 5 } } }
const struct = {
  is: 'struct',
  name: 'Outer',
  fields: {
    whole: { key: 'whole', type: 'i32', min: 0 },
    large: { key: 'large', type: 'i64', optional: true },
    safe: { key: 'safe', type: 'i64', safe: true, optional: true, min: 0, max: Number.MAX_SAFE_INTEGER },
    short: { key: 'short', type: 'f32', optional: true },
    text: { key: 'text', type: 'string', optional: true, length: [0, 3] },
    bytes: { key: 'bytes', type: 'base64', optional: true },
    open: { key: 'open', type: 'json', optional: true },
    parts: { key: 'parts', type: { list: () => inner }, optional: true },
  },
}
const envelope = { is: 'struct', name: 'Envelope', fields: { time: { key: 'time', type: 'i64', optional: true } } }

/** Returns the kind and the path of the error thrown. */
function fault(run) {
  try {
    run()
  } catch (problem) {
    assert.ok(problem instanceof BodyError, String(problem))
    return [problem.kind, problem.path]
  }
  return null
}

const faultOf = (text, allowance = ANY) => fault(() => readMessage(struct, bytesOf(text), allowance))

test('the first error in the order of the rules is reported with its place', () => {
  for (const [text, kind, path] of [
    // Invalid JSON comes before all errors inside it.
    ['{"whole":"x",}', 'bad_json', ''],
    [`{"whole":"x","x":${'['.repeat(65)}${']'.repeat(65)}}`, 'too_deep', ''],
    // Wrong types come before missing fields, and these before constraints.
    ['{"text":"abcd","large":"x"}', 'wrong_type', 'large'],
    ['{"text":"abcd"}', 'missing_field', 'whole'],
    ['{"text":"abcd","whole":-1}', 'out_of_range', 'whole'],
    // Errors of a nested object come at its end.
    ['{"whole":-1,"parts":[{"of":1},{"of":6}]}', 'out_of_range', 'parts[1].of'],
    ['{"whole":1,"parts":[{"of":1},{}]}', 'missing_field', 'parts[1].of'],
    ['{"whole":1,"parts":[1]}', 'wrong_type', 'parts[0]'],
    ['{"whole":1,"whole":2}', 'duplicate_key', 'whole'],
    ['{"whole":1,"safe":9007199254740992}', 'out_of_range', 'safe'],
    ['[]', 'not_an_object', ''],
  ]) {
    assert.deepEqual(faultOf(text), [kind, path], text)
  }
})

test('an envelope error precedes a message error', () => {
  const found = (text) => fault(() => readEnveloped(envelope, struct, bytesOf(text), ANY))
  assert.deepEqual(found('{"whole":"x","time":"y"}'), ['wrong_type', 'time'])
  assert.deepEqual(found('{"time":1,"whole":"x"}'), ['wrong_type', 'whole'])
})

test('envelope and message keys mix, and unknown keys stay with the message', () => {
  const text = '{"b":[1.0,1.0],"whole":1,"time":2,"b":"\\ud800","a b":1e400}'
  const read = readEnveloped(envelope, struct, bytesOf(text), ANY)
  assert.deepEqual(read.envelope, { time: 2n })
  const extra = [
    { key: 'b', json: '[1.0,1.0]' },
    { key: 'b', json: '"\\ud800"' },
    { key: 'a b', json: '1e400' },
  ]
  assert.deepEqual(read.message, { whole: 1, extra })
  const written = writeEnveloped(envelope, read.envelope, struct, read.message)
  assert.equal(written, '{"time":2,"whole":1,"b":[1.0,1.0],"b":"\\ud800","a b":1e400}')
})

test('values are what the language has for them', () => {
  const read = (text) => readMessage(struct, bytesOf(text), ANY)
  assert.deepEqual(
    read('{"whole":-0,"large":9007199254740993,"safe":5e2,"short":0.1,"bytes":"AAEC","open":{"x" : 1.0}}'),
    {
      whole: 0,
      large: 9007199254740993n,
      safe: 500,
      short: 0.1,
      bytes: Uint8Array.of(0, 1, 2),
      open: '{"x" : 1.0}',
    },
  )
  // A key with the name of a built-in property is an ordinary key.
  const odd = read('{"whole":1,"__proto__":{"polluted":1},"constructor":2}')
  assert.deepEqual(
    odd.extra.map(({ key }) => key),
    ['__proto__', 'constructor'],
  )
  assert.equal(Object.getPrototypeOf(odd), Object.prototype)
})

test('a message that breaks its constraints is refused before sending', () => {
  for (const [message, kind, path] of [
    [{}, 'missing_field', 'whole'],
    [{ whole: 1.5 }, 'wrong_type', 'whole'],
    [{ whole: 1n }, 'wrong_type', 'whole'],
    [{ whole: 2 ** 31 }, 'out_of_range', 'whole'],
    [{ whole: -1 }, 'out_of_range', 'whole'],
    [{ whole: 1, large: 1 }, 'wrong_type', 'large'],
    [{ whole: 1, large: 2n ** 63n }, 'out_of_range', 'large'],
    [{ whole: 1, short: Number.NaN }, 'out_of_range', 'short'],
    [{ whole: 1, short: 1e39 }, 'out_of_range', 'short'],
    [{ whole: 1, text: 'abcd' }, 'bad_length', 'text'],
    [{ whole: 1, text: '\ud800' }, 'lone_surrogate', 'text'],
    [{ whole: 1, bytes: 'AAEC' }, 'wrong_type', 'bytes'],
    [{ whole: 1, parts: [{ of: 1 }, { of: 6 }] }, 'out_of_range', 'parts[1].of'],
    // JSON text from the caller cannot end the surrounding object.
    [{ whole: 1, open: '1}, {' }, 'bad_json', 'open'],
    [{ whole: 1, extra: [{ key: 'x', json: '1,"whole":2' }] }, 'bad_json', ''],
  ]) {
    assert.deepEqual(
      fault(() => toJson(struct, message)),
      [kind, path],
    )
  }
  assert.equal(toJson(struct, { whole: 1, short: 16777217, text: undefined }), '{"whole":1,"short":16777216}')
})

test('the cost of reading is bounded', () => {
  const depth = 3
  assert.equal(faultOf('{"whole":1,"x":[[1]]}', { ...ANY, depth }), null)
  assert.deepEqual(faultOf('{"whole":1,"x":[[[1]]]}', { ...ANY, depth })?.[0], 'too_deep')
  assert.equal(faultOf('{"whole":1,"x":[1,2]}', { ...ANY, values: 4 }), null)
  assert.deepEqual(faultOf('{"whole":1,"x":[1,2]}', { ...ANY, values: 3 })?.[0], 'too_many_values')
  // The scanner sets the limit, not the stack.
  const brackets = '['.repeat(100_000)
  assert.equal(faultOf(`{"x":${brackets}`)?.[0], 'too_deep')
  assert.equal(faultOf(`{"x":${brackets}${']'.repeat(100_000)}}`)?.[0], 'too_deep')
})

test('ids in flight are skipped after a wrap', () => {
  const ack = { timeout: 9, retries: 0 }
  const session = new Session({ report: 3, stream: 0, inFlight: 64, remembers: 4, ack, firstId: 6, idMax: 7 })
  const open = () => session.open(1, 5, ack, 0, null)?.id ?? null
  const first = open()
  assert.equal(first, 6)
  for (const expected of [7, 0, 1, 2, 3, 4, 5, 7]) {
    const id = open()
    assert.equal(id, expected)
    assert.ok(session.cancel({ response: false, kind: 1, code: 5, id }))
  }
  // At most half of all ids.
  assert.deepEqual([open(), open(), open(), open()], [0, 1, 2, null])
})
