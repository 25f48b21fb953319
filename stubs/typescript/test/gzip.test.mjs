// Invalid gzip members in frames that are otherwise valid.

import assert from 'node:assert/strict'
import { test } from 'node:test'
import { gzipSync } from 'node:zlib'
import { decodeFrame, encodeFrame, kindOf, protocol } from 'fc-protocol/codec'
import { nodeAlgorithms } from 'fc-protocol/node'
import { Framing } from 'fc-protocol/runtime'
import { webAlgorithms } from 'fc-protocol/web'

const operation = protocol.operations.find(({ kind, code }) => kind === 'command' && code !== null)
const text = Buffer.from(operation.requestExample)

/** Returns the error of a frame with this member as data. Its header has the length of the plain text. */
function fault(member, plain = text, algorithms = nodeAlgorithms, limits = protocol.limits) {
  const kind = kindOf(protocol, operation).value
  const parts = { response: false, kind, code: operation.code, id: 1, gzip: true, data: plain }
  const frame = encodeFrame({ protocol, algorithms: { ...nodeAlgorithms, gzip: () => member } }, parts)
  return decodeFrame({ protocol: { ...protocol, limits }, algorithms }, frame).fault
}

const member = gzipSync(text)
const changed = (at) =>
  Uint8Array.from(member, (byte, index) => (index === (at + member.length) % member.length ? byte ^ 1 : byte))

/** Data with a valid trailer that is not a single member. */
const several = (member) => [
  ['an empty member before it', Buffer.concat([gzipSync(''), member])],
  ['two empty members before it', Buffer.concat([gzipSync(''), gzipSync(''), member])],
  [
    'an empty member with its trailer behind it',
    Buffer.concat([member, gzipSync('').subarray(0, -8), member.subarray(-8)]),
  ],
  ['zeros and its trailer behind it', Buffer.concat([member, Buffer.alloc(100), member.subarray(-8)])],
  ['a zero and its trailer behind it', Buffer.concat([member, Buffer.of(0), member.subarray(-8)])],
  ['its trailer behind it', Buffer.concat([member, member.subarray(-8)])],
]

/** A member with all optional fields of its header. */
const decorated = (member) =>
  Buffer.concat([
    Buffer.of(0x1f, 0x8b, 8, 0b0001_1110, 0, 0, 0, 0, 0, 3),
    Buffer.from([3, 0, 1, 2, 3]),
    Buffer.from('name\0comment\0'),
    Buffer.of(0, 0),
    member.subarray(10),
  ])

for (const [platform, algorithms] of Object.entries({ node: nodeAlgorithms, web: webAlgorithms })) {
  test(`${platform}_refuses_whatever_is_not_one_member`, async () => {
    const plain = new TextEncoder().encode('{"text":"one"}'.repeat(100))
    const member = gzipSync(plain)
    const framing = new Framing(protocol, protocol.limits, algorithms)
    const open = (bytes) => {
      const packer = new Framing(protocol, protocol.limits, { ...nodeAlgorithms, gzip: () => bytes })
      const kind = kindOf(protocol, operation).value
      return framing.open(packer.encode({ response: false, kind, code: operation.code, id: 1 }, plain, 0))
    }
    for (const bytes of [member, decorated(member)]) {
      assert.deepEqual(new Uint8Array(await algorithms.gunzip(bytes, plain.length)), plain)
      assert.equal(await algorithms.gunzip(bytes, plain.length - 1), 'inflated_too_long')
      assert.equal((await open(bytes)).fault, null)
    }
    const reserved = Uint8Array.from(member, (byte, at) => (at === 3 ? 0x20 : byte))
    for (const [name, bytes] of [...several(member), ['a reserved flag', reserved]]) {
      assert.equal(await algorithms.gunzip(bytes, plain.length), 'bad_gzip', name)
      assert.equal((await open(bytes)).fault, 'bad_gzip', name)
    }
  })
}

test('exactly one whole gzip member is accepted', () => {
  assert.equal(fault(member), null)
  for (const [name, bytes] of [
    ...several(member),
    ['no member', new Uint8Array()],
    ['plain text', text],
    ['cut off', member.subarray(0, -1)],
    ['only its header', member.subarray(0, 10)],
    ['another checksum', changed(-8)],
    ['another length', changed(-1)],
    ['a byte behind it', Buffer.concat([member, Buffer.of(0)])],
    ['text behind it', Buffer.concat([member, text])],
    ['a second member', Buffer.concat([member, member])],
  ]) {
    assert.equal(fault(bytes), 'bad_gzip', name)
  }
})

test('more than the limit is not unpacked', () => {
  const large = Buffer.alloc(1001)
  const limits = { ...protocol.limits, inflatedBytes: 1000 }
  assert.equal(fault(gzipSync(large), large.subarray(0, 1000), nodeAlgorithms, limits), 'plain_length_mismatch')
  assert.equal(fault(gzipSync(large), large, nodeAlgorithms, limits), 'inflated_too_long')
  assert.equal(fault(gzipSync(large.subarray(0, 1000)), large.subarray(0, 1000), nodeAlgorithms, limits), null)
})

test('another length than the header says is refused', () => {
  assert.equal(fault(member, text.subarray(1)), 'plain_length_mismatch')
})

test('algorithms that look at nothing are looked after', () => {
  const careless = { ...nodeAlgorithms, gunzip: () => text }
  assert.equal(fault(member, text, careless), null)
  assert.equal(fault(changed(-8), text, careless), 'bad_gzip')
  assert.equal(fault(changed(-1), text, careless), 'bad_gzip')
  const empty = { ...nodeAlgorithms, gunzip: () => new Uint8Array() }
  assert.equal(fault(new Uint8Array(8), new Uint8Array(), empty), 'bad_gzip')
  const limits = { ...protocol.limits, inflatedBytes: text.length - 1 }
  assert.equal(fault(member, text.subarray(1), careless, limits), 'plain_length_mismatch')
})
