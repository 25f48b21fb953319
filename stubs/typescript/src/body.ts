// Reads bodies of any frame with the schemas of the typed messages. Finds all errors, not only the first.

import { keys } from './bodies.ts'
import type { ErrorName } from './errors.ts'
import { BodyError, Findings } from './fault.ts'
import type { Operation, Protocol, Side } from './protocol.ts'
import { judge, readAll } from './read.ts'
import { ANY } from './scanner.ts'
import type { AnyStruct, Struct } from './schema.ts'
import type { ResponseEnvelopeOf } from './wire.ts'

/** An error of a body, and its place. */
export interface BodyFault {
  /** The name of the error. */
  readonly name: ErrorName
  /** Wire keys down to the place, such as `data.stations[3].x`; empty for the body itself. */
  readonly path: string
  /** The value or form that the spec asks for. */
  readonly expected: string
}

/** A key or enum value that the spec does not know. */
export interface UnknownPlace {
  /** Wire keys down to the place. */
  readonly path: string
}

/** The errors and unknown places of a body. */
export interface BodyReport {
  /** The body as text. */
  readonly text: string
  /** `true` if the text is JSON. */
  readonly isJson: boolean
  /** All errors. The first is the one that a robot or app reports: errors in the envelope come before all others. */
  readonly faults: readonly BodyFault[]
  /** Keys and enum values that the spec does not know: kept, not faults. */
  readonly unknown: readonly UnknownPlace[]
  /** The result code of a response, if it has one. */
  readonly resultCode: string | null
}

type Keys = Readonly<Record<string, unknown>>

/** Reads a body. `operation` may be `null` for a code that the spec does not know: then only the envelope is checked. */
export function readBody(protocol: Protocol, operation: Operation | null, side: Side, data: Uint8Array): BodyReport {
  // A stream's frame has no envelope.
  const envelope: ResponseEnvelopeOf = operation?.kind === 'stream' ? { struct: keys } : protocol.envelope[side]
  const message = operation?.[side] ?? keys
  const findings = new Findings()
  let isJson = false
  let result: unknown
  try {
    judge(data, { ...ANY, depth: protocol.limits.jsonDepth })
    isJson = true
    const found = readAll(envelope.struct as Struct<Keys>, message as Struct<Keys>, data, findings)
    result = envelope.code === undefined ? undefined : found.envelope[envelope.code]
  } catch (problem) {
    if (!(problem instanceof BodyError)) throw problem
    findings.fault(problem)
  }
  const isOfEnvelope = faultsOf(envelope.struct)
  const success = protocol.results.find(({ role }) => role === 'success')?.code
  // A refusal has only the envelope.
  const isRefusal = result !== undefined && Number(result) !== success
  const others = isRefusal ? [] : findings.faults.filter((fault) => !isOfEnvelope(fault))
  const faults = [...findings.faults.filter(isOfEnvelope), ...others]
  return {
    text: new TextDecoder('utf-8', { ignoreBOM: true }).decode(data),
    isJson,
    faults: faults.map(({ kind, path, expected }) => ({ name: kind as ErrorName, path, expected })),
    unknown: findings.unknown.map((path) => ({ path })),
    resultCode: result === undefined ? null : String(result),
  }
}

/** Tells faults of an envelope from those of the message. A fault without a path counts as one of the envelope. */
function faultsOf({ fields }: AnyStruct): (fault: BodyError) => boolean {
  const names = new Set(Object.values(fields).map(({ key }) => key))
  return ({ path }) => path === '' || names.has(path)
}
