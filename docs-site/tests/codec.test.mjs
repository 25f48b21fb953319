// MD5 and gzip of the frame lab. The package's own tests cover all golden frames. These tests repeat those about frames
// with the libraries of the site.

import assert from 'node:assert/strict'
import { test } from 'node:test'
import { gzipSync } from 'node:zlib'
import { engine, vectors } from './support.mjs'

const { codec, decodeFrame } = await engine()
const bytesOf = (hex) => Uint8Array.from(Buffer.from(hex, 'hex'))

test('frames are taken and refused as the vectors say', () => {
  const { accepted, rejected } = vectors.find(({ file }) => file === 'frames.json')
  assert.ok(accepted.length > 0 && rejected.length > 0)
  for (const { name, frame, error = null } of [...accepted, ...rejected]) {
    assert.equal(decodeFrame(codec, bytesOf(frame)).fault, error, name)
  }
})

test('packed data unpacks up to the limit', () => {
  const { gzip, gunzip } = codec.algorithms
  const large = Uint8Array.from({ length: 100_000 }, (_, at) => at * at)
  assert.deepEqual(gunzip(gzip(large), large.length), large)
  assert.equal(gunzip(gzip(large), large.length - 1), 'inflated_too_long')
  assert.deepEqual(gunzip(gzipSync(large), large.length), large)
  assert.equal(gunzip(gzip(large).subarray(0, -9), large.length), 'bad_gzip')
  assert.equal(gunzip(large, large.length), 'bad_gzip')
})
