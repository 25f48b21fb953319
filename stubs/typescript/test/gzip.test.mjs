// Gzip members that a peer should not send, in frames that are right in all else.

import assert from 'node:assert/strict'
import { test } from 'node:test'
import { gzipSync } from 'node:zlib'
import { decodeFrame, encodeFrame, kindOf, protocol } from 'fc-protocol/codec'
import { nodeAlgorithms } from 'fc-protocol/node'

const operation = protocol.operations.find(({ kind, code }) => kind === 'command' && code !== null)
const text = Buffer.from(operation.requestExample)

/** The verdict on a frame whose data is this member, and which says that the text is in it. */
function fault(member, plain = text, algorithms = nodeAlgorithms, limits = protocol.limits) {
  const kind = kindOf(protocol, operation).value
  const parts = { response: false, kind, code: operation.code, id: 1, gzip: true, data: plain }
  const frame = encodeFrame({ protocol, algorithms: { ...nodeAlgorithms, gzip: () => member } }, parts)
  return decodeFrame({ protocol: { ...protocol, limits }, algorithms }, frame).fault
}

const member = gzipSync(text)
const changed = (at) =>
  Uint8Array.from(member, (byte, index) => (index === (at + member.length) % member.length ? byte ^ 1 : byte))

test('a member is taken, and nothing but one whole member', () => {
  assert.equal(fault(member), null)
  for (const [name, bytes] of [
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
