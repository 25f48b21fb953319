// The first error of a body with several, with its place, as in `conformance/faults.json`.

import assert from 'node:assert/strict'
import { readFileSync } from 'node:fs'
import path from 'node:path'
import { test } from 'node:test'
import { Fc } from 'fc-protocol'
import { protocol, readBody } from 'fc-protocol/codec'
import { BodyError, readEnveloped } from 'fc-protocol/runtime'
import { holds, root } from './support.mjs'

const { envelope, defaults } = Fc.wire
const allowance = { depth: defaults.limits.jsonDepth, values: defaults.limits.jsonValues }

const { faults } = JSON.parse(readFileSync(path.join(root, '../../conformance/faults.json'), 'utf8'))

test('the first of several faults is named', () => {
  assert.ok(faults.length > 10)
  for (const { name, operation, message, text, error, path: at } of faults) {
    const found = protocol.operations.find((one) => one.name === operation)
    const data = new TextEncoder().encode(text)
    const [first] = readBody(protocol, found, message, data).faults
    assert.equal(first?.name, error, name)
    if (at !== undefined) assert.equal(first.path, at, name)
    assert.throws(
      () => readEnveloped(envelope[message].struct, found[message], data, allowance),
      (problem) => {
        assert.ok(problem instanceof BodyError, name)
        assert.equal(problem.kind, error, name)
        if (at !== undefined) assert.equal(problem.path, at, name)
        return true
      },
      name,
    )
    holds('faults')
  }
})
