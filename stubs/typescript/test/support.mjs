// What several tests share: the package with the algorithms of Node.js, and the golden vectors.

import { readdirSync, readFileSync } from 'node:fs'
import { fileURLToPath } from 'node:url'
import path from 'node:path'
import { protocol } from 'fc-protocol/codec'
import { nodeAlgorithms } from 'fc-protocol/node'
import { Framing } from 'fc-protocol/runtime'

/** The package. */
export const root = fileURLToPath(new URL('..', import.meta.url))

export const codec = { protocol, algorithms: nodeAlgorithms }

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

/** Another protocol and its vectors; what is generated is JSON behind the name of a constant. */
function other(name) {
  const folder = path.join(generated, 'tests', name)
  const module = readFileSync(path.join(folder, 'generated/protocol.ts'), 'utf8')
  const protocol = JSON.parse(module.slice(module.indexOf('Protocol = {') + 'Protocol = '.length))
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
