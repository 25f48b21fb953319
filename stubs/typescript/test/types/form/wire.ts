// The form of the generated wire.ts: the numbers of the protocol.

import type { Struct, Wire } from 'fc-protocol/runtime'

/** The envelope's keys of every request and report. */
export interface RequestEnvelope {
  /** Timestamp in milliseconds. */
  time?: bigint | undefined
}

/** The envelope's keys of every response and acknowledgement. */
export interface ResponseEnvelope {
  /** Timestamp in milliseconds. */
  time?: bigint | undefined
  /** Result code. */
  result: number
  /** Text for the result code, for reading only. */
  text?: string | undefined
}

const RequestEnvelope: Struct<RequestEnvelope> = {
  is: 'struct',
  name: 'RequestEnvelope',
  fields: { time: { key: 'time', type: 'i64', optional: true } },
}

const ResponseEnvelope: Struct<ResponseEnvelope> = {
  is: 'struct',
  name: 'ResponseEnvelope',
  fields: {
    time: { key: 'time', type: 'i64', optional: true },
    result: { key: 'result', type: 'i32' },
    text: { key: 'text', type: 'string', optional: true },
  },
}

/** Result codes. */
export type ResultCode = 0 | 1 | 2 | 3 | 4 | (number & {})

/** Result codes. */
export const ResultCode = { Success: 0, Protocol: 1, Timeout: 2, Invalid: 3, Expired: 4 } as const

/** The protocol below its messages. */
export const wire: Wire = {
  name: 'toy',
  host: '127.0.0.1',
  commandPort: 7001,
  dataPort: 7002,
  frame: {
    byteOrder: 'big',
    headerLength: 17,
    header: [
      { offset: 0, size: 2, type: 'bytes', role: 'head', algorithm: null, value: 0, zeroWhenPlain: false },
      { offset: 2, size: 1, type: 'uint', role: 'kind', algorithm: null, value: 0, zeroWhenPlain: false },
      { offset: 3, size: 2, type: 'uint', role: 'code', algorithm: null, value: 0, zeroWhenPlain: false },
      { offset: 5, size: 4, type: 'uint', role: 'id', algorithm: null, value: 0, zeroWhenPlain: false },
      { offset: 9, size: 4, type: 'uint', role: 'total_length', algorithm: null, value: 0, zeroWhenPlain: false },
      { offset: 13, size: 4, type: 'bytes', role: 'digest', algorithm: 'crc32', value: 0, zeroWhenPlain: false },
    ],
    requestHead: [0x70, 0x01],
    responseHead: [0x70, 0x02],
    kinds: [
      { value: 0, role: 'stream' },
      { value: 1, role: 'command' },
      { value: 2, role: 'reserved' },
      { value: 3, role: 'report' },
    ],
    encodings: [],
  },
  envelope: {
    request: { struct: RequestEnvelope, time: 'time' },
    response: { struct: ResponseEnvelope, time: 'time', code: 'result', text: 'text' },
  },
  results: {
    success: { code: ResultCode.Success, text: 'ok' },
    protocol: { code: ResultCode.Protocol, text: 'protocol' },
    timeout: { code: ResultCode.Timeout, text: 'timeout' },
    invalid: { code: ResultCode.Invalid, text: 'invalid' },
    expired: { code: ResultCode.Expired, text: 'expired' },
  },
  defaults: {
    callTimeout: 3000,
    handlerTimeout: 2000,
    maxAge: null,
    ack: { timeout: 2000, retries: 3 },
    limits: {
      frameBytes: 65536,
      inflatedBytes: 65536,
      inflateRatio: 256,
      jsonDepth: 16,
      jsonValues: 1_048_576,
      inFlight: 64,
      queuedReports: 16,
      connections: 8,
    },
  },
}
