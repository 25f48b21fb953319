// Patterns match as `conformance/patterns.json` specifies, in all languages.

import assert from 'node:assert/strict'
import { readFileSync } from 'node:fs'
import { test } from 'node:test'
import { broken } from '../dist/src/constraint.js'
import { planOf } from '../dist/src/plan.js'
import { holds } from './support.mjs'

test('texts match or are refused', () => {
  const table = JSON.parse(readFileSync(new URL('../../../conformance/patterns.json', import.meta.url), 'utf8'))
  for (const { pattern, portable, matches, refuses } of table.filter(({ refused }) => !refused)) {
    const [field] = planOf({ fields: { text: { key: 'text', type: 'string', pattern: portable } } }).fields
    for (const text of matches) assert.equal(broken(field, text), null, `${pattern} on ${JSON.stringify(text)}`)
    for (const text of refuses)
      assert.equal(broken(field, text)?.kind, 'bad_pattern', `${pattern} on ${JSON.stringify(text)}`)
    for (const _ of [...matches, ...refuses]) holds('patterns')
  }
})
