// Splits captures: frames, bytes between them, the missing part at the end, and pairs of requests and responses.

import assert from 'node:assert/strict'
import { test } from 'node:test'
import { engine } from './support.mjs'

const lab = await engine()
const { codec, protocol } = lab
const operation = protocol.operations.find(({ kind, code }) => kind === 'command' && code !== null)
const report = protocol.operations.find(({ kind, code }) => kind === 'report' && code !== null)
const role = (name) => protocol.header.find((field) => field.role === name)

const frame = (side, id, { of = operation, gzip = false } = {}) =>
  lab.messageFrame(codec, of, { side, id, gzip }, side === 'request' ? of.requestExample : of.responseExample)
const join = (...parts) => Uint8Array.from(parts.flatMap((part) => [...part]))
const read = (...parts) => lab.readCapture(codec, [{ stream: 0, bytes: join(...parts) }])
/** The frame with one header field overwritten. */
function changed(bytes, name, value) {
  const copy = Uint8Array.from(bytes)
  const field = role(name)
  lab.writeUint(copy.subarray(field.offset, field.offset + field.size), value, protocol.byteOrder)
  return copy
}
const spoiled = (bytes) => Uint8Array.from(bytes, (byte, index) => (index === bytes.length - 1 ? byte ^ 1 : byte))

const request = frame('request', 7)
const response = frame('response', 7)
const next = frame('request', 8, { gzip: true })
const garbage = [0, 1, 2, protocol.requestHead[0], 3]

/** Name, pasted text, pieces as `[is, at, length, fault]`, level. */
const CASES = [
  ['one frame', [request], [['frame', 0, request.length, null]], 'good'],
  ['request and response', [request, response], [['frame', 0, request.length, null], ['frame', request.length, response.length, null]], 'good'],
  ['one byte before', [[0], request], [['garbage', 0, 1, 'bad_head'], ['frame', 1, request.length, null]], 'bad'],
  [
    'garbage between',
    [request, garbage, next],
    [['frame', 0, request.length, null], ['garbage', request.length, 5, 'bad_head'], ['frame', request.length + 5, next.length, null]],
    'bad',
  ],
  ['garbage behind', [request, garbage], [['frame', 0, request.length, null], ['garbage', request.length, 5, 'bad_head']], 'bad'],
  ['only garbage', [garbage], [['garbage', 0, 5, 'bad_head']], 'bad'],
  ['the end is missing', [request, response.slice(0, -12)], [['frame', 0, request.length, null], ['partial', request.length, response.length - 12, 'truncated']], 'bad'],
  ['half a head at the end', [request, protocol.responseHead.slice(0, 1)], [['frame', 0, request.length, null], ['partial', request.length, 1, 'truncated']], 'bad'],
  ['garbage, then the beginning of a frame', [garbage, request.slice(0, 5)], [['garbage', 0, 5, 'bad_head'], ['partial', 5, 5, 'truncated']], 'bad'],
  [
    'a frame lost bytes in the middle',
    [response.slice(0, 50), response.slice(60), next],
    [['frame', 0, response.length - 10, 'truncated'], ['frame', response.length - 10, next.length, null]],
    'bad',
  ],
  [
    'a frame lost its end',
    [response.slice(0, -20), next, request],
    [['frame', 0, response.length - 20, 'truncated'], ['frame', response.length - 20, next.length, null], ['frame', response.length - 20 + next.length, request.length, null]],
    'bad',
  ],
  ['a wrong digest', [spoiled(request), response], [['frame', 0, request.length, 'bad_digest'], ['frame', request.length, response.length, null]], 'bad'],
  [
    'an impossible length',
    [changed(request, 'total_length', 2 ** 30), response],
    [['frame', 0, request.length, 'frame_too_long'], ['frame', request.length, response.length, null]],
    'bad',
  ],
  [
    'a length below the header',
    [changed(request, 'total_length', 1), response],
    [['frame', 0, request.length, 'short_frame'], ['frame', request.length, response.length, null]],
    'bad',
  ],
  ['a code that nobody knows', [changed(request, 'code', 0xfffe)], [['frame', 0, request.length, null]], 'care'],
  ['nothing', [], [], 'good'],
]

for (const [name, parts, pieces, level] of CASES) {
  test(`split: ${name}`, () => {
    const capture = read(...parts)
    assert.deepEqual(capture.pieces.map(({ is, at, bytes, fault }) => [is, at, bytes.length, fault]), pieces)
    assert.equal(capture.level, level)
    // Every byte is in exactly one piece, in order.
    assert.deepEqual(join(...capture.pieces.map(({ bytes }) => bytes)), join(...parts))
    const garbage = pieces.filter(([is]) => is === 'garbage').reduce((sum, [, , length]) => sum + length, 0)
    assert.equal(capture.skipped, garbage)
  })
}

