// The names of the values of an enum.

import type { AnyEnum, EnumValueOf } from './schema.ts'

/** The name that a value has in the spec, as the enum's constant spells it; `null` of a value that the spec does not have. */
export function nameOf(schema: AnyEnum, value: EnumValueOf): string | null {
  const entry = Object.entries(schema.values).find(([, known]) => known === value)
  return entry?.[0] ?? null
}

/** Whether the spec has a value: others are kept unchanged, unless the enum is closed. */
export function isKnown(schema: AnyEnum, value: EnumValueOf): boolean {
  return Object.values(schema.values).includes(value)
}
