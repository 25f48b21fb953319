// Bodies of the greatest length, built to be expensive. Each gets its result, with work that grows only with its
// length.

import assert from 'node:assert/strict'
import { test } from 'node:test'
import { compact, protocol, readBody } from 'fc-protocol/codec'
import { bare, ofOneKey } from './support.mjs'

const SIZE = 16 * 1024 * 1024
const constrained = { length: [0, SIZE] }
const some = (text) => text.repeat(SIZE / text.length)

/** name, type, constraints, the value as JSON, the error. */
const CASES = [
  ['base64', 'base64', constrained, `"${some('AAAA')}"`, null],
  ['base64 with a slip at its end', 'base64', constrained, `"${some('AAAA')}AAA!"`, 'bad_base64'],
  ['a string', 'string', constrained, `"${some('a')}"`, null],
  ['a string of a pattern', 'string', { pattern: '(?:a|b)*' }, `"${some('ab')}"`, 'bad_pattern'],
  ['a string of escapes', 'string', constrained, `"${some('\\n')}"`, null],
  ['a string that is too long by one', 'string', constrained, `"${some('a')}a"`, 'bad_length'],
  ['zeros before a digit', 'i64', {}, `1${some('0')}1`, 'out_of_range'],
  ['zeros before a digit of a fraction', 'i64', {}, `1.${some('0')}1`, 'wrong_type'],
  ['a great exponent', 'i64', {}, `1e${some('9')}`, 'out_of_range'],
  ['white space', 'bool', {}, `${some(' ')}true`, null],
  ['brackets', 'json', {}, some('['), 'too_deep'],
  ['a string without an end', 'json', {}, `"${some('a')}`, 'bad_json'],
]

for (const [name, type, constraints, value, fault] of CASES) {
  test(name, () => {
    const text = `{"value":${value}}`
    const report = readBody(bare, ofOneKey(type, constraints), 'request', new TextEncoder().encode(text))
    assert.equal(report.faults[0]?.name ?? null, fault)
    const compacted = compact(text, protocol.limits.jsonDepth)
    // Text that is not JSON is unchanged. Only one of these values contains white space.
    assert.equal(compacted.length, name === 'white space' ? '{"value":true}'.length : text.length)
  })
}
