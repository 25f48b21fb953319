// The names of errors: one list, the same as everywhere else.

import assert from 'node:assert/strict'
import { test } from 'node:test'
import { errorText } from 'fc-protocol'
import { vectors } from './support.mjs'

test('every name of the vectors has a meaning in both languages', () => {
  const names = new Set(vectors.flatMap(({ rejected }) => rejected.map(({ error }) => error)))
  assert.ok(names.size > 20)
  for (const name of names) {
    const { zh = '', en = '' } = errorText[name] ?? {}
    assert.ok(zh && en, name)
  }
})
