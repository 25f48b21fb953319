// What several tests share: the package with the algorithms of Node.js, and the golden vectors.

import assert from 'node:assert/strict'
import { appendFileSync, readdirSync, readFileSync } from 'node:fs'
import { fileURLToPath } from 'node:url'
import path from 'node:path'
import { protocol } from 'fc-protocol/codec'
import { nodeAlgorithms } from 'fc-protocol/node'
import { Framing } from 'fc-protocol/runtime'

/** The package. */
export const root = fileURLToPath(new URL('..', import.meta.url))

export const codec = { protocol, algorithms: nodeAlgorithms }

const held = new Map()

/**
 * A case of a kind of `conformance/README.md` has held. At its end a test file says how many: a line `KIND NUMBER` behind what is in
 * the file that `FC_CONFORMANCE` names, if it names one.
 */
export const holds = (kind) => held.set(kind, (held.get(kind) ?? 0) + 1)

process.on('exit', () => {
  const { FC_CONFORMANCE: file } = process.env
  if (file) appendFileSync(file, [...held].map(([kind, number]) => `${kind} ${number}\n`).join(''))
})

/** Frames of a codec's protocol. */
export const framingOf = ({ protocol, algorithms }) => new Framing(protocol, protocol.limits, algorithms)

const generated = path.join(root, '../../fc-generated')

const vectorsIn = (folder) =>
  readdirSync(folder)
    .filter((name) => name.endsWith('.json'))
    .sort()
    .map((name) => ({ file: name, ...JSON.parse(readFileSync(path.join(folder, name), 'utf8')) }))

/** Every vector file: `{ file, operation, code, accepted, rejected }`. */
export const vectors = vectorsIn(path.join(generated, 'vectors'))

/** A protocol as data, of which each group has its part in a file; what is generated is JSON behind names of constants. */
function protocolIn(folder) {
  const valueOf = (file, name) => {
    const module = readFileSync(path.join(folder, file), 'utf8')
    const [value] = module.slice(module.indexOf(`export const ${name}: `)).split('\n\n', 1)
    return value.slice(value.indexOf(' = ') + ' = '.length)
  }
  const [head] = valueOf('protocol.ts', 'protocol').split(',\n  "types": {', 1)
  const groups = readdirSync(path.join(folder, 'groups')).map((group) => `groups/${group}/protocol.ts`)
  const types = groups.map((file) => JSON.parse(valueOf(file, 'types')))
  const operations = groups.flatMap((file) => JSON.parse(valueOf(file, 'operations')))
  return { ...JSON.parse(`${head}}`), types: Object.assign({}, ...types), operations }
}

/** Another protocol and its vectors. */
function other(name) {
  const folder = path.join(generated, 'tests', name)
  const protocol = protocolIn(path.join(folder, 'generated'))
  return { name, codec: { protocol, algorithms: nodeAlgorithms }, vectors: vectorsIn(path.join(folder, 'vectors')) }
}

/** The package's own protocol, and those that share nothing with it. */
export const protocols = [{ name: 'the spec', codec, vectors }, other('meter'), other('beacon')]

export const bytesOf = (hex) => Uint8Array.from(Buffer.from(hex, 'hex'))

/** The only operation of the protocols of `ofOneKey`. */
export const ONE_KEY = { request: 'Outer', response: null }

/** A protocol whose only message has one optional key of a type, as `bodies.json` asks for. */
export function ofOneKey(name, constraints = {}) {
  const is = name.startsWith('timestamp') ? 'i64' : name
  const field = (type) => ({
    key: 'value',
    also: [],
    type,
    optional: true,
    unit: null,
    min: null,
    max: null,
    length: null,
    pattern: null,
    wireString: false,
    emptyIsAbsent: false,
    lenientNumber: false,
    lenientBool: false,
    ...constraints,
  })
  const types = {
    Outer: { is: 'struct', fields: [field(name === 'object' ? { is: 'named', name: 'Inner' } : { is })] },
    Inner: { is: 'struct', fields: [field({ is: 'i32' })] },
  }
  return { ...protocol, envelope: { request: [], response: [] }, types }
}

/**
 * That samples print each request and answer of so many commands, each acknowledgement and taking of so many reports, and the sending
 * of so many streams. Whether their frames arrive before the app leaves is open.
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
