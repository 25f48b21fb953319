// What several tests share: the package with the algorithms of Node.js, and the golden vectors.

import { readdirSync, readFileSync } from 'node:fs'
import { fileURLToPath } from 'node:url'
import path from 'node:path'
import { protocol } from 'fc-protocol'
import { nodeAlgorithms } from 'fc-protocol/node'

/** The package. */
export const root = fileURLToPath(new URL('..', import.meta.url))

export const codec = { protocol, algorithms: nodeAlgorithms }

const folder = path.join(root, '../../fc-generated/vectors')

/** Every vector file: `{ file, operation, code, accepted, rejected }`. */
export const vectors = readdirSync(folder)
  .filter((name) => name.endsWith('.json'))
  .sort()
  .map((name) => ({ file: name, ...JSON.parse(readFileSync(path.join(folder, name), 'utf8')) }))

export const bytesOf = (hex) => Uint8Array.from(Buffer.from(hex, 'hex'))

/** The only operation of the protocols of `ofOneKey`. */
export const ONE_KEY = { request: 'Outer', response: null }

/** A protocol whose only message has one optional key of a type, as `bodies.json` asks for. */
export function ofOneKey(name, constraints = {}) {
  const is = name.startsWith('timestamp') ? 'i64' : name
  const field = (type) => ({
    key: 'value', also: [], type, optional: true, unit: null, min: null, max: null, length: null, pattern: null,
    wireString: false, emptyIsAbsent: false, lenientNumber: false, lenientBool: false, ...constraints,
  })
  const types = {
    Outer: { is: 'struct', fields: [field(name === 'object' ? { is: 'named', name: 'Inner' } : { is })] },
    Inner: { is: 'struct', fields: [field({ is: 'i32' })] },
  }
  return { ...protocol, envelope: { request: [], response: [] }, types }
}
