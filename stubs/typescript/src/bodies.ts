// Bodies with their envelopes, as a protocol has them.

import { BodyError } from './fault.ts'
import type { ResultText } from './operation.ts'
import type { Clock } from './platform.ts'
import { readEnvelope, readEnveloped, readMessage } from './read.ts'
import { Refusal } from './refusal.ts'
import type { Allowance } from './scanner.ts'
import type { AnyStruct, Extra, Struct } from './schema.ts'
import type { EnvelopeOf, Limits, Wire } from './wire.ts'
import { bytesOf, writeEnveloped } from './write.ts'

/** Keys of any names. */
export interface Keys {
  /** All of them. */
  extra?: Extra
}

/** A message without keys of its own. */
export const keys: Struct<Keys> = { is: 'struct', name: 'Keys', fields: {} }

/** The keys of an object as its text. */
export const textOf = ({ extra = [] }: Keys): string =>
  `{${extra.map(({ key, json }) => `${JSON.stringify(key)}:${json}`).join(',')}}`

/** The keys of an object that is given as its text. Throws a `BodyError`. */
export function keysOf(json: unknown, allowed: Allowance): Keys {
  if (typeof json !== 'string') throw new BodyError('wrong_type', 'JSON text')
  return readMessage(keys, bytesOf(json), allowed)
}

type Envelope = Record<string, unknown>

/** A message that has arrived, with what its envelope says. */
export interface Received<M> {
  /** Its own keys. */
  readonly message: M
  /** When it was made, in milliseconds since 1970, if it says so. */
  readonly time: number | null
}

const numberFor = (struct: AnyStruct, field: string): ((value: number) => number | bigint) => {
  const schema = struct.fields[field]
  return (schema?.type === 'i64' || schema?.type === 'u64') && schema.safe !== true
    ? (value) => BigInt(value)
    : (value) => value
}

const timeOf = ({ time }: EnvelopeOf, envelope: Envelope): number | null => {
  const value = time === undefined ? undefined : envelope[time]
  return typeof value === 'number' || typeof value === 'bigint' ? Number(value) : null
}

/** Writes and reads the bodies of a protocol. */
export class Bodies {
  private readonly wire: Wire
  private readonly clock: Clock
  private readonly request: Struct<Envelope>
  private readonly response: Struct<Envelope>
  private readonly requestTime: (value: number) => number | bigint
  private readonly responseTime: (value: number) => number | bigint
  private readonly resultCode: (value: number) => number | bigint
  private readonly allowance: Allowance

  /** Bodies within limits. */
  constructor(wire: Wire, clock: Clock, limits: Limits) {
    const { request, response } = wire.envelope
    this.wire = wire
    this.clock = clock
    this.request = request.struct as Struct<Envelope>
    this.response = response.struct as Struct<Envelope>
    this.requestTime = numberFor(request.struct, request.time ?? '')
    this.responseTime = numberFor(response.struct, response.time ?? '')
    this.resultCode = numberFor(response.struct, response.code ?? '')
    this.allowance = { depth: limits.jsonDepth, values: limits.jsonValues }
  }

  /** Whether responses carry a result. If not, what did not go well is not answered. */
  get hasResult(): boolean {
    return this.wire.envelope.response.code !== undefined
  }

  /** What reading one body may cost. */
  get allowed(): Allowance {
    return this.allowance
  }

  /** A request or a report. Throws a `BodyError`. */
  writeRequest<M>(struct: Struct<M>, message: M): Uint8Array {
    const { time } = this.wire.envelope.request
    const envelope = time === undefined ? {} : { [time]: this.requestTime(this.clock.wallTime()) }
    return bytesOf(writeEnveloped(this.request, envelope, struct, message))
  }

  /** An answer with this result. Throws a `BodyError`. */
  writeResponse<M>({ code, text }: ResultText, struct: Struct<M>, message: M): Uint8Array {
    const of = this.wire.envelope.response
    const envelope: Envelope = {}
    if (of.time !== undefined) envelope[of.time] = this.responseTime(this.clock.wallTime())
    if (of.code !== undefined) envelope[of.code] = this.resultCode(code)
    if (of.text !== undefined) envelope[of.text] = text
    return bytesOf(writeEnveloped(this.response, envelope, struct, message))
  }

  /** Reads a request or a report. Throws a `BodyError`. */
  readRequest<M>(struct: Struct<M>, data: Uint8Array): Received<M> {
    const { envelope, message } = readEnveloped(this.request, struct, data, this.allowance)
    return { message, time: timeOf(this.wire.envelope.request, envelope) }
  }

  /** Reads a response, or what it refuses. Throws a `BodyError`. */
  readResponse<M>(struct: Struct<M>, data: Uint8Array): Received<M> | Refusal {
    let read: { envelope: Envelope; message: M }
    try {
      read = readEnveloped(this.response, struct, data, this.allowance)
    } catch (problem) {
      if (!(problem instanceof BodyError)) throw problem
      // A refusal is one, whatever stands beside it.
      const refusal = this.refusalOf(readEnvelope(this.response, data, this.allowance))
      if (refusal) return refusal
      throw problem
    }
    return (
      this.refusalOf(read.envelope) ?? {
        message: read.message,
        time: timeOf(this.wire.envelope.response, read.envelope),
      }
    )
  }

  private refusalOf(envelope: Envelope): Refusal | null {
    const { code, text } = this.wire.envelope.response
    const result = code === undefined ? undefined : envelope[code]
    // Without a result, all went well.
    if (result === undefined) return null
    const found = Number(result)
    if (found === this.wire.results.success.code) return null
    const said = text === undefined ? undefined : envelope[text]
    return new Refusal(found, typeof said === 'string' ? said : '')
  }
}

/** Where ids begin: the local time of day as the decimal digits `HHmmssSSS`, so that who restarts does not use ids again. */
export function firstIdAt(wallTime: number): number {
  const time = new Date(wallTime)
  const seconds = (time.getHours() * 100 + time.getMinutes()) * 100 + time.getSeconds()
  return seconds * 1000 + time.getMilliseconds()
}

/** A result with why. */
export const because = ({ code, text }: ResultText, why: string): Refusal => new Refusal(code, `${text}: ${why}`)
