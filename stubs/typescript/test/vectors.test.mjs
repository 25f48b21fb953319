// All golden vectors: frames to accept, frames to refuse with the error's name, and frames to encode again.

import assert from 'node:assert/strict'
import { test } from 'node:test'
import { decodeFrame, encodeFrame, headerValue, operationOf, readBody, sideOf } from 'fc-protocol/codec'
import { protocols } from './protocols.mjs'
import { bare, bytesOf, ofOneKey, vectors } from './support.mjs'

/** Returns the package's result for a frame: the decoded parts, and the first error. */
function judge(codec, bytes) {
  const { protocol } = codec
  const decoded = decodeFrame(codec, bytes)
  const number = (role) => headerValue(decoded, role)
  const kind = protocol.kinds.find(({ value }) => value === number('kind'))
  const side = sideOf(protocol, decoded)
  const operation = operationOf(protocol, number('code'), kind)
  const isBytes = kind?.role === 'stream' && !operation?.request
  const body = decoded.plain && !isBytes ? readBody(protocol, operation, side, decoded.plain) : null
  return { decoded, body, number, side, fault: decoded.fault ?? body?.faults[0]?.name ?? null }
}

let accepted = 0
let rejected = 0
let encoded = 0

test('vectors at the edges of JSON follow the rules', () => {
  const { accepted: good, rejected: bad } = vectors.find(({ file }) => file === 'bodies.json')
  for (const { name, type, bytes, error = null } of [...good, ...bad]) {
    const report = readBody(bare, ofOneKey(type), 'request', bytesOf(bytes))
    assert.equal(report.faults[0]?.name ?? null, error, name)
  }
  assert.ok(good.length > 50 && bad.length > 50)
})

for (const { name: of, codec, vectors } of protocols) {
  const { protocol } = codec

  test(`there are vectors of every operation of ${of}`, () => {
    const files = new Set(vectors.map(({ operation }) => operation))
    for (const { name } of protocol.operations) assert.ok(files.has(name), `no vectors of ${name}`)
    assert.ok(vectors.some(({ file }) => file === 'frames.json'))
  })

  for (const { file, operation: name, accepted: good = [], rejected: bad = [] } of vectors) {
    // They contain no frame, and have a separate test.
    if (file === 'bodies.json') continue
    test(`${of}: ${file}`, () => {
      const operation = protocol.operations.find((candidate) => candidate.name === name) ?? null
      for (const vector of good) {
        const where = `${file} ${vector.name}`
        accepted++
        if (vector.text !== undefined) {
          const report = readBody(protocol, operation, vector.direction, new TextEncoder().encode(vector.text))
          assert.deepEqual(report.faults, [], where)
          continue
        }
        const bytes = bytesOf(vector.frame)
        const { decoded, body: read, number, side, fault: found } = judge(codec, bytes)
        // Vectors without an operation test only frames: an empty data area is valid.
        const body = operation ? read : null
        for (const [role, value] of Object.entries(vector.header ?? {})) {
          if (typeof value === 'number' && number(role) !== null) assert.equal(number(role), value, `${where} ${role}`)
        }
        if (vector.data !== undefined) assert.equal(Buffer.from(decoded.plain).toString('hex'), vector.data, where)
        const fault = operation ? found : decoded.fault
        assert.equal(fault, null, `${where}: ${JSON.stringify(body?.faults)}`)
        if (body) {
          assert.equal(side, vector.direction, where)
          if (vector.body !== undefined) assert.deepEqual(JSON.parse(body.text), vector.body, where)
        }
        if ((number('encoding') ?? undefined) !== protocol.encodings.find(({ role }) => role === 'plain')?.value)
          continue
        // A quirk is an irregular frame that is accepted. Encoding it again gives a regular one.
        if (vector.name.startsWith('quirk')) continue
        // The same holds for a header field that is always sent with its fixed value.
        if (decoded.fields.some(({ field, value }) => field.role === 'status' && value !== field.value)) continue
        const again = encodeFrame(codec, {
          response: side === 'response',
          kind: number('kind'),
          code: number('code'),
          id: number('id'),
          gzip: false,
          data: decoded.plain,
        })
        assert.equal(Buffer.from(again).toString('hex'), vector.frame, where)
        encoded++
      }
      for (const vector of bad) {
        const where = `${file} ${vector.name}`
        rejected++
        if (vector.text !== undefined) {
          const report = readBody(protocol, operation, vector.direction, new TextEncoder().encode(vector.text))
          assert.equal(report.faults[0]?.name ?? null, vector.error, where)
          continue
        }
        const { fault, body } = judge(codec, bytesOf(vector.frame))
        assert.equal(fault, vector.error, `${where}: ${JSON.stringify(body?.faults)}`)
      }
    })
  }

  test(`every operation of ${of} makes a frame that it reads again, plain and packed`, () => {
    for (const operation of protocol.operations.filter(({ code }) => code !== null)) {
      for (const side of ['request', 'response']) {
        for (const gzip of [false, true]) {
          const text = side === 'request' ? operation.requestExample : operation.responseExample
          const frame = encodeFrame(codec, {
            response: side === 'response',
            kind: protocol.kinds.find(({ role }) => role === operation.kind).value,
            code: operation.code,
            id: 1,
            gzip,
            data: new TextEncoder().encode(text),
          })
          const { fault, body } = judge(codec, frame)
          assert.equal(fault, null, `${operation.name} ${side}: ${JSON.stringify(body?.faults)}`)
          if (body) assert.equal(body.text, text)
        }
      }
    }
  })
}

process.on('exit', () => {
  console.log(`# accepted ${accepted}, rejected ${rejected}, encoded byte for byte ${encoded}`)
})
