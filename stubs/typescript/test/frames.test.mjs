// Streams split at any byte give the same frames and the same errors.

import assert from 'node:assert/strict'
import { test } from 'node:test'
import { FrameStream } from 'fc-protocol/runtime'
import { protocols } from './protocols.mjs'
import { bytesOf, codec, framingOf, holds, vectors } from './support.mjs'

/** Returns all frames and errors from the chunks. */
function all(codec, chunks) {
  const stream = new FrameStream(framingOf(codec))
  const out = []
  for (const chunk of chunks) {
    stream.push(chunk)
    for (let next = stream.next(); next; next = stream.next()) {
      out.push(next)
      if (next.fatal) return out
    }
  }
  const end = stream.end()
  if (end) out.push(end)
  return out
}

/** Splits bytes into chunks of a size. */
const split = (bytes, size) =>
  Array.from({ length: Math.ceil(bytes.length / size) }, (_, index) => bytes.slice(index * size, (index + 1) * size))

const FATAL = ['bad_head', 'short_frame', 'frame_too_long', 'truncated']

for (const { name: of, codec, vectors } of protocols) {
  test(`${of}: each frame of the vectors, split in any way, is what it is whole`, () => {
    const frames = vectors.find(({ file }) => file === 'frames.json')
    for (const { name, frame, error = null } of [...frames.accepted, ...frames.rejected]) {
      const bytes = bytesOf(frame)
      const [whole, ...others] = all(codec, [bytes])
      assert.equal(whole.fatal ?? whole.fault, error, name)
      assert.equal(whole.fatal !== undefined, FATAL.includes(error), name)
      assert.deepEqual(others, [], name)
      for (const size of [1, 2, 7, 34, 35, 36])
        assert.deepEqual(all(codec, split(bytes, size)), [whole], `${name} by ${size}`)
      if (of === 'the spec') holds('frames')
    }
  })
}

test('frames are read after an unreadable one', () => {
  const { accepted, rejected } = vectors.find(({ file }) => file === 'frames.json')
  const good = accepted.map(({ frame }) => bytesOf(frame))
  const bad = rejected.filter(({ error }) => !FATAL.includes(error)).map(({ frame }) => bytesOf(frame))
  assert.ok(good.length > 5 && bad.length > 3)
  const bytes = Uint8Array.from([...good, ...bad, ...good].flatMap((frame) => [...frame]))
  const wanted = [...good, ...bad, ...good].map((frame) => all(codec, [frame])[0])
  for (const size of [1, 13, 64, bytes.length]) assert.deepEqual(all(codec, split(bytes, size)), wanted, String(size))
})

test('a wrong head is found at once and drops the rest', () => {
  const stream = new FrameStream(framingOf(codec))
  stream.push(Uint8Array.of(0))
  assert.deepEqual(stream.next(), { fatal: 'bad_head' })
  stream.push(new Uint8Array(1000))
  assert.equal(stream.pending, 0)
  assert.deepEqual([stream.next(), stream.end()], [{ fatal: 'bad_head' }, { fatal: 'bad_head' }])
})

/** The first frame without an error, and a damaged copy of it. */
function pair() {
  const { accepted } = vectors.find(({ file }) => file === 'frames.json')
  const good = bytesOf(accepted[0].frame)
  const damaged = Uint8Array.from(good)
  damaged[damaged.length - 1] ^= 1
  return { good, damaged, wanted: all(codec, [good])[0] }
}

const concat = (...parts) => Uint8Array.from(parts.flatMap((part) => [...part]))

/** Returns what a stream with `resync` makes of the chunks, where opening a frame may take time. */
async function found(framing, chunks) {
  const stream = new FrameStream(framing)
  const out = []
  for (const chunk of chunks) {
    stream.push(chunk)
    for (let next = await stream.next(); next; next = await stream.next()) {
      out.push(next)
      if (next.fatal) return out
    }
  }
  assert.equal(stream.end(), null)
  return out
}

test('resync over garbage and damaged frames', async () => {
  const { good, damaged, wanted } = pair()
  const garbage = new TextEncoder().encode('garbage')
  const bytes = concat(garbage, damaged, good, good, garbage, good.subarray(0, 3), good)
  const soon = framingOf(codec, true)
  const open = soon.open.bind(soon)
  soon.open = (frame) => Promise.resolve(open(frame))
  for (const framing of [framingOf(codec, true), soon]) {
    for (const size of [1, 2, 13, bytes.length]) {
      assert.deepEqual(await found(framing, split(bytes, size)), [wanted, wanted, wanted], String(size))
    }
  }
})

test('longest search of resync', async () => {
  const { damaged } = pair()
  const framing = framingOf(codec, true)
  Object.defineProperty(framing, 'frameBytes', { value: damaged.length })
  const garbage = concat(Uint8Array.of(0), ...Array(5).fill(damaged))
  assert.deepEqual(await found(framing, [garbage]), [{ fatal: 'bad_head' }])
  assert.deepEqual(await found(framing, [garbage.subarray(0, 1 + 4 * damaged.length)]), [])
})
