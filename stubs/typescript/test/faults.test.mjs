// Of several faults in one body, that of `conformance/faults.json` is named, with the place where it is.

import assert from 'node:assert/strict'
import { readFileSync } from 'node:fs'
import path from 'node:path'
import { test } from 'node:test'
import { commands, Fc, reports } from 'fc-protocol'
import { BodyError, readEnveloped } from 'fc-protocol/runtime'
import { holds, root } from './support.mjs'

const { envelope, defaults } = Fc.wire
const allowance = { depth: defaults.limits.jsonDepth, values: defaults.limits.jsonValues }

/** The schemas of an operation's messages. */
const messagesOf = (name) => {
  const command = Object.values(commands).find((one) => one.name === name)
  if (command) return { request: command.request, response: command.response }
  const report = Object.values(reports).find((one) => one.name === name)
  return { request: report.body, response: report.acknowledgement }
}

const { faults } = JSON.parse(readFileSync(path.join(root, '../../conformance/faults.json'), 'utf8'))

test('the first of several faults is named', () => {
  assert.ok(faults.length > 10)
  for (const { name, operation, message, text, error, path: at } of faults) {
    const struct = messagesOf(operation)[message]
    assert.throws(
      () => readEnveloped(envelope[message].struct, struct, new TextEncoder().encode(text), allowance),
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
