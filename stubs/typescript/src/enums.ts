// The names of the values of an enum.

import type { AnyEnum, EnumValueOf } from './schema.ts'

/** Returns the constant's name of a value; `null` if the spec does not declare it. */
export function nameOf(schema: AnyEnum, value: EnumValueOf): string | null {
  const entry = Object.entries(schema.values).find(([, known]) => known === value)
  return entry?.[0] ?? null
}

/** Returns `true` if the spec declares the value. Unknown values are kept unchanged, unless the enum is closed. */
export function isKnown(schema: AnyEnum, value: EnumValueOf): boolean {
  return Object.values(schema.values).includes(value)
}
