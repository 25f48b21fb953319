// The names of errors: one list, the same as everywhere else.

import assert from 'node:assert/strict'
import { readFileSync } from 'node:fs'
import { test } from 'node:test'
import { errorText } from 'fc-protocol/codec'
import { CallError, callErrorText } from 'fc-protocol/runtime'
import { holds, vectors } from './support.mjs'

test('every name of the vectors has a meaning in both languages', () => {
  const names = new Set(vectors.flatMap(({ rejected }) => rejected.map(({ error }) => error)))
  assert.ok(names.size > 20)
  for (const name of names) {
    const { zh = '', en = '' } = errorText[name] ?? {}
    assert.ok(zh && en, name)
  }
})

test('the names and their meanings are those of the list that all implementations share', () => {
  const shared = JSON.parse(readFileSync(new URL('../../../conformance/errors.json', import.meta.url), 'utf8'))
  const own = shared.errors.filter(({ where, own_limit }) => where !== 'call' && !own_limit)
  assert.deepEqual(Object.fromEntries(own.map(({ name, zh, en }) => [name, { zh, en }])), errorText)
  for (const { where } of own) holds(`${where}_errors`)
})

test('the errors of calls have the names of the list, too', () => {
  const shared = JSON.parse(readFileSync(new URL('../../../conformance/errors.json', import.meta.url), 'utf8'))
  const calls = shared.errors.filter(({ where }) => where === 'call').map(({ name }) => name)
  assert.deepEqual(calls.sort(), Object.keys(callErrorText).sort())
  for (const kind of calls) {
    assert.ok(new CallError(kind).message.length > 10, kind)
    holds('call_errors')
  }
})
