// The error of a body, as an exception.

import type { ErrorName } from './errors.ts'

/** Errors of limits that not every implementation has. */
export type OwnLimit = 'too_many_values' | 'inflates_too_much'

/** Errors that a body can have. */
export type BodyErrorKind =
  | Extract<
      ErrorName,
      | 'not_utf8'
      | 'bad_json'
      | 'not_an_object'
      | 'wrong_type'
      | 'missing_field'
      | 'duplicate_key'
      | 'lone_surrogate'
      | 'out_of_range'
      | 'bad_length'
      | 'bad_pattern'
      | 'unknown_value'
      | 'no_variant'
      | 'too_deep'
      | 'bad_base64'
    >
  | 'too_many_values'

/** A key, or the index of an item. */
type Step = string | number

/** Prefixes a path with one more step. */
function below(step: Step, path: string): string {
  const own = typeof step === 'number' ? `[${step}]` : step
  return path === '' || path.startsWith('[') ? own + path : `${own}.${path}`
}

/** The error of an invalid body. It quotes no value: data from peers stays out of logs. */
export class BodyError extends Error {
  /** The fixed name. */
  readonly kind: BodyErrorKind
  /** The value or form that was expected. */
  readonly expected: string
  /** Wire keys down to the place, such as `data.stations[3].x`; empty for the body itself. */
  path: string

  /** Creates the error. `expected` describes the value that belongs there. */
  constructor(kind: BodyErrorKind, expected: string, path: string = '') {
    super(kind)
    this.kind = kind
    this.expected = expected
    this.path = path
    this.name = 'BodyError'
    this.message = this.say()
  }

  /** Prefixes the path with this key or index. */
  inside(step: Step): this {
    this.path = below(step, this.path)
    this.message = this.say()
    return this
  }

  private say(): string {
    return `${this.path || 'the body'}: ${this.kind}, expected ${this.expected}`
  }
}

/** The errors and unknown places that a reader found, in its order. The reader continues after errors. */
export class Findings {
  /** All errors. */
  readonly faults: BodyError[] = []
  /** Paths of the keys and enum values that the spec does not know. */
  readonly unknown: string[] = []
  private readonly steps: Step[] = []

  /** Enters the value of a key or an item. */
  enter(step: Step): void {
    this.steps.push(step)
  }

  /** Leaves it. */
  leave(): void {
    this.steps.pop()
  }

  /** Adds an error, with a path relative to this place. */
  fault(problem: BodyError): void {
    this.faults.push(this.steps.reduceRight<BodyError>((fault, step) => fault.inside(step), problem))
  }

  /** Adds an unknown key, or the present value. */
  unknownAt(path: string): void {
    this.unknown.push(this.steps.reduceRight<string>((inner, step) => below(step, inner), path))
  }
}
