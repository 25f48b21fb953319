// Decodes each frame, one in hex on a line, and prints the result as a list in JSON on a line. A test compares these
// lists between languages; `fc-reflect/tests/it/judges.rs` describes them.

import { createInterface } from 'node:readline'
import { commands, reports } from 'fc-protocol'
import { nodePlatform } from 'fc-protocol/node'
import { BodyError, FrameStream, Framing, readEnveloped, writeEnveloped } from 'fc-protocol/runtime'
import { wire } from '../dist/generated/wire.js'

const { limits } = wire.defaults
const allowance = { depth: limits.jsonDepth, values: limits.jsonValues }
const framing = new Framing(wire.frame, limits, nodePlatform.algorithms)
const nothing = { is: 'struct', name: 'Nothing', fields: {} }
const kinds = { command: framing.kind('command'), report: framing.kind('report'), stream: framing.kind('stream') }

/** The structs of frames, where known. */
const known = new Map()
const key = ({ response, kind, code }) => `${kind} ${code} ${response}`
for (const { code, request, response } of Object.values(commands)) {
  known.set(key({ response: false, kind: kinds.command, code }), request)
  known.set(key({ response: true, kind: kinds.command, code }), response)
}
for (const { code, body, acknowledgement } of Object.values(reports)) {
  known.set(key({ response: false, kind: kinds.report, code }), body)
  known.set(key({ response: true, kind: kinds.report, code }), acknowledgement)
}

function verdict(bytes) {
  const stream = new FrameStream(framing)
  stream.push(bytes)
  const frame = stream.next() ?? { fatal: 'truncated' }
  const fault = frame.fatal ?? frame.fault
  if (fault) return ['refused', fault, '']
  const { response, kind, code, id } = frame.id
  const header = [Number(response), kind, code, id]
  const raw = () => ['bytes', ...header, Buffer.from(frame.data).toString('hex')]
  if (kind === kinds.stream) return raw()
  const struct = known.get(key(frame.id))
  const envelope = wire.envelope[response ? 'response' : 'request'].struct
  const read = readEnveloped(envelope, struct ?? nothing, frame.data, allowance)
  return struct ? ['message', ...header, writeEnveloped(envelope, read.envelope, struct, read.message)] : raw()
}

for await (const line of createInterface({ input: process.stdin })) {
  let answer
  try {
    answer = verdict(Buffer.from(line, 'hex'))
  } catch (problem) {
    if (!(problem instanceof BodyError)) throw problem
    answer = ['refused', problem.kind, problem.path]
  }
  if (!process.stdout.write(`${JSON.stringify(answer)}\n`)) await new Promise((go) => process.stdout.once('drain', go))
}
