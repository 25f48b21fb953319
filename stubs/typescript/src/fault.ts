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
  inside(step: string | number): this {
    const own = typeof step === 'number' ? `[${step}]` : step
    this.path = this.path === '' || this.path.startsWith('[') ? own + this.path : `${own}.${this.path}`
    this.message = this.say()
    return this
  }

  private say(): string {
    return `${this.path || 'the body'}: ${this.kind}, expected ${this.expected}`
  }
}
