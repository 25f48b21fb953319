// Bytes, and the numbers in them.

import assert from 'node:assert/strict'
import { test } from 'node:test'
import { hex, hexNumber, readUint, writeUint } from 'fc-protocol/codec'

test('hex pads bytes to two digits and numbers to a width', () => {
  assert.equal(hex(Uint8Array.of(0, 10, 255)), '00 0A FF')
  assert.equal(hex(new Uint8Array()), '')
  assert.equal(hexNumber(0xa01, 4), '0x0A01')
  assert.equal(hexNumber(0x12345, 4), '0x12345')
})

test('integers are written and read in either order', () => {
  for (const [order, bytes] of [
    ['big', [0x01, 0x02, 0x03, 0xff]],
    ['little', [0xff, 0x03, 0x02, 0x01]],
  ]) {
    const target = new Uint8Array(4)
    writeUint(target, 0x010203ff, order)
    assert.deepEqual([...target], bytes, order)
    assert.equal(readUint(target, order), 0x010203ff, order)
  }
  const greatest = new Uint8Array(4).fill(255)
  assert.equal(readUint(greatest, 'big'), 2 ** 32 - 1)
})
