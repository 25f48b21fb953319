// JSON beyond the vectors: places, exact numbers, and white space.

import assert from 'node:assert/strict'
import { test } from 'node:test'
import { JsonFault, compact, integral, parseJson } from 'fc-protocol/codec'

test('white space goes, and what is not JSON stays as it was typed', () => {
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
  // Not computed digit by digit, however great.
  assert.ok(integral('1e999999999') > 2n ** 64n)
})

test('a fault says at which character', () => {
  for (const [text, fault, at] of [
    ['', 'bad_json', 0],
    ['{"a":}', 'bad_json', 5],
    ['[1,]', 'bad_json', 3],
    ['01', 'bad_json', 1],
    ['"\u0001"', 'bad_json', 1],
    ['{} x', 'bad_json', 3],
    ['"\\x"', 'bad_json', 3],
    ['NaN', 'bad_json', 0],
    ['[[[1]]]', 'too_deep', 2],
  ]) {
    assert.throws(
      () => parseJson(text, 2),
      (problem) => problem instanceof JsonFault && problem.fault === fault && problem.at === at,
      text,
    )
  }
})
