// The names of the values of an enum.

import assert from 'node:assert/strict'
import { test } from 'node:test'
import { isKnown, nameOf } from 'fc-protocol/runtime'
import { State } from './toy.mjs'

const schemas = [
  State,
  { is: 'enum', name: 'Id', repr: 'u64', values: { None: 0n, Last: 0xffff_ffff_ffff_ffffn } },
  { is: 'enum', name: 'Place', repr: 'string', values: { Top: 'top', Bottom: 'bottom' } },
]

test('each value has its name', () => {
  for (const schema of schemas) {
    for (const [name, value] of Object.entries(schema.values)) {
      assert.equal(nameOf(schema, value), name)
      assert.ok(isKnown(schema, value))
    }
  }
})

test('a value that the spec does not have has none', () => {
  const others = [[9, -1, 1.5, Number.NaN], [1n], ['Top', '', 'values']]
  for (const [index, schema] of schemas.entries()) {
    for (const value of others[index]) {
      assert.equal(nameOf(schema, value), null, String(value))
      assert.equal(isKnown(schema, value), false, String(value))
    }
  }
})
