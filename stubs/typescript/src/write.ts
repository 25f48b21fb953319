// Writes messages as bodies. Broken constraints are found before anything is sent.

import { base64Of } from './base64.ts'
import { broken } from './constraint.ts'
import { isKnown } from './enums.ts'
import { BodyError } from './fault.ts'
import { hasLoneSurrogate } from './json.ts'
import { isList, named, planOf } from './plan.ts'
import type { AnyStruct, FieldPlan, Named, Value } from './plan.ts'
import { INTEGERS, SMALL, shortFloat } from './read.ts'
import { utf8Of } from './room.ts'
import { Scanner } from './scanner.ts'
import type { Allowance } from './scanner.ts'
import type { AnyEnum, EnumValueOf, ExtraKey, FieldSchema, IntegerName, Struct, TypeSchema } from './schema.ts'

/** A message with the struct that describes it. */
type Part = readonly [struct: AnyStruct, message: Value]

/** Returns a message as JSON; `JSON.stringify` refuses `bigint`. Throws a `BodyError` if it breaks a constraint. */
export function toJson<M>(struct: Struct<M>, message: M): string {
  return `{${members([[struct, message]])}}`
}

/** Writes an envelope and a message as one object. Throws a `BodyError`. */
export function writeEnveloped<E, M>(envelope: Struct<E>, keys: E, struct: Struct<M>, message: M): string {
  return `{${members([
    [envelope, keys],
    [struct, message],
  ])}}`
}

/** Encodes the text as sent. */
export function bytesOf(text: string): Uint8Array {
  return utf8Of(text)
}

/** Limits on an extra key: only the reader's depth on the other side matters. */
const EXTRA: Allowance = { depth: 512, values: Number.POSITIVE_INFINITY }

function members(parts: readonly Part[]): string {
  let text = ''
  for (const [struct, message] of parts) {
    const own = asObject(message, struct.name)
    let isEmpty = true
    for (const field of planOf(struct).fields) {
      const value = own[field.name]
      if (value === undefined || value === null) {
        if (field.schema.optional !== true) throw new BodyError('missing_field', field.schema.key, field.schema.key)
        continue
      }
      isEmpty = false
      const written = writeField(field, value)
      text += text === '' ? field.lead + written : `,${field.lead}${written}`
    }
    if (isEmpty && isOther(struct, own)) throw new BodyError('wrong_type', struct.name)
    const extra = own['extra']
    if (extra === undefined || extra === null) continue
    for (const { key, json } of extraOf(extra)) {
      text += `${text === '' ? '' : ','}${quoted(key)}:${checked(json, key)}`
    }
  }
  return text
}

/**
 * Returns a plain object or an instance of a class. Lists, dates, errors and promises are refused: their content is not
 * in keys.
 */
function asObject(value: Value, expected: string): Readonly<Record<string, Value>> {
  if (typeof value === 'object' && value !== null) {
    const isPlainObject = Object.getPrototypeOf(value) === Object.prototype
    if (isPlainObject || Object.prototype.toString.call(value) === '[object Object]')
      return value as Readonly<Record<string, Value>>
  }
  throw new BodyError('wrong_type', expected)
}

/**
 * Returns `true` if a message has keys, but none of its struct's. It has another type and would be sent without any
 * key. TypeScript refuses it, too.
 */
function isOther({ fields }: AnyStruct, own: Readonly<Record<string, Value>>): boolean {
  const isUnknown = (name: string): boolean => name !== 'extra' && !Object.hasOwn(fields, name)
  return Object.keys(own).some((name) => own[name] !== undefined && isUnknown(name))
}

/** Returns the unknown keys of a message, which come from the caller. */
function extraOf(value: Value): readonly ExtraKey[] {
  const isKey = (one: Partial<ExtraKey> | null | undefined): boolean => typeof one?.key === 'string'
  if (!Array.isArray(value) || !value.every(isKey)) throw new BodyError('wrong_type', '{ key, json }[]', 'extra')
  return value as readonly ExtraKey[]
}

/** Checks a JSON text from the caller: it must not close the surrounding object. */
function checked(json: Value, key: string): string {
  if (typeof json !== 'string') throw new BodyError('wrong_type', 'JSON as its text', key)
  const scanner = new Scanner(bytesOf(json), EXTRA)
  scanner.skip()
  scanner.finish()
  return json
}

function writeField(field: FieldPlan, value: Value): string {
  const { schema } = field
  let text: string
  try {
    text = writeValue(schema.type, schema, value)
  } catch (problem) {
    if (problem instanceof BodyError) throw problem.inside(schema.key)
    throw problem
  }
  const fault = field.isConstrained ? broken(field, value) : null
  if (fault !== null) throw fault
  return text
}

