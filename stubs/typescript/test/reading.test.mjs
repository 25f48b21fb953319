// The fast reader of bytes gives the same result as a slow and plain reader.

import assert from 'node:assert/strict'
import { test } from 'node:test'
import { BodyError, readMessage, toJson } from 'fc-protocol/runtime'
import { base64Of, bytesOfBase64 } from '../dist/src/base64.js'
import { room, utf8Of } from '../dist/src/room.js'
import { Scanner } from '../dist/src/scanner.js'

const ANY = { depth: 64, values: 1 << 20 }
const struct = {
  is: 'struct',
  name: 'All',
  fields: {
    number: { key: 'number', type: 'f64', optional: true },
    quoted: { key: 'quoted', type: 'f64', form: 'string', optional: true },
    lenient: { key: 'lenient', type: 'i64', lenientNumber: true, optional: true },
    whole: { key: 'whole', type: 'i32', optional: true },
    text: { key: 'text', type: 'string', optional: true },
    open: { key: 'open', type: 'json', optional: true },
  },
}

const read = (bytes) => readMessage(struct, bytes, ANY)
const utf8 = (text) => new TextEncoder().encode(text)
const kindOf = (bytes) => {
  try {
    read(bytes)
  } catch (problem) {
    assert.ok(problem instanceof BodyError, String(problem))
    return problem.kind
  }
  return null
}

test('numbers are rounded to the nearest with any digits', () => {
  const some = ['0', '-0', '1', '10', '0.1', '-0.5', '1.0', '123456789012345', '1234567890123456', '9007199254740993']
  const more = ['0.30000000000000004', '1e3', '1E-3', '2.5e+10', '0.000001', '99999999.9999999', '4.35', '1e400']
  for (let count = 0; count < 2000; count++) more.push(String((Math.random() - 0.5) * 10 ** (count % 18)))
  for (const text of [...some, ...more]) {
    const wanted = Number(text)
    if (!Number.isFinite(wanted)) {
      assert.equal(kindOf(utf8(`{"number":${text}}`)), 'out_of_range', text)
      continue
    }
    assert.ok(Object.is(read(utf8(`{"number":${text}}`)).number, wanted), text)
    assert.ok(Object.is(read(utf8(`{ "quoted" : "${text}" }`)).quoted, wanted), text)
  }
})

test('text after a number makes it invalid', () => {
  for (const text of ['01', '-', '1.', '.5', '+1', '1.e3', '1e', '0x10', '1 1', '--1', '1.5.5', '']) {
    assert.equal(kindOf(utf8(`{"number":${text}}`)), 'bad_json', text)
    assert.equal(kindOf(utf8(`{"quoted":"${text}"}`)), 'wrong_type', text)
  }
  assert.equal(read(utf8('{"lenient":"0x10"}')).lenient, 16n)
  assert.equal(read(utf8('{"lenient":"16"}')).lenient, 16n)
  assert.equal(read(utf8('{"lenient":16}')).lenient, 16n)
  assert.equal(read(utf8('{"whole":1.0}')).whole, 1)
  assert.ok(Object.is(read(utf8('{"whole":-0}')).whole, 0))
})

test('texts decode as UTF-8 in every place', () => {
  for (const text of [
    '',
    'a',
    'é',
    '门',
    '🤖',
    '\u007f\u0080\ufffd',
    'x'.repeat(70),
    `${'x'.repeat(70)}门`,
    '门'.repeat(70),
  ]) {
    for (const around of [text, `"${text}\\`, `\n${text}门${text}`]) {
      const bytes = utf8(JSON.stringify({ text: around, open: [around], [`${around} key`]: { [around]: around } }))
      const message = read(bytes)
      assert.equal(message.text, around)
      assert.equal(message.open, JSON.stringify([around]))
      assert.deepEqual(message.extra, [{ key: `${around} key`, json: JSON.stringify({ [around]: around }) }])
      assert.equal(toJson(struct, message), new TextDecoder().decode(bytes))
    }
  }
})

test('the reader and TextDecoder agree on UTF-8', () => {
  const strict = new TextDecoder('utf-8', { fatal: true, ignoreBOM: true })
  const quote = (bytes) => Uint8Array.from([...utf8('{"text":"'), ...bytes, ...utf8('"}')])
  const judged = (bytes) => {
    let wanted = null
    try {
      wanted = strict.decode(Uint8Array.from(bytes))
    } catch {
      assert.equal(kindOf(quote(bytes)), 'not_utf8', String(bytes))
      return
    }
    assert.equal(read(quote(bytes)).text, wanted, String(bytes))
  }
  const edges = [0x41, 0x7f, 0x80, 0x8f, 0x90, 0x9f, 0xa0, 0xbf, 0xc0]
  for (let first = 0x80; first <= 0xff; first++) {
    for (let second = 0x5d; second <= 0xff; second++) judged([first, second])
    for (const second of edges) for (const third of edges) judged([first, second, third])
    for (const second of edges) judged([first, second, 0x80, 0xbf])
  }
})

