// Bodies with the envelopes of a protocol.

import { BodyError } from './fault.ts'
import type { ResultText } from './operation.ts'
import type { Clock } from './platform.ts'
import { fromJson, readEnvelope, readEnveloped } from './read.ts'
import { Refusal } from './refusal.ts'
import type { Allowance } from './scanner.ts'
import type { AnyStruct, Extra, JsonText, Struct } from './schema.ts'
import type { EnvelopeOf, Limits, Wire } from './wire.ts'
import { bytesOf, writeEnveloped } from './write.ts'

/** Keys of any names. */
export interface Keys {
  /** All of them. */
  extra?: Extra
}

/** A message with no declared keys. */
export const keys: Struct<Keys> = { is: 'struct', name: 'Keys', fields: {} }

/** Returns the keys of an object as JSON text. */
export const textOf = ({ extra = [] }: Keys): string =>
  `{${extra.map(({ key, json }) => `${JSON.stringify(key)}:${json}`).join(',')}}`

/** Returns the keys of an object from its JSON text. Throws a `BodyError`. */
export function keysOf(json: unknown, allowed: Allowance): Keys {
  return fromJson(keys, json as JsonText, allowed)
}

type Envelope = Record<string, unknown>

/** A received message, with facts from its envelope. */
export interface Received<M> {
  /** The message. */
  readonly message: M
  /** Time the message was made, in milliseconds since 1970; `null` if it carries no time. */
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

  /** Creates the reader and writer, with limits. */
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

  /** `true` if responses carry a result code. Without one, errors get no response. */
  get hasResult(): boolean {
    return this.wire.envelope.response.code !== undefined
  }

  /** Limits on reading one body. */
  get allowed(): Allowance {
    return this.allowance
  }

  /** Writes a request or a report. Throws a `BodyError`. */
  writeRequest<M>(struct: Struct<M>, message: M): Uint8Array {
    const { time } = this.wire.envelope.request
    const envelope = time === undefined ? {} : { [time]: this.requestTime(this.clock.wallTime()) }
    return bytesOf(writeEnveloped(this.request, envelope, struct, message))
  }

  /** Writes a response with this result. Throws a `BodyError`. */
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

  /** Reads a response or a refusal. Throws a `BodyError`. */
  readResponse<M>(struct: Struct<M>, data: Uint8Array): Received<M> | Refusal {
    let read: { envelope: Envelope; message: M }
    try {
      read = readEnveloped(this.response, struct, data, this.allowance)
    } catch (problem) {
      if (!(problem instanceof BodyError)) throw problem
      // A refusal counts as one even if its other keys are invalid.
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
    // A response without a result code is a success.
    if (result === undefined) return null
    const found = Number(result)
    if (found === this.wire.results.success.code) return null
    const said = text === undefined ? undefined : envelope[text]
    return new Refusal(found, typeof said === 'string' ? said : '')
  }
}

/**
 * Returns the first message id: the local time of day as the decimal digits `HHmmssSSS`. A program that restarts then
 * does not reuse ids.
 */
export function firstIdAt(wallTime: number): number {
  const time = new Date(wallTime)
  const seconds = (time.getHours() * 100 + time.getMinutes()) * 100 + time.getSeconds()
  return seconds * 1000 + time.getMilliseconds()
}

/** Returns a refusal: a result with a reason. */
export const because = ({ code, text }: ResultText, why: string): Refusal => new Refusal(code, `${text}: ${why}`)
