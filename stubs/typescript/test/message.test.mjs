// Messages as frames, and look-ups in a protocol.

import assert from 'node:assert/strict'
import { test } from 'node:test'
import {
  decodeFrame,
  fieldOf,
  headerValue,
  kindOf,
  messageFrame,
  operationOf,
  protocol,
  sideOf,
} from 'fc-protocol/codec'
import { codec } from './support.mjs'

const operation = protocol.operations.find(({ kind, code }) => kind === 'command' && code !== null)
const uncoded = { ...operation, code: null }

test('a decoded frame has the values it was encoded from', () => {
  for (const side of ['request', 'response']) {
    for (const [gzip, role] of [
      [false, 'plain'],
      [true, 'gzip'],
    ]) {
      const decoded = decodeFrame(codec, messageFrame(codec, operation, { side, id: 12, gzip }, '{ "a": 1 }'))
      assert.equal(decoded.fault, null)
      assert.equal(sideOf(protocol, decoded), side)
      assert.equal(headerValue(decoded, 'id'), 12)
      assert.equal(headerValue(decoded, 'code'), operation.code)
      assert.equal(headerValue(decoded, 'kind'), kindOf(protocol, operation).value)
      assert.equal(
        headerValue(decoded, 'encoding'),
        protocol.encodings.find((encoding) => encoding.role === role).value,
      )
      assert.equal(Buffer.from(decoded.plain).toString(), '{"a":1}')
    }
  }
})

test('an operation without a code has no frame', () => {
  assert.equal(messageFrame(codec, uncoded, { side: 'request', id: 1, gzip: false }, '{}'), null)
  assert.equal(operationOf({ ...protocol, operations: [uncoded] }, null), null)
  assert.equal(operationOf(protocol, operation.code), operation)
})

test('truncated headers have no numbers, half a head no side', () => {
  const decoded = decodeFrame(codec, Uint8Array.from(protocol.requestHead.slice(0, -1)))
  assert.equal(decoded.fault, 'truncated')
  assert.equal(headerValue(decoded, 'code'), null)
  assert.equal(sideOf(protocol, decoded), null)
})

test('a role without a field is an error of the protocol', () => {
  assert.throws(() => fieldOf({ ...protocol, header: [] }, 'id'), /no header field with role id/)
})
