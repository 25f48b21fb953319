// Schemas as reader and writer use them: each is prepared once.

import { isConstrained } from './constraint.ts'
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
  /** The same in UTF-8. */
  readonly leadBytes: Uint8Array
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

const encoder = new TextEncoder()
const plans = new WeakMap<object, StructPlan>()

/** Prepares a struct. */
export function planOf(struct: AnyStruct): StructPlan {
  const known = plans.get(struct)
  if (known) return known
  const fields = Object.entries(struct.fields).map(([name, schema], slot): FieldPlan => {
    const { key, pattern } = schema
    const lead = `${JSON.stringify(key)}:`
    return {
      name,
      schema,
      slot,
      lead,
      leadBytes: encoder.encode(lead),
      pattern: pattern === undefined ? null : new RegExp(`^(?:${pattern})$`, 'u'),
      isConstrained: isConstrained(schema),
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

const pairs = new WeakMap<StructPlan, WeakMap<StructPlan, StructPlan>>()

/** Prepares the fields of one struct and those of another behind them, as if they were those of one. */
export function joint(first: StructPlan, second: StructPlan): StructPlan {
  let known = pairs.get(first)
  if (!known) pairs.set(first, (known = new WeakMap()))
  let plan = known.get(second)
  if (!plan) {
    const moved = second.fields.map((field): FieldPlan => ({ ...field, slot: field.slot + first.fields.length }))
    const inPlace = ([key, { slot }]: [string, FieldPlan]): [string, FieldPlan][] => {
      const field = moved[slot]
      return field ? [[key, field]] : []
    }
    plan = {
      fields: [...first.fields, ...moved],
      // A key that both have belongs to the first.
      byKey: new Map([...[...second.byKey].flatMap(inPlace), ...first.byKey]),
      constrained: [],
    }
    known.set(second, plan)
  }
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
