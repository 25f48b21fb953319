// The names of errors: one list, the same as everywhere else.

import assert from 'node:assert/strict'
import { readFileSync } from 'node:fs'
import { test } from 'node:test'
import { errorText } from 'fc-protocol/codec'
import { BodyError, CallError, callErrorText, DataError, Refusal } from 'fc-protocol/runtime'
import { holds, vectors } from './support.mjs'

test('every error of the vectors has a text in both languages', () => {
  const names = new Set(vectors.flatMap(({ rejected }) => rejected.map(({ error }) => error)))
  assert.ok(names.size > 20)
  for (const name of names) {
    const { zh = '', en = '' } = errorText[name] ?? {}
    assert.ok(zh && en, name)
  }
})

test('names and texts match the shared list', () => {
  const shared = JSON.parse(readFileSync(new URL('../../../conformance/errors.json', import.meta.url), 'utf8'))
  const own = shared.errors.filter(({ where, own_limit }) => where !== 'call' && !own_limit)
  assert.deepEqual(Object.fromEntries(own.map(({ name, zh, en }) => [name, { zh, en }])), errorText)
  for (const { where } of own) holds(`${where}_errors`)
})

test('an error has its cause', () => {
  const refusal = new Refusal(7, 'no')
  const body = new BodyError('missing_key', 'a number', 'a.b')
  for (const Of of [CallError, DataError]) {
    assert.equal(new Of('refused', { refusal }).cause, refusal)
    assert.equal(new Of('invalid_response', { body }).cause, body)
    assert.equal('cause' in new Of('lost', { loss: { is: 'closed_here' } }), false)
    assert.equal('cause' in new Of('closed'), false)
  }
})

test('errors of calls have names of the list', () => {
  const shared = JSON.parse(readFileSync(new URL('../../../conformance/errors.json', import.meta.url), 'utf8'))
  const calls = shared.errors.filter(({ where }) => where === 'call').map(({ name }) => name)
  assert.deepEqual(calls.sort(), Object.keys(callErrorText).sort())
  for (const kind of calls) {
    assert.ok(new CallError(kind).message.length > 10, kind)
    holds('call_errors')
  }
})
