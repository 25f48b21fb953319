// Schemas as reader and writer use them: each is prepared once.

import type { AnyChoice, AnyEnum, AnyStruct, FieldSchema, ListSchema, NamedSchema, TypeSchema } from './schema.ts'

export type { AnyStruct } from './schema.ts'

/** A value of any kind. */
export type Value = unknown

/** A field, prepared. */
export interface FieldPlan {
  /** Its name in code. */
  readonly name: string
  /** What the schema says. */
  readonly schema: FieldSchema
  /** Where its value is among those of the object. */
  readonly slot: number
  /** The key as it is written in front of a value. */
  readonly lead: string
  /** Matches all of a text. */
  readonly pattern: RegExp | null
  /** Whether it demands anything of its values beyond their type. */
  readonly isConstrained: boolean
}

/** A struct, prepared. */
export interface StructPlan {
  /** Its fields, in the order in which they are sent. */
  readonly fields: readonly FieldPlan[]
  /** The same by each key under which they are accepted. */
  readonly byKey: ReadonlyMap<string, FieldPlan>
  /** Those that demand something of their values. */
  readonly constrained: readonly FieldPlan[]
}

const plans = new WeakMap<object, StructPlan>()

/** Prepares a struct. */
export function planOf(struct: AnyStruct): StructPlan {
  const known = plans.get(struct)
  if (known) return known
  const fields = Object.entries(struct.fields).map(([name, schema], slot): FieldPlan => {
    const { key, min, max, length, pattern, only } = schema
    return {
      name,
      schema,
      slot,
      lead: `${JSON.stringify(key)}:`,
      pattern: pattern === undefined ? null : new RegExp(`^(?:${pattern})$`, 'u'),
      isConstrained: [min, max, length, pattern, only].some((one) => one !== undefined),
    }
  })
  const plan: StructPlan = {
    fields,
    byKey: new Map(
      fields.flatMap((field) => [field.schema.key, ...(field.schema.also ?? [])].map((key) => [key, field])),
    ),
    constrained: fields.filter(({ isConstrained }) => isConstrained),
  }
  plans.set(struct, plan)
  return plan
}

/** What can stand behind a name. */
export type Named = AnyStruct | AnyEnum | AnyChoice

/** The type behind a name. */
export function named(type: NamedSchema): Named {
  return type()
}

/** Whether it is the type of a list. */
export function isList(type: TypeSchema): type is ListSchema {
  return typeof type === 'object'
}
