// Shared by several tests: the package with the algorithms of Node.js, and the golden vectors.

import assert from 'node:assert/strict'
import { appendFileSync, readdirSync, readFileSync } from 'node:fs'
import { fileURLToPath } from 'node:url'
import path from 'node:path'
import { protocol } from 'fc-protocol/codec'
import { nodeAlgorithms } from 'fc-protocol/node'
import { Framing } from 'fc-protocol/runtime'

/** Folder of the package. */
export const root = fileURLToPath(new URL('..', import.meta.url))

export const codec = { protocol, algorithms: nodeAlgorithms }

const held = new Map()

/**
 * Counts a passed case of a kind in `conformance/README.md`. At its end, a test file appends a line `KIND NUMBER` to
 * the file that `FC_CONFORMANCE` names.
 */
export const holds = (kind) => held.set(kind, (held.get(kind) ?? 0) + 1)

process.on('exit', () => {
  const { FC_CONFORMANCE: file } = process.env
  if (file) appendFileSync(file, [...held].map(([kind, number]) => `${kind} ${number}\n`).join(''))
})

/** Returns a framing for a codec's protocol that accepts any compression ratio. */
export function framingOf({ protocol, algorithms }, resync = false) {
  const { frameBytes, inflatedBytes } = protocol.limits
  return new Framing(protocol, { frameBytes, inflatedBytes }, algorithms, true, resync)
}

/** Returns the files of vectors in a folder: `{ file, operation, code, accepted, rejected }`. */
export const vectorsIn = (folder) =>
  readdirSync(folder)
    .filter((name) => name.endsWith('.json'))
    .sort()
    .map((name) => ({ file: name, ...JSON.parse(readFileSync(path.join(folder, name), 'utf8')) }))

/** All vector files of the package's protocol. */
export const vectors = vectorsIn(path.join(root, '../../fc-generated/vectors'))

export const bytesOf = (hex) => Uint8Array.from(Buffer.from(hex, 'hex'))

const nothing = { is: 'struct', name: 'Nothing', fields: {} }

/** A protocol whose messages have no envelope. */
export const bare = { ...protocol, envelope: { request: { struct: nothing }, response: { struct: nothing } } }

/** The type `object` of `bodies.json`. */
const inner = () => ({ is: 'struct', name: 'Inner', fields: { value: { key: 'value', type: 'i32', optional: true } } })

/** Returns an operation whose request has one optional key of a type, for `bodies.json`. */
export function ofOneKey(name, details = {}) {
  const type = name === 'object' ? inner : String(name).startsWith('timestamp') ? 'i64' : name
  const value = { key: 'value', type, optional: true, ...details }
  return { request: { is: 'struct', name: 'Outer', fields: { value } }, response: null }
}

/**
 * Asserts the output of samples. They print each request and response of the commands, each acknowledgement and receipt
 * of the reports, and the sending of the streams. The frames may or may not arrive before the app leaves.
 */
export async function assertSampled(context, run, commands, reports, streams) {
  const { mock } = context.mock.method(console, 'log', () => {})
  await run()
  const lines = mock.calls.map(({ arguments: line }) => line)
  mock.restore()
  assert.equal(lines.filter(([, word]) => word === 'asks:').length, commands)
  assert.equal(lines.filter(([first]) => first.outcome === 'acknowledged').length, reports)
  assert.equal(lines.filter(([first]) => first === '1 data connections took it').length, streams)
  const frames = lines.filter(([first]) => typeof first === 'number')
  assert.equal(lines.length - frames.length, 2 * (commands + reports) + streams)
}
