// States, fields under a condition, and sensitive values.

import assert from 'node:assert/strict'
import { test } from 'node:test'
import { ConditionError, checked, isError, isFinal, isInOrder, mayFollow, redacted } from 'fc-protocol/runtime'
import { State } from './toy.mjs'

test('states are final, failures, or in order', () => {
  assert.deepEqual(
    [isFinal(State, 2), isFinal(State, 1), isError(State, 3), isError(State, 0)],
    [true, false, true, false],
  )
  const changes = [
    [0, 1],
    [1, 2],
    [0, 2],
    [1, 0],
    [2, 0],
    [9, 0],
    [0, 9],
  ]
  assert.deepEqual(
    changes.map(([from, to]) => mayFollow(State, from, to)),
    [true, true, false, false, false, true, true],
  )
  assert.deepEqual([isInOrder(State, 1, 1), isInOrder(State, 2, 3), isInOrder(State, 1, 0)], [true, true, false])
  const normal = { ...State, process: { ...State.process, order: 'normal' } }
  assert.deepEqual([mayFollow(normal, 9, 0), isInOrder(normal, 9, 0), isInOrder(normal, 0, 9)], [false, true, true])
  assert.deepEqual([isInOrder(normal, 0, 2), isInOrder(normal, 2, 0), isInOrder(normal, 3, 0)], [false, false, true])
  assert.equal(isInOrder({ ...State, process: undefined }, 2, 0), true)
})

const Inner = {
  is: 'struct',
  name: 'Inner',
  fields: {
    on: { key: 'isOn', type: 'bool', optional: true, default: true },
    why: { key: 'why', type: 'string', optional: true, unless: { on: [true] } },
  },
}
const Outer = {
  is: 'struct',
  name: 'Outer',
  fields: {
    mode: { key: 'mode', type: 'u8' },
    speed: { key: 'speed', type: 'f64', optional: true, when: { mode: [4, 5] } },
    parts: { key: 'parts', type: { list: () => Inner } },
    password: { key: 'password', type: 'string', sensitive: true },
  },
}
const outer = (more) => ({ mode: 4, speed: 1, parts: [], password: 'secret', ...more })

test('a field is there exactly where its condition holds', () => {
  assert.equal(checked(Outer, outer()).mode, 4)
  const fault = (message) => {
    try {
      checked(Outer, message)
    } catch (error) {
      assert.ok(error instanceof ConditionError)
      return [error.path, error.kind, error.message]
    }
    return null
  }
  assert.deepEqual(fault(outer({ speed: undefined })), [
    'speed',
    'missing',
    '`speed` is missing: it is sent when `mode` is 4 or 5',
  ])
  assert.deepEqual(fault(outer({ mode: 1 })), [
    'speed',
    'unasked',
    '`speed` is not asked for: it is sent only when `mode` is 4 or 5',
  ])
  assert.equal(fault(outer({ parts: [{}, { on: false, why: 'x' }] })), null)
  assert.deepEqual(fault(outer({ parts: [{}, { why: 'x' }] }))?.slice(0, 2), ['parts[1].why', 'unasked'])
  assert.deepEqual(fault(outer({ parts: [{ on: false }] }))?.slice(0, 2), ['parts[0].why', 'missing'])
})

test('sensitive values are left out of texts', () => {
  const message = outer({ parts: [{ on: true }] })
  assert.deepEqual(redacted(Outer, message), { mode: 4, speed: 1, parts: [{ on: true }], password: '***' })
  assert.equal(message.password, 'secret')
})
