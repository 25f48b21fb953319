// States of a process, and conditions of fields.

import { isKnown } from './enums.ts'
import { isList, named, planOf } from './plan.ts'
import type { AnyEnum, AnyStruct, ConditionSchema, EnumValueOf, Struct, TypeSchema } from './schema.ts'

/** Returns `true` for a final state. */
export function isFinal(schema: AnyEnum, state: EnumValueOf): boolean {
  return (schema.process?.final as readonly unknown[] | undefined)?.includes(state) ?? false
}

/** Returns `true` for a failure. */
export function isError(schema: AnyEnum, state: EnumValueOf): boolean {
  return (schema.process?.error as readonly unknown[] | undefined)?.includes(state) ?? false
}

/**
 * Returns `true` if a state may follow another. If the spec lists all changes, the change must be in the list, or one of the
 * values unknown. Otherwise the change must be in the normal order.
 */
export function mayFollow(schema: AnyEnum, previous: EnumValueOf, state: EnumValueOf): boolean {
  const isOpen = schema.process?.order === 'complete' && !(isKnown(schema, previous) && isKnown(schema, state))
  return isOpen || following(schema, previous).includes(state)
}

/**
 * Returns `true` if the spec allows this state after the previous one. Without a rule, every state is allowed. The same
 * state and a failure are always allowed.
 */
export function isInOrder(schema: AnyEnum, previous: EnumValueOf, state: EnumValueOf): boolean {
  const { process } = schema
  if (process?.order === undefined || previous === state || isError(schema, state)) return true
  if (process.order === 'complete') return mayFollow(schema, previous, state)
  const isSilent = following(schema, previous).length === 0 && !isFinal(schema, previous)
  return isSilent || !isKnown(schema, state) || mayFollow(schema, previous, state)
}

const following = (schema: AnyEnum, state: unknown): readonly unknown[] =>
  (schema.process?.next as readonly (readonly [unknown, readonly unknown[]])[] | undefined)?.find(
    ([from]) => from === state,
  )?.[1] ?? []

/** The error of a field that contradicts its condition. */
export class ConditionError extends Error {
  /** Wire keys down to the field. */
  readonly path: string
  /**
   * `missing`: the field is absent although its condition holds. `unasked`: it is present although the condition does
   * not hold.
   */
  readonly kind: 'missing' | 'unasked'

  /** Creates the error. */
  constructor(path: string, kind: 'missing' | 'unasked', sentence: string) {
    super(
      kind === 'missing'
        ? `\`${path}\` is missing: it is sent ${sentence}`
        : `\`${path}\` is not asked for: it is sent ${sentence}`,
    )
    this.name = 'ConditionError'
    this.path = path
    this.kind = kind
  }
}

type Fields = Readonly<Record<string, unknown>>

/** Returns the message if each field is present exactly where its condition holds. Throws a `ConditionError`. */
export function checked<M>(schema: Struct<M>, message: M): M {
  checkFields(schema, message as Fields, '')
  return message
}

function checkFields(schema: AnyStruct, message: Fields, path: string): void {
  for (const { name, schema: field } of planOf(schema).fields) {
    const at = path === '' ? field.key : `${path}.${field.key}`
    const value = message[name]
    const condition = field.when ?? field.unless
    if (condition) {
      const asked = holds(schema, condition, message)
      const isThere = value !== undefined && value !== null
      if (isThere !== (field.when ? asked : !asked)) {
        const only = isThere && field.when ? 'only ' : ''
        throw new ConditionError(
          at,
          isThere ? 'unasked' : 'missing',
          `${only}${field.when ? 'when' : 'unless'} ${sentence(schema, condition)}`,
        )
      }
    }
    if (value !== undefined && value !== null) checkValue(field.type, value, at)
  }
}

function checkValue(type: TypeSchema, value: unknown, at: string): void {
  if (isList(type)) {
    for (const [index, item] of (value as readonly unknown[]).entries()) checkValue(type.list, item, `${at}[${index}]`)
    return
  }
  if (typeof type !== 'function') return
  const schema = named(type)
  if (schema.is === 'struct') checkFields(schema, value as Fields, at)
  else if (schema.is === 'choice') {
    const { case: form, value: held } = value as { case: string; value: Fields }
    const struct = schema.forms[form]
    if (struct) checkFields(struct(), held, at)
  }
}

/** Returns `true` if each field has one of its values. An absent field has its default. */
function holds(schema: AnyStruct, condition: ConditionSchema, message: Fields): boolean {
  return Object.entries(condition).every(([name, values]) => {
    const value = message[name] ?? schema.fields[name]?.default
    const among = (one: unknown): boolean => (values as readonly unknown[]).includes(one)
    return Array.isArray(value) ? value.every(among) : among(value)
  })
}

const sentence = (schema: AnyStruct, condition: ConditionSchema): string =>
  Object.entries(condition)
    .map(
      ([name, values]) =>
        `\`${schema.fields[name]?.key ?? name}\` is ${values.map((value) => (typeof value === 'bigint' ? String(value) : JSON.stringify(value))).join(' or ')}`,
    )
    .join(' and ')

/** Replaces sensitive values in texts for people. */
const HIDDEN = '***'

/** Returns a copy of a message for logs and people, with sensitive values hidden. */
export function redacted<M>(schema: Struct<M>, message: M): unknown {
  return redactFields(schema, message as Fields)
}

function redactFields(schema: AnyStruct, message: Fields): Record<string, unknown> {
  const copy: Record<string, unknown> = { ...message }
  for (const [name, field] of Object.entries(schema.fields)) {
    const value = message[name]
    if (value !== undefined && value !== null)
      copy[name] = field.sensitive === true ? HIDDEN : redactValue(field.type, value)
  }
  return copy
}

function redactValue(type: TypeSchema, value: unknown): unknown {
  if (isList(type)) return (value as readonly unknown[]).map((item) => redactValue(type.list, item))
  if (typeof type !== 'function') return value
  const schema = named(type)
  if (schema.is === 'struct') return redactFields(schema, value as Fields)
  if (schema.is === 'enum') return value
  const { case: form, value: held } = value as { case: string; value: Fields }
  const struct = schema.forms[form]
  return struct ? { case: form, value: redactFields(struct(), held) } : value
}
