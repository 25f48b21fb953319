// What is wrong with a body, as an error.

import type { ErrorName } from './errors.ts'

/** The names of limits that only an implementation with such a limit has. */
export type OwnLimit = 'too_many_values' | 'inflates_too_much'

/** What can be wrong with a body. */
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

/** A key, or the place of an item. */
type Step = string | number

/** A path from one step further out. */
function below(step: Step, path: string): string {
  const own = typeof step === 'number' ? `[${step}]` : step
  return path === '' || path.startsWith('[') ? own + path : `${own}.${path}`
}

/** A body that is none of its type. It quotes no value: what peers send stays out of logs. */
export class BodyError extends Error {
  /** The fixed name. */
  readonly kind: BodyErrorKind
  /** What is expected. */
  readonly expected: string
  /** Wire keys down to the place, such as `data.stations[3].x`; empty for the body itself. */
  path: string

  /** `expected` says what is expected in place of what is there. */
  constructor(kind: BodyErrorKind, expected: string, path: string = '') {
    super(kind)
    this.kind = kind
    this.expected = expected
    this.path = path
    this.name = 'BodyError'
    this.message = this.say()
  }

  /** Notes that it is inside this key or item. */
  inside(step: Step): this {
    this.path = below(step, this.path)
    this.message = this.say()
    return this
  }

  private say(): string {
    return `${this.path || 'the body'}: ${this.kind}, expected ${this.expected}`
  }
}

/** The findings of a reader that goes on behind errors, in its order. */
export class Findings {
  /** All errors. */
  readonly faults: BodyError[] = []
  /** Paths of the keys and enum values that the spec does not know. */
  readonly unknown: string[] = []
  private readonly steps: Step[] = []

  /** Goes to the value of a key or an item. */
  enter(step: Step): void {
    this.steps.push(step)
  }

  /** Goes back behind it. */
  leave(): void {
    this.steps.pop()
  }

  /** Notes an error, whose path begins here. */
  fault(problem: BodyError): void {
    this.faults.push(this.steps.reduceRight<BodyError>((fault, step) => fault.inside(step), problem))
  }

  /** Notes an unknown key here, or the value at hand. */
  unknownAt(path: string): void {
    this.unknown.push(this.steps.reduceRight<string>((inner, step) => below(step, inner), path))
  }
}
