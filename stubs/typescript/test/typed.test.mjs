// Bodies at the edges of JSON through typed messages: read as the schema says, refused by name, and written again.

import assert from 'node:assert/strict'
import { test } from 'node:test'
import { BodyError, readMessage, writeMessage } from 'fc-protocol/runtime'
import { parseJson } from 'fc-protocol/codec'
import { schemasOf } from './schemas.mjs'
import { ONE_KEY, bytesOf, holds, ofOneKey, vectors } from './support.mjs'

const allowanceOf = ({ limits }) => ({ depth: limits.jsonDepth, values: 1 << 20 })

/** JSON with numbers by value: floats may be spelled otherwise, and so may escapes. */
function meaning(text, type) {
  const plain = (json) => {
    if (json.is === 'object') return ['{', ...json.entries.map(({ key, value }) => [key, plain(value)])]
    if (json.is === 'array') return json.items.map(plain)
    if (json.is === 'number') return type.startsWith('f') ? Number(json.text) : json.text
    return json.is === 'null' ? null : json.value
  }
  return plain(parseJson(text, 99))
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

test('bodies at the edges of JSON are read, refused and written as the rules say', () => {
  const { accepted, rejected } = vectors.find(({ file }) => file === 'bodies.json')
  for (const { name, type, bytes, written } of accepted) {
    const protocol = ofOneKey(type)
    const struct = schemasOf(protocol)[ONE_KEY.request]()
    const message = readMessage(struct, bytesOf(bytes), allowanceOf(protocol))
    assert.deepEqual(meaning(writeMessage(struct, message), type), meaning(written, type), name)
    holds('bodies')
  }
  for (const { name, type, bytes, error } of rejected) {
    const protocol = ofOneKey(type)
    const struct = schemasOf(protocol)[ONE_KEY.request]()
    assert.equal(
      kindOf(() => readMessage(struct, bytesOf(bytes), allowanceOf(protocol))),
      error,
      name,
    )
    holds('bodies')
  }
})
