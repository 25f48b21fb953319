// The protocol of the package and other protocols: the generated modules of each, and its golden vectors.

import assert from 'node:assert/strict'
import { cpSync } from 'node:fs'
import path from 'node:path'
import { nodeAlgorithms } from 'fc-protocol/node'
import { compile, emptyFolder, load, repository } from './packages.mjs'
import { root, vectors, vectorsIn } from './support.mjs'

/** Returns a protocol; `from` imports one of its compiled modules. */
async function protocolOf(name, vectors, from) {
  const { protocol } = await from('generated/protocol.js')
  return {
    name,
    vectors,
    codec: { protocol, algorithms: nodeAlgorithms },
    runtime: await from('src/runtime.js'),
    generated: await from('generated/index.js'),
    wire: await from('generated/wire.js'),
  }
}

function other(name) {
  const source = path.join(repository, 'fc-generated/tests', name)
  // Test files run at the same time.
  const folder = emptyFolder(`${name}-${process.pid}`)
  cpSync(path.join(source, 'generated'), path.join(folder, 'generated'), { recursive: true })
  assert.equal(compile(folder), '')
  return protocolOf(name, vectorsIn(path.join(source, 'vectors')), (file) => load(folder, file))
}

/** All protocols. */
export const protocols = [
  await protocolOf('the spec', vectors, (file) => import(path.join(root, 'dist', file))),
  await other('meter'),
  await other('beacon'),
]