test('invalid UTF-8 is refused in every place', () => {
  const places = [
    '{"text":"?"}',
    '{"?":1}',
    '{"no":{"?":1}}',
    '{"no":["?"]}',
    '{"open":"?"}',
    '{"text":"\\n?"}',
    '{?}',
    '?',
    '{"whole":"?"}',
  ]
  // Too short, overlong, half of a surrogate pair, beyond Unicode, no first byte.
  for (const wrong of [[0xe9, 0x97], [0xc0, 0xaf], [0xed, 0xa0, 0x80], [0xf4, 0x90, 0x80, 0x80], [0x80]]) {
    for (const place of places) {
      for (const padding of ['', 'x'.repeat(70)]) {
        const [before, after] = place.split('?')
        const bytes = Uint8Array.from([...utf8(before + padding), ...wrong, ...utf8(padding + after)])
        assert.equal(kindOf(bytes), 'not_utf8', `${place} ${wrong}`)
      }
    }
  }
})

test('base64 is that of the platform, of every length', () => {
  for (let length = 0; length < 100; length++) {
    const bytes = Uint8Array.from({ length }, (_, at) => (at * 89 + length) & 0xff)
    const text = Buffer.from(bytes).toString('base64')
    assert.equal(base64Of(bytes), text)
    assert.deepEqual(bytesOfBase64(text), bytes)
  }
})

test('buffers held at the same time are distinct', () => {
  const held = []
  for (let count = 0; count < 3000; count++) held.push({ bytes: room(count % 300).fill(count & 0xff), count })
  const texts = Array.from({ length: 3000 }, (_, count) => ({ text: `门${count}`, bytes: utf8Of(`门${count}`) }))
  for (const { bytes, count } of held) assert.ok(bytes.every((byte) => byte === (count & 0xff)))
  for (const { text, bytes } of texts) assert.deepEqual(new Uint8Array(bytes), utf8(text))
  const long = '门'.repeat(40_000)
  assert.deepEqual(new Uint8Array(utf8Of(long)), utf8(long))
})

test('a browser has a character for each byte as well', async () => {
  const { Buffer } = globalThis
  delete globalThis.Buffer
  const { oneForEach } = await import('../dist/src/characters.js?browser')
  globalThis.Buffer = Buffer
  const text = oneForEach(Uint8Array.from({ length: 256 }, (_, byte) => byte))
  assert.equal(text.length, 256)
  for (let byte = 0; byte < 128; byte++) assert.equal(text.charCodeAt(byte), byte)
  for (let byte = 128; byte < 256; byte++) assert.ok(text.charCodeAt(byte) >= 128, String(byte))
  assert.equal(oneForEach(new Uint8Array()), '')
})

test('value_limit_applies_while_reading', () => {
  const choice = { is: 'choice', name: 'Any', forms: { All: () => struct } }
  const holder = { is: 'struct', name: 'Holder', fields: { one: { key: 'one', type: () => choice, optional: true } } }
  const many = '"a":[[1,2]],'
  // After the limit comes an invalid character: a reader that goes that far reports it.
  for (const [type, text] of [
    [struct, `{${many.repeat(30)}?`],
    [struct, `{"open":{${many.repeat(30)}?`],
    [struct, `{"more":[${'[],'.repeat(120)}?`],
    [holder, `{"one":{${many.repeat(30)}?`],
    [holder, `{"one":{"a":[${'{},'.repeat(120)}?`],
  ]) {
    assert.throws(() => readMessage(type, utf8(text), { depth: 64, values: 100 }), { kind: 'too_many_values' }, text)
    assert.throws(() => readMessage(type, utf8(text), { depth: 64, values: 1000 }), { kind: 'bad_json' }, text)
  }
  const scanner = new Scanner(utf8(`{${many.repeat(30)}?`), { depth: 64, values: 100 })
  assert.throws(() => scanner.keysAhead(), { kind: 'too_many_values' })
  assert.ok(scanner.at <= 25 * many.length + 1, String(scanner.at))
  const deep = new Scanner(utf8(`{"a":${'['.repeat(100)}`), { depth: 64, values: 100 })
  assert.throws(() => deep.keysAhead(), { kind: 'too_deep' })
})
