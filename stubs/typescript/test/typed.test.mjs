// Bodies at the edges of JSON through typed messages: decoded with the schema and encoded again, or refused with the
// error's name.

import assert from 'node:assert/strict'
import { test } from 'node:test'
import * as main from 'fc-protocol'
import { BodyError, fromJson, readMessage, toJson } from 'fc-protocol/runtime'
import { bare, bytesOf, holds, ofOneKey, vectors } from './support.mjs'

const allowance = { depth: bare.limits.jsonDepth, values: 1 << 20 }

/** Returns the tokens of a JSON text, with strings and floats by value: their spelling may differ. */
function meaning(text, type) {
  const plain = (token) => {
    if (token.startsWith('"')) return JSON.parse(token)
    return type.startsWith('f') && /\d/.test(token) ? Number(token) : token
  }
  return text.match(/"(?:[^"\\]|\\.)*"|[-+.\w]+|[^\s"]/g).map(plain)
}

const kindOf = (read) => {
  try {
    read()
  } catch (problem) {
    if (!(problem instanceof BodyError)) throw problem
    return problem.kind
  }
  return null
}

test('bodies at the edges of JSON follow the rules', () => {
  const { accepted, rejected } = vectors.find(({ file }) => file === 'bodies.json')
  for (const { name, type, bytes, written } of accepted) {
    const struct = ofOneKey(type).request
    const message = readMessage(struct, bytesOf(bytes), allowance)
    assert.deepEqual(meaning(toJson(struct, message), type), meaning(written, type), name)
    holds('bodies')
  }
  for (const { name, type, bytes, error } of rejected) {
    const struct = ofOneKey(type).request
    assert.equal(
      kindOf(() => readMessage(struct, bytesOf(bytes), allowance)),
      error,
      name,
    )
    holds('bodies')
  }
})

test('message_becomes_json_and_comes_back', () => {
  const struct = ofOneKey('u64').request
  const text = '{"value":18446744073709551615,"new":1.0}'
  const message = fromJson(struct, text)
  assert.equal(message.value, 2n ** 64n - 1n)
  assert.equal(toJson(struct, message), text)
  for (const [json, kind] of [
    ['{"value":-1}', 'out_of_range'],
    ['{', 'bad_json'],
    [`{"value":1,"new":${'['.repeat(128)}`, 'too_deep'],
    [7, 'wrong_type'],
  ]) {
    assert.equal(
      kindOf(() => fromJson(struct, json)),
      kind,
      String(json),
    )
  }
  assert.equal(
    kindOf(() => toJson(struct, { value: -1n })),
    'out_of_range',
  )
  assert.deepEqual([main.toJson, main.fromJson], [toJson, fromJson])
})
