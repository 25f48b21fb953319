// Schemas prepared for reader and writer, each only once.

import { isConstrained } from './constraint.ts'
import type { AnyChoice, AnyEnum, AnyStruct, FieldSchema, ListSchema, NamedSchema, TypeSchema } from './schema.ts'

export type { AnyStruct } from './schema.ts'

/** A value of any kind. */
export type Value = unknown

/** A prepared field. */
export interface FieldPlan {
  /** Its name in code. */
  readonly name: string
  /** Schema of the field. */
  readonly schema: FieldSchema
  /** Index of its value among those of the object. */
  readonly slot: number
  /** The key as written before a value. */
  readonly lead: string
  /** `lead` in UTF-8. */
  readonly leadBytes: Uint8Array
  /** Matches a whole text; `null` for no pattern. */
  readonly pattern: RegExp | null
  /** `true` if it constrains its values beyond their type. */
  readonly isConstrained: boolean
}

/** A prepared struct. */
export interface StructPlan {
  /** Its fields, in the order in which they are sent. */
  readonly fields: readonly FieldPlan[]
  /** The fields by each key that they accept. */
  readonly byKey: ReadonlyMap<string, FieldPlan>
  /** The fields with constraints. */
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

/** Joins the fields of two structs, the second's after the first's. */
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
      // A key of both belongs to the first.
      byKey: new Map([...[...second.byKey].flatMap(inPlace), ...first.byKey]),
      constrained: [],
    }
    known.set(second, plan)
  }
  return plan
}

/** A type that can have a name. */
export type Named = AnyStruct | AnyEnum | AnyChoice

/** Returns the type with this name. */
export function named(type: NamedSchema): Named {
  return type()
}

/** Returns `true` for the type of a list. */
export function isList(type: TypeSchema): type is ListSchema {
  return typeof type === 'object'
}