test('an incomplete frame shows the number of missing bytes', () => {
  const last = (...parts) => read(...parts).pieces.at(-1).missing
  assert.deepEqual(last(request, response.slice(0, -12)), { bytes: 12, atLeast: false })
  // Without its length, only the length of the header is known.
  assert.deepEqual(last(request.slice(0, 3)), { bytes: protocol.headerLength - 3, atLeast: true })
  assert.equal(last(request), null)
})

test('decoding finds the next frame wherever a capture begins', () => {
  const all = join(request, response, next, request)
  for (let cut = 1; cut < all.length; cut++) {
    const { pieces } = lab.readCapture(codec, [{ stream: 0, bytes: all.slice(cut) }])
    const sound = pieces.filter(({ fault }) => fault === null).length
    const begins = [0, request.length, request.length + response.length, request.length + response.length + next.length]
    assert.equal(sound, begins.filter((at) => at >= cut).length, `from byte ${cut}`)
  }
})

test('an unknown head is not explained as a request', () => {
  const [piece] = read([0x00, protocol.requestHead[0], 1, 2]).pieces
  const parts = lab.partsOf(protocol, piece.decoded)
  assert.equal(parts[0].en, 'Not a frame head')
  assert.ok(parts[0].fault)
  // The bytes after it are not explained as a header either.
  assert.deepEqual(parts.map(({ offset, size }) => [offset, size]), [[0, 2], [2, 2]])
  for (const [head, text] of [[request, 'Request'], [response, 'Response']]) {
    assert.equal(lab.partsOf(protocol, lab.decodeFrame(codec, head))[0].en, text)
  }
})

test('responses match requests by kind, code and id in any order', () => {
  const partners = (...parts) => read(...parts).pieces.map(({ partner }) => partner)
  assert.deepEqual(partners(request, next, response), [2, null, 0])
  assert.deepEqual(partners(response, request), [1, 0])
  assert.deepEqual(partners(request, frame('response', 9)), [null, null])
  assert.deepEqual(partners(request, frame('response', 7, { of: report })), [null, null])
  // Two calls with one id: each response belongs to the nearest request before it.
  assert.deepEqual(partners(request, response, request, response), [1, 0, 3, 2])
})

test('a report sent again is told from a first one', () => {
  const first = frame('request', 3, { of: report })
  const { pieces } = read(first, first, frame('response', 3, { of: report }))
  assert.deepEqual(pieces.map(({ repeats }) => repeats), [null, 0, null])
})

test('two streams are decoded apart and listed in pasted order', () => {
  const capture = lab.readCapture(codec, [
    { stream: 0, bytes: request },
    { stream: 1, bytes: response.slice(0, 40) },
    { stream: 0, bytes: next },
    { stream: 1, bytes: response.slice(40) },
  ])
  assert.equal(capture.level, 'good')
  assert.deepEqual(capture.pieces.map(({ stream, at }) => [stream, at]), [[0, 0], [1, 0], [0, request.length]])
  assert.deepEqual(capture.pieces.map(({ partner }) => partner), [1, 0, null])
})

test('comments are taken out of JSON, and nothing else', () => {
  assert.equal(lab.withoutComments('{"a": "http://x" /* y */, // z\n"b": 1}'), '{"a": "http://x",\n"b": 1}')
  assert.equal(lab.withoutComments('{"a": "// no"}'), null)
})

test('the state survives an address, and a foreign address has none', () => {
  const state = { paste: 'FC AA\n中', operation: operation.name, side: 'response', id: 9, gzip: true, json: null }
  assert.deepEqual(lab.fromHash('#' + lab.toHash(state)), state)
  // An empty box for the id gives no number. The other parts stay.
  assert.deepEqual(lab.fromHash(lab.toHash({ ...state, id: '' })), { ...state, id: 1 })
  assert.match(lab.toHash(state), /^lab=[A-Za-z0-9_-]+$/)
  // A frame on another page links to the lab with its bytes.
  assert.equal(lab.fromHash('#hex=fcAA01')?.paste, 'FC AA 01')
  for (const other of ['#hex=', '#hex=f', '#hex=zz', '', '#decode', '#lab=', '#lab=!!', '#lab=AAAA', '#' + lab.toHash({ ...state, side: 'x' })]) {
    assert.equal(lab.fromHash(other), null, other)
  }
})
