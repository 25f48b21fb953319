// JSON beyond the vectors: exact numbers, and white space.

import assert from 'node:assert/strict'
import { test } from 'node:test'
import { compact, integral } from 'fc-protocol/codec'

test('white space is removed, and invalid JSON stays as typed', () => {
  assert.equal(compact('{ "a b" : 12345678901234567890 }', 9), '{"a b":12345678901234567890}')
  assert.equal(compact('{ "a" : }', 9), '{ "a" : }')
  assert.equal(compact('[\n\t" \\" " ,\r\n"\\\\" , " "]', 9), '[" \\" ","\\\\"," "]')
})

test('integers are exact, in whatever form', () => {
  for (const [text, exact] of [
    ['0', 0n],
    ['-0', 0n],
    ['9007199254740993', 9007199254740993n],
    ['1.0', 1n],
    ['1e2', 100n],
    ['1.5e1', 15n],
    ['-120e-1', -12n],
    ['0.5', null],
    ['1e-1', null],
    ['', null],
    ['x', null],
  ]) {
    assert.equal(integral(text), exact, text)
  }
  // A huge exponent is not computed digit by digit.
  assert.ok(integral('1e999999999') > 2n ** 64n)
})