function writeValue(type: TypeSchema, schema: FieldSchema, value: Value): string {
  if (typeof type === 'function') return writeNamed(named(type), schema, value)
  if (isList(type)) return writeList(type.list, schema, value)
  switch (type) {
    case 'string':
      return writeText(value)
    case 'bool':
      if (typeof value !== 'boolean') throw new BodyError('wrong_type', 'true | false')
      return schema.form === 'number' ? (value ? '1' : '0') : inForm(schema, String(value))
    case 'f32':
    case 'f64':
      return inForm(schema, float(type, value))
    case 'base64':
      if (!(value instanceof Uint8Array)) throw new BodyError('wrong_type', 'bytes')
      return `"${base64Of(value)}"`
    case 'json':
      return checked(value, '')
    default:
      return inForm(schema, integer(type, schema.safe === true, value))
  }
}

const inForm = ({ form }: FieldSchema, text: string): string => (form === 'string' ? `"${text}"` : text)

function writeText(value: Value): string {
  if (typeof value !== 'string') throw new BodyError('wrong_type', '" … "')
  return isPlain(value) ? `"${value}"` : quoted(value)
}

/**
 * Returns `true` for a short text without characters to escape, as most are. The check is faster than `JSON.stringify`.
 */
function isPlain(text: string): boolean {
  const { length } = text
  if (length > 40) return false
  for (let at = 0; at < length; at++) {
    const code = text.charCodeAt(at)
    // No control character, quote, backslash or half of a surrogate pair.
    if (code < 0x20 || code === 0x22 || code === 0x5c || code >= 0xd800) return false
  }
  return true
}

/** Returns a string as JSON. Half of a surrogate pair is an error, since peers refuse it. */
function quoted(text: string): string {
  if (hasLoneSurrogate(text)) throw new BodyError('lone_surrogate', 'Unicode')
  return JSON.stringify(text)
}

function float(type: 'f32' | 'f64', value: Value): string {
  if (typeof value !== 'number') throw new BodyError('wrong_type', 'a number')
  const sent = type === 'f32' ? shortFloat(value) : value
  if (!Number.isFinite(sent)) throw new BodyError('out_of_range', 'a finite number')
  return Object.is(sent, -0) ? '-0.0' : String(sent)
}

function integer(type: IntegerName, safe: boolean, value: Value): string {
  const small = SMALL[type]
  if (small && typeof value === 'number') {
    if (!Number.isInteger(value)) throw new BodyError('wrong_type', 'an integer')
    if (value < small[0] || value > small[1]) throw new BodyError('out_of_range', `${small[0]} … ${small[1]}`)
    return String(value)
  }
  const isLarge = !small && !safe
  if (typeof value !== (isLarge ? 'bigint' : 'number'))
    throw new BodyError('wrong_type', isLarge ? 'a bigint' : 'a number')
  const exact = value as number | bigint
  if (typeof exact === 'number' && !Number.isSafeInteger(exact)) throw new BodyError('wrong_type', 'an integer')
  const [least, most] = INTEGERS[type]
  if (exact < least || exact > most) throw new BodyError('out_of_range', `${least} … ${most}`)
  return String(exact)
}

function writeList(type: TypeSchema, schema: FieldSchema, value: Value): string {
  if (!Array.isArray(value)) throw new BodyError('wrong_type', '[ … ]')
  let text = ''
  for (let index = 0; index < value.length; index++) {
    try {
      text += (index === 0 ? '' : ',') + writeValue(type, schema, value[index])
    } catch (problem) {
      if (problem instanceof BodyError) throw problem.inside(index)
      throw problem
    }
  }
  return `[${text}]`
}

function writeNamed(type: Named, schema: FieldSchema, value: Value): string {
  if (type.is === 'enum') return writeEnum(type, schema, value)
  if (type.is === 'struct') return `{${members([[type, value]])}}`
  const { case: name, value: held } = asObject(value, '{ case, value }')
  const form = (type.forms as Record<string, () => AnyStruct>)[String(name)]
  if (!form) throw new BodyError('no_variant', Object.keys(type.forms).join(' | '))
  return `{${members([[form(), held]])}}`
}

function writeEnum(type: AnyEnum, schema: FieldSchema, value: Value): string {
  const text =
    type.repr === 'string' ? writeText(value) : inForm(schema, integer(type.repr, schema.safe === true, value))
  if (type.closed === true && !isKnown(type, value as EnumValueOf)) {
    throw new BodyError('unknown_value', Object.values(type.values as Record<string, Value>).join(' | '))
  }
  return text
}
