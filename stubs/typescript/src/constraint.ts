// Constraints of fields: their types, and the check of a value.

import { BodyError } from './fault.ts'
import type { FieldPlan, Value } from './plan.ts'

/** Constraints of a field on its values, in addition to the type. */
export interface Constraints {
  /** Least value. */
  readonly min?: number | bigint
  /** Greatest value. */
  readonly max?: number | bigint
  /** Least and greatest number of items, characters or bytes. */
  readonly length?: readonly [number, number]
  /** Regular expression that all of a text must match. */
  readonly pattern?: string
  /** The values of an enum that it takes. */
  readonly only?: readonly (number | bigint | string)[]
}

/** Returns `true` if there is a constraint. */
export function isConstrained({ min, max, length, pattern, only }: Constraints): boolean {
  return [min, max, length, pattern, only].some((one) => one !== undefined)
}

/** Returns the number of characters (code points) in a text. Some of them take two UTF-16 units. */
export function characters(text: string): number {
  let count = text.length
  for (let at = 0; at + 1 < text.length; at++) {
    const high = text.charCodeAt(at)
    if (high >= 0xd800 && high <= 0xdbff) {
      count--
      at++
    }
  }
  return count
}

/**
 * Returns `true` if the text matches. A text too long for the stack of the regular expression engine does not match.
 */
export function matches(pattern: RegExp, text: string): boolean {
  try {
    return pattern.test(text)
  } catch (problem) {
    if (!(problem instanceof RangeError)) throw problem
    return false
  }
}

/** Returns the first constraint of a field that a value breaks, as an error; `null` if it breaks none. */
export function broken(field: FieldPlan, value: Value): BodyError | null {
  const { schema } = field
  const { key, min, max, length, only } = schema
  if (min !== undefined && !each(value, (one) => compares(one) && one >= min)) {
    return new BodyError('out_of_range', `at least ${min}`, key)
  }
  if (max !== undefined && !each(value, (one) => compares(one) && one <= max)) {
    return new BodyError('out_of_range', `at most ${max}`, key)
  }
  if (length !== undefined) {
    const found = measure(value)
    const [least, most] = length
    if (found < least || found > most)
      return new BodyError('bad_length', least === most ? `${least}` : `${least} … ${most}`, key)
  }
  const { pattern } = field
  if (pattern !== null && !each(value, (one) => typeof one === 'string' && matches(pattern, one))) {
    return new BodyError('bad_pattern', schema.pattern ?? '', key)
  }
  if (only !== undefined && !each(value, (one) => (only as readonly Value[]).includes(one))) {
    return new BodyError('out_of_range', only.join(' | '), key)
  }
  return null
}

const compares = (value: Value): value is number | bigint => typeof value === 'number' || typeof value === 'bigint'

/** Returns `true` if `holds` accepts the value, or each item of a list. */
function each(value: Value, holds: (one: Value) => boolean): boolean {
  return Array.isArray(value) ? value.every((item: Value) => each(item, holds)) : holds(value)
}

function measure(value: Value): number {
  if (typeof value === 'string') return characters(value)
  return Array.isArray(value) || value instanceof Uint8Array ? value.length : 0
}
