// The golden vectors through typed messages: read as the schema says, refused by name, and written again.

import assert from 'node:assert/strict'
import { test } from 'node:test'
import {
  BodyError,
  bytesOf as bytesOfText,
  readEnveloped,
  readMessage,
  writeEnveloped,
  writeMessage,
} from 'fc-protocol/runtime'
import { decodeFrame, parseJson } from 'fc-protocol/codec'
import { schemasOf, structOf } from './schemas.mjs'
import { ONE_KEY, bytesOf, ofOneKey, protocols, vectors } from './support.mjs'

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
  }
  for (const { name, type, bytes, error } of rejected) {
    const protocol = ofOneKey(type)
    const struct = schemasOf(protocol)[ONE_KEY.request]()
    assert.equal(
      kindOf(() => readMessage(struct, bytesOf(bytes), allowanceOf(protocol))),
      error,
      name,
    )
  }
})

/** JSON as `JSON.parse` has it, whose rounding both sides of a comparison have. */
const rounded = (text) => JSON.parse(text)

for (const { name: of, codec, vectors } of protocols) {
  const { protocol } = codec
  const types = schemasOf(protocol)
  const allowance = allowanceOf(protocol)
  const empty = { is: 'struct', name: 'Empty', fields: {} }
  const envelopes = {
    request: structOf(types, protocol, 'RequestEnvelope', protocol.envelope.request),
    response: structOf(types, protocol, 'ResponseEnvelope', protocol.envelope.response),
  }

  for (const { file, operation: name, accepted, rejected } of vectors) {
    const operation = protocol.operations.find((candidate) => candidate.name === name)
    if (!operation) continue
    test(`${of}: typed messages of ${file}`, () => {
      for (const vector of [...accepted, ...rejected]) {
        const where = `${file} ${vector.name}`
        const own = operation[vector.direction]
        if (operation.kind === 'stream' && !own) continue
        const struct = own ? types[own]() : empty
        const envelope = operation.kind === 'stream' ? empty : envelopes[vector.direction]
        let data = bytesOfText(vector.text ?? '')
        if (vector.frame !== undefined) {
          const decoded = decodeFrame(codec, bytesOf(vector.frame))
          if (decoded.fault) continue
          data = decoded.plain
        }
        if (vector.error) {
          assert.equal(
            kindOf(() => readEnveloped(envelope, struct, data, allowance)),
            vector.error,
            where,
          )
          continue
        }
        const read = readEnveloped(envelope, struct, data, allowance)
        const written = writeEnveloped(envelope, read.envelope, struct, read.message)
        assert.deepEqual(
          rounded(written),
          vector.canonical ?? vector.body ?? rounded(Buffer.from(data).toString()),
          where,
        )
        // The same bytes, where everything is as it should be.
        if (vector.case === 'plain' && !/\.0[,}\]]|[eE][+-]?[0-9]/.test(Buffer.from(data).toString())) {
          assert.equal(written, Buffer.from(data).toString(), where)
        }
      }
    })
  }
}
