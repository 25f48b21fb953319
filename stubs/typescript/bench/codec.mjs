// Frames to typed messages and back, compared with `JSON.parse` and `JSON.stringify` with MD5 over the same bytes.

import assert from 'node:assert/strict'
import { createHash, hash } from 'node:crypto'
import { readFileSync } from 'node:fs'
import { nodePlatform } from '../dist/src/node.js'
import { FrameStream, Framing } from '../dist/src/runtime.js'
import { Bodies } from '../dist/src/bodies.js'
import * as schemas from '../dist/generated/schemas.js'
import { wire } from '../dist/generated/wire.js'
import { measure } from './measure.mjs'

/** The messages: names of files in `bench/frames`, and their schemas. */
const MESSAGES = {
  small: schemas.GetStationResponse,
  medium: schemas.ListStationsResponse,
  long: schemas.ListStationsResponse,
}

const frameOf = (name) => readFileSync(new URL(`../../../bench/frames/${name}.bin`, import.meta.url))

/** The digest, one character per byte: the fastest way in Node.js. */
const md5 =
  typeof hash === 'function'
    ? (data) => hash('md5', data, 'latin1')
    : (data) => createHash('md5').update(data).digest('latin1')

/** Length of the header, and place of its digest. */
const header = wire.frame.headerLength
const { offset, size } = wire.frame.header.find(({ role }) => role === 'digest')

/** The least work of reading: check the digest and parse all of the JSON. */
function leastDecode(frame) {
  const body = frame.subarray(header)
  if (md5(body) !== frame.latin1Slice(offset, offset + size)) throw new Error('another digest')
  return JSON.parse(body.utf8Slice(0, body.length))
}

/** The least work of writing: make all of the JSON, and put its digest into a prepared header. */
function leastEncode(frame, message) {
  const text = JSON.stringify(message)
  const body = Buffer.from(text)
  const made = Buffer.allocUnsafe(header + body.length)
  frame.copy(made, 0, 0, header)
  body.copy(made, header)
  made.latin1Write(md5(body), offset)
  return made
}

/** Returns the cost of each message, in microseconds. */
export function codec(effort) {
  const limits = wire.defaults.limits
  const framing = new Framing(wire.frame, limits, nodePlatform.algorithms)
  return Object.entries(MESSAGES).map(([name, struct]) => {
    const frame = frameOf(name)
    const time = leastDecode(frame)[wire.envelope.response.struct.fields[wire.envelope.response.time].key]
    const bodies = new Bodies(wire, { ...nodePlatform.clock, wallTime: () => time }, limits)
    const stream = new FrameStream(framing)
    const open = (bytes) => {
      stream.push(bytes)
      return stream.next()
    }
    const decode = (bytes = frame) => bodies.readResponse(struct, open(bytes).data)
    const { id } = open(frame)
    const { message } = decode()
    const encode = () => framing.encode(id, bodies.writeResponse(wire.results.success, struct, message), null)
    const plain = leastDecode(frame)
    // Each side writes all that it reads. JavaScript has no `.0` after a whole number in a string.
    assert.deepEqual(decode(encode()).message, message)
    assert.ok(Math.abs(encode().length - frame.length) < frame.length / 100)
    assert.deepEqual(leastEncode(frame, plain), frame)
    let sink
    const found = measure(
      {
        'decode least': () => (sink = leastDecode(frame)),
        'decode fc': () => (sink = decode()),
        'encode least': () => (sink = leastEncode(frame, plain)),
        'encode fc': () => (sink = encode()),
      },
      effort,
    )
    assert.ok(sink)
    return {
      message: name,
      bytes: frame.length,
      decode: { least: found['decode least'], fc: found['decode fc'] },
      encode: { least: found['encode least'], fc: found['encode fc'] },
    }
  })
}
