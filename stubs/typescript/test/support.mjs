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
