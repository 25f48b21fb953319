// The golden vectors through the generated types, for the package's protocol and for others. Each message is decoded
// with its schema and encoded again, or refused with the error's name.

import assert from 'node:assert/strict'
import { test } from 'node:test'
import { decodeFrame } from 'fc-protocol/codec'
import { protocols } from './protocols.mjs'
import { bytesOf, holds } from './support.mjs'

/** `JSON.parse` rounds numbers, so both sides of a comparison go through it. */
const rounded = (text) => JSON.parse(text)

for (const { name: of, codec, vectors, runtime, generated, wire } of protocols) {
  const { BodyError, bytesOf: bytesOfText, readEnveloped, writeEnveloped } = runtime
  const { commands, reports, streams } = generated
  const { limits } = wire.wire.defaults
  const allowance = { depth: limits.jsonDepth, values: limits.jsonValues }
  const nothing = { is: 'struct', name: 'Nothing', fields: {} }
  const envelopeOf = (operation, direction) =>
    operation.kind === 'stream' ? nothing : wire.wire.envelope[direction].struct

  const kindOf = (read) => {
    try {
      read()
    } catch (problem) {
      if (!(problem instanceof BodyError)) throw problem
      return problem.kind
    }
    return null
  }

  let count = 0
  for (const { file, operation: name, accepted, rejected } of vectors) {
    const operation = codec.protocol.operations.find((candidate) => candidate.name === name)
    if (!operation) continue
    test(`${of}: typed messages of ${file}`, () => {
      const judge = (vector) => {
        const where = `${file} ${vector.name}`
        const own = operation[vector.direction]
        const struct = own ?? nothing
        const envelope = envelopeOf(operation, vector.direction)
        let data = bytesOfText(vector.text ?? '')
        if (vector.frame !== undefined) {
          const decoded = decodeFrame(codec, bytesOf(vector.frame))
          if (decoded.fault) return assert.equal(decoded.fault, vector.error, where)
          data = decoded.plain
        }
        if (operation.kind === 'stream' && !own)
          return assert.equal(Buffer.from(data).toString('hex'), vector.data, where)
        count++
        if (vector.error)
          return assert.equal(
            kindOf(() => readEnveloped(envelope, struct, data, allowance)),
            vector.error,
            where,
          )
        const read = readEnveloped(envelope, struct, data, allowance)
        const written = writeEnveloped(envelope, read.envelope, struct, read.message)
        const text = Buffer.from(data).toString()
        assert.deepEqual(rounded(written), vector.canonical ?? vector.body ?? rounded(text), where)
        // Regular vectors give the same bytes.
        if (vector.case === 'plain' && !/\.0[,}\]]|[eE][+-]?[0-9]/.test(text)) assert.equal(written, text, where)
      }
      for (const [kind, list] of Object.entries({ accepted, rejected })) {
        for (const vector of list) {
          judge(vector)
          if (of === 'the spec') holds(kind)
        }
      }
    })
  }

  test(`${of}: the examples are what the data of the spec has`, () => {
    const example = (struct, direction, operation, message) => {
      const text = direction === 'request' ? operation.requestExample : operation.responseExample
      const { envelope } = readEnveloped(envelopeOf(operation, direction), nothing, bytesOfText(text), allowance)
      assert.deepEqual(
        rounded(writeEnveloped(envelopeOf(operation, direction), envelope, struct, message)),
        rounded(text),
        operation.name,
      )
    }
    const operations = codec.protocol.operations.filter(({ code }) => code !== null)
    const find = (all, name) => Object.values(all).find((candidate) => candidate.name === name)
    for (const operation of operations) {
      const found = find({ command: commands, report: reports, stream: streams }[operation.kind], operation.name)
      assert.equal(found?.code, operation.code, operation.name)
      if (operation.kind === 'command') {
        example(found.request, 'request', operation, found.requestExample())
        example(found.response, 'response', operation, found.responseExample())
      } else if (operation.kind === 'report') example(found.body, 'request', operation, found.example())
    }
    const all = [commands, reports, streams].flatMap((each) => Object.values(each))
    assert.equal(all.length, operations.length)
  })

  test(`${of}: what is generated of the frame is what the data has`, () => {
    const { frame } = wire.wire
    const { header, kinds, encodings, byteOrder, headerLength, requestHead, responseHead } = codec.protocol
    const bare = ({ offset, size, type, role, algorithm, value, zeroWhenPlain }) => ({
      offset,
      size,
      type,
      role,
      algorithm,
      value,
      zeroWhenPlain,
    })
    const numbered = ({ value, role }) => ({ value, role })
    assert.deepEqual(frame, {
      byteOrder,
      headerLength,
      requestHead,
      responseHead,
      header: header.map(bare),
      kinds: kinds.map(numbered),
      encodings: encodings.map(numbered),
    })
  })

  test(`${of}: vectors were read`, () => assert.ok(count > 20, `${count}`))
}

test('absent fields have their defaults', () => {
  const { defaults, withDefaults } = protocols.find(({ name }) => name === 'meter').generated
  const request = { band: 1, price: 7, note: undefined }
  const filled = withDefaults(request, defaults.SetTariffRequest)
  // biome-ignore lint/suspicious/noThenProperty: the meter has a field of this name
  const expected = { price: 7, note: '无', then: 2, keep: true, until: 2, tariff: 7, by: 'nobody', band: 1 }
  assert.deepEqual(filled, expected)
  assert.deepEqual(request, { band: 1, price: 7, note: undefined })
})
