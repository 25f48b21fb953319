// Bodies beyond the vectors: lengths are those of what a text stands for.

import assert from 'node:assert/strict'
import { test } from 'node:test'
import { readBody } from 'fc-protocol'
import { ONE_KEY, ofOneKey } from './support.mjs'

/** type, value, its length; `null` if it has none because it is at fault. */
const CASES = [
  ['string', '', 0], ['string', 'ab', 2], ['string', '机器', 2], ['string', '🤖🤖', 2],
  ['base64', '', 0], ['base64', 'AA==', 1], ['base64', 'AAA=', 2], ['base64', 'AAAA', 3], ['base64', 'AAAAAA==', 4],
  ['base64', 'A', null], ['base64', 'AA', null], ['base64', 'AAA', null], ['base64', 'AAAAA', null], ['base64', 'AA=A', null],
  ['base64', '=', null], ['base64', '==', null], ['base64', 'A===', null], ['base64', '====', null], ['base64', 'AA-_', null],
]

for (const [type, value, length] of CASES) {
  test(`${type} '${value}'`, () => {
    const data = new TextEncoder().encode(JSON.stringify({ value }))
    const fault = (low, high) => readBody(ofOneKey(type, { length: [low, high] }), ONE_KEY, 'request', data).faults[0]?.name ?? null
    if (length === null) return assert.equal(fault(0, 9), 'bad_base64')
    assert.equal(fault(length, length), null)
    assert.equal(fault(length + 1, length + 1), 'bad_length')
    if (length > 0) assert.equal(fault(0, length - 1), 'bad_length')
  })
}
