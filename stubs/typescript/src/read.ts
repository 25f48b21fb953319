// Reads JSON bodies as messages, with the types of the schemas.

import { bytesOfBase64 } from './base64.ts'
import { decoded } from './characters.ts'
import { broken } from './constraint.ts'
import { isKnown } from './enums.ts'
import { BodyError } from './fault.ts'
import type { Findings } from './fault.ts'
import { beforeRounding } from './floats.ts'
import { integral } from './json.ts'
import { isList, joint, named, planOf } from './plan.ts'
import type { FieldPlan, Named, StructPlan, Value } from './plan.ts'
import { utf8Of } from './room.ts'
import { ANY, CLOSE_LIST, CLOSE_OBJECT, LIST, OBJECT, STRING, Scanner } from './scanner.ts'
import type { Allowance } from './scanner.ts'
import type {
  AnyEnum,
  EnumValueOf,
  ExtraKey,
  FieldSchema,
  IntegerName,
  JsonText,
  Struct,
  TypeSchema,
} from './schema.ts'

/** An object under construction. */
type Made = Record<string, Value>

/** Marks a key that came without a value. */
const ABSENT = Symbol('absent')

/** Least and greatest value of each integer type. */
export const INTEGERS: Readonly<Record<IntegerName, readonly [bigint, bigint]>> = {
  i8: [-(2n ** 7n), 2n ** 7n - 1n],
  i16: [-(2n ** 15n), 2n ** 15n - 1n],
  i32: [-(2n ** 31n), 2n ** 31n - 1n],
  i64: [-(2n ** 63n), 2n ** 63n - 1n],
  u8: [0n, 2n ** 8n - 1n],
  u16: [0n, 2n ** 16n - 1n],
  u32: [0n, 2n ** 32n - 1n],
  u64: [0n, 2n ** 64n - 1n],
}

/** The same as numbers, for the types that fit. */
export const SMALL: Readonly<Partial<Record<IntegerName, readonly [number, number]>>> = {
  i8: [-0x80, 0x7f],
  i16: [-0x8000, 0x7fff],
  i32: [-0x80000000, 0x7fffffff],
  u8: [0, 0xff],
  u16: [0, 0xffff],
  u32: [0, 0xffffffff],
}

/** Returns the text of a body. An empty body means an object without keys. */
export function bodyText(data: Uint8Array): string {
  return data.length === 0 ? '{}' : decoded(data)
}

/** Result of one pass over a message with an envelope. */
export interface Enveloped<E, M> {
  /** The keys of the envelope. */
  envelope: E
  /** The message's own keys. */
  message: M
}

/** The most that a text may cost, unless the caller sets another limit. No protocol allows a greater depth. */
const ALLOWED: Allowance = { depth: 127, values: 2 ** 20 }

/** Reads a message from JSON as `toJson` writes it. Throws a `BodyError`. */
export function fromJson<M>(struct: Struct<M>, json: JsonText, allowance: Allowance = ALLOWED): M {
  if (typeof json !== 'string') throw new BodyError('wrong_type', 'JSON text')
  return readMessage(struct, utf8Of(json), allowance)
}

/** Reads a body that has no envelope. Throws a `BodyError`. */
export function readMessage<M>(struct: Struct<M>, data: Uint8Array, allowance: Allowance): M {
  try {
    return whole(data, allowance, plan(struct), message) as M
  } catch (problem) {
    judge(data, allowance)
    throw problem
  }
}

/**
 * Reads the keys of an envelope and of a message in one pass, in any order. Unknown keys belong to the message. An
 * error in the envelope takes precedence over one in the message. Throws a `BodyError`.
 */
export function readEnveloped<E, M>(
  envelope: Struct<E>,
  message: Struct<M>,
  data: Uint8Array,
  allowance: Allowance,
): Enveloped<E, M> {
  try {
    return both(envelope, message, data, allowance, null)
  } catch (problem) {
    judge(data, allowance)
    readAlone(envelope, data)
    throw problem
  }
}

/**
 * Reads a JSON body in the same way, but continues after each error and leaves out the invalid value. Throws a
 * `BodyError` for any value other than an object.
 */
export function readAll<E, M>(
  envelope: Struct<E>,
  message: Struct<M>,
  data: Uint8Array,
  findings: Findings,
): Enveloped<E, M> {
  return both(envelope, message, data, ANY, findings)
}

function both<E, M>(
  envelope: Struct<E>,
  message: Struct<M>,
  data: Uint8Array,
  allowance: Allowance,
  findings: Findings | null,
): Enveloped<E, M> {
  const first = plan(envelope)
  const second = plan(message)
  const make = (slots: readonly Value[], extra: readonly ExtraKey[] | null): Enveloped<E, M> => ({
    envelope: finish(first, slots, 0, null, findings) as E,
    message: finish(second, slots, first.fields.length, extra, findings) as M,
  })
  return whole(data, allowance, joint(first, second), make, findings)
}

/** Reads only the envelope, for any message. Throws a `BodyError`. */
export function readEnvelope<E>(envelope: Struct<E>, data: Uint8Array, allowance: Allowance): E {
  judge(data, allowance)
  return readAlone(envelope, data)
}

function readAlone<E>(envelope: Struct<E>, data: Uint8Array): E {
  const only = plan(envelope)
  return whole(data, ANY, only, (slots) => finish(only, slots, 0, null, null)) as E
}

const plan = <T>(struct: Struct<T>): StructPlan => planOf(struct)

/** An empty body means an object without keys. */
const NOTHING = Uint8Array.of(OBJECT, CLOSE_OBJECT)

/** Reads a whole body as one object. */
function whole<T>(
  data: Uint8Array,
  allowance: Allowance,
  plan: StructPlan,
  make: (slots: readonly Value[], extra: readonly ExtraKey[] | null, plan: StructPlan) => T,
  findings: Findings | null = null,
): T {
  const scanner = new Scanner(data.length === 0 ? NOTHING : data, allowance, findings)
  if (scanner.peek() !== OBJECT) throw new BodyError('not_an_object', '{ … }')
  const slots = new Array<Value>(plan.fields.length)
  const extra = readFields(scanner, plan, slots)
  const value = make(slots, extra, plan)
  scanner.finish()
  return value
}

const message = (slots: readonly Value[], extra: readonly ExtraKey[] | null, plan: StructPlan): Made =>
  finish(plan, slots, 0, extra, null)

/** Checks that a body is valid JSON, of any value. Throws a `BodyError`. */
export function judge(data: Uint8Array, allowance: Allowance): void {
  bodyText(data)
  if (data.length === 0) return
  const scanner = new Scanner(data, allowance)
  scanner.skip()
  scanner.finish()
}

function readObject(scanner: Scanner, plan: StructPlan): Made {
  const slots = new Array<Value>(plan.fields.length)
  return finish(plan, slots, 0, readFields(scanner, plan, slots), scanner.findings)
}

/** Reads the values of an object into their slots. Returns the keys that the plan does not have. */
function readFields(scanner: Scanner, { fields, byKey }: StructPlan, slots: Value[]): readonly ExtraKey[] | null {
  let extra: ExtraKey[] | null = null
  scanner.enter()
  if (scanner.endsAtOnce(CLOSE_OBJECT)) return null
  let next = 0
  do {
    scanner.peek()
    const expected = inOrder(scanner, fields, next)
    if (expected !== null) {
      next = expected.slot + 1
      readField(scanner, expected, expected.schema.key, slots)
      continue
    }
    const key = scanner.key()
    const field = byKey.get(key)
    if (field) {
      next = field.slot + 1
      readField(scanner, field, key, slots)
    } else {
      scanner.count(1)
      scanner.findings?.unknownAt(key)
      extra ??= []
      extra.push({ key, json: scanner.valueText() })
    }
  } while (scanner.goesOn(CLOSE_OBJECT))
  return extra
}

/** Most peers send the keys in the order of the spec, without some optional ones. Then no key needs a look-up. */
function inOrder(scanner: Scanner, fields: readonly FieldPlan[], from: number): FieldPlan | null {
  for (let slot = from; slot < fields.length; slot++) {
    const field = fields[slot]
    if (field === undefined) return null
    if (scanner.takeBytes(field.leadBytes)) return field
    if (field.schema.optional !== true) return null
  }
  return null
}

/** Reads the value of a field after its key, which may be one of its other keys. */
function readField(scanner: Scanner, field: FieldPlan, key: string, slots: Value[]): void {
  const { schema, slot } = field
  const { at, depth, findings } = scanner
  scanner.count(1)
  findings?.enter(key)
  try {
    if (slots[slot] !== undefined) throw new BodyError('duplicate_key', 'each key once')
    const empty = schema.optional === true && (schema.emptyIsAbsent === true ? scanner.takeEmpty() : scanner.takeNull())
    slots[slot] = empty ? ABSENT : readValue(scanner, schema.type, schema)
  } catch (problem) {
    if (!(problem instanceof BodyError)) throw problem
    if (findings === null) throw problem.inside(key)
    findings.fault(problem)
    scanner.skipFrom(at, depth)
    slots[slot] ??= ABSENT
  }
  findings?.leave()
}

/** Makes a message from the values of its fields, from slot `from` on. */
function finish(
  { fields, constrained }: StructPlan,
  slots: readonly Value[],
  from: number,
  extra: readonly ExtraKey[] | null,
  findings: Findings | null,
): Made {
  const made: Made = {}
  for (let index = 0; index < fields.length; index++) {
    const { name, schema } = fields[index] as FieldPlan
    const value = slots[from + index]
    if (value === undefined) {
      if (schema.optional !== true) fail(new BodyError('missing_field', schema.key, schema.key), findings)
    } else if (value !== ABSENT) made[name] = value
  }
  for (const field of constrained) {
    const value = made[field.name]
    const fault = value === undefined ? null : broken(field, value)
    if (fault !== null) fail(fault, findings)
  }
  if (extra !== null) made['extra'] = extra
  return made
}

/** Throws an error, or adds it to the findings. */
function fail(problem: BodyError, findings: Findings | null): void {
  if (findings === null) throw problem
  findings.fault(problem)
}

function readValue(scanner: Scanner, type: TypeSchema, schema: FieldSchema): Value {
  if (typeof type === 'function') return readNamed(scanner, named(type), schema)
  if (isList(type)) return readList(scanner, type.list, schema)
  switch (type) {
    case 'string':
      if (scanner.peek() !== STRING) throw new BodyError('wrong_type', '" … "')
      return scanner.string()
    case 'bool':
      return readBool(scanner, schema)
    case 'f32':
    case 'f64':
      return readFloat(scanner, type, schema)
    case 'base64':
      if (scanner.peek() !== STRING) throw new BodyError('wrong_type', 'base64')
      return bytesOfBase64(scanner.string())
    case 'json':
      return scanner.valueText()
    default:
      return readInteger(scanner, type, schema)
  }
}

function readList(scanner: Scanner, type: TypeSchema, schema: FieldSchema): Value[] {
  if (scanner.peek() !== LIST) throw new BodyError('wrong_type', '[ … ]')
  const items: Value[] = []
  scanner.enter()
  if (scanner.endsAtOnce(CLOSE_LIST)) return items
  const item = typeof type === 'function' ? named(type) : null
  const { findings } = scanner
  try {
    do {
      scanner.count(1)
      findings?.enter(items.length)
      items.push(item ? readNamed(scanner, item, schema) : readValue(scanner, type, schema))
      findings?.leave()
    } while (scanner.goesOn(CLOSE_LIST))
  } catch (problem) {
    findings?.leave()
    if (problem instanceof BodyError) throw problem.inside(items.length)
    throw problem
  }
  return items
}

function readNamed(scanner: Scanner, type: Named, schema: FieldSchema): Value {
  if (type.is === 'enum') return readEnum(scanner, type, schema)
  if (scanner.peek() !== OBJECT) throw new BodyError('wrong_type', '{ … }')
  if (type.is === 'struct') return readObject(scanner, planOf(type))
  const forms = Object.entries(type.forms)
  const keys = scanner.keysAhead()
  for (const [name, form] of forms) {
    const found = planOf(form())
    if (found.fields.every((field) => field.schema.optional === true || isAmong(field, keys))) {
      return { case: name, value: readObject(scanner, found) }
    }
  }
  throw new BodyError('no_variant', forms.map(([name]) => name).join(' | '))
}

const isAmong = ({ schema }: FieldPlan, keys: ReadonlySet<string>): boolean =>
  keys.has(schema.key) || (schema.also?.some((key) => keys.has(key)) ?? false)

function readEnum(scanner: Scanner, type: AnyEnum, schema: FieldSchema): Value {
  let value: EnumValueOf
  if (type.repr === 'string') {
    if (scanner.peek() !== STRING) throw new BodyError('wrong_type', '" … "')
    value = scanner.string()
  } else value = readInteger(scanner, type.repr, schema)
  if (type.closed === true && !isKnown(type, value)) {
    throw new BodyError('unknown_value', Object.values(type.values).join(' | '))
  }
  // A field that takes only some values refuses the others as an error, not as unknown.
  if (scanner.findings !== null && schema.only === undefined && !isKnown(type, value)) scanner.findings.unknownAt('')
  return value
}

function readBool(scanner: Scanner, { form, lenientBool }: FieldSchema): boolean {
  const code = scanner.peek()
  if (code === STRING) {
    if (form === 'string' || lenientBool === true) {
      const text = scanner.string()
      if (text === 'true' || text === 'false') return text === 'true'
    }
  } else if (scanner.isNumber()) {
    if (form === 'number' || lenientBool === true) {
      const value = integral(scanner.number())
      if (value === 0n || value === 1n) return value === 1n
    }
  } else if (form === undefined || lenientBool === true) {
    if (scanner.take('true')) return true
    if (scanner.take('false')) return false
  }
  throw new BodyError(
    'wrong_type',
    form === 'string' ? '"true" | "false"' : form === 'number' ? '0 | 1' : 'true | false',
  )
}

/** Returns `true` if a number is in quotes here. */
const isQuoted = (scanner: Scanner, { form, lenientNumber }: FieldSchema): boolean =>
  lenientNumber === true ? scanner.peek() === STRING : form === 'string'

/** Reads the text of a number, in quotes where the field allows that. */
function numberText(scanner: Scanner, expected: string, { form, lenientNumber }: FieldSchema): string {
  if (scanner.peek() === STRING) {
    if (form !== 'string' && lenientNumber !== true) throw new BodyError('wrong_type', expected)
    const text = scanner.string()
    if (lenientNumber === true && /^0[xX][0-9a-fA-F]+$/.test(text)) {
      const value = BigInt(text)
      if (value > INTEGERS.u64[1]) throw new BodyError('out_of_range', `at most ${INTEGERS.u64[1]}`)
      return value.toString()
    }
    if (!/^-?(?:0|[1-9][0-9]*)(?:\.[0-9]+)?(?:[eE][+-]?[0-9]+)?$/.test(text))
      throw new BodyError('wrong_type', expected)
    return text
  }
  if (!scanner.isNumber() || (form === 'string' && lenientNumber !== true)) throw new BodyError('wrong_type', expected)
  return scanner.number()
}

const DIGITS = /^-?[0-9]{1,15}$/

function readInteger(scanner: Scanner, type: IntegerName, schema: FieldSchema): number | bigint {
  const small = SMALL[type]
  const plain = scanner.plainInteger(isQuoted(scanner, schema))
  if (!Number.isNaN(plain)) {
    if (small ? plain < small[0] || plain > small[1] : plain < 0 && type === 'u64') {
      throw new BodyError('out_of_range', `${INTEGERS[type][0]} … ${INTEGERS[type][1]}`)
    }
    return small || schema.safe === true ? plain : BigInt(plain)
  }
  const text = numberText(scanner, type, schema)
  if (small && DIGITS.test(text)) {
    const value = Number(text)
    if (value < small[0] || value > small[1]) throw new BodyError('out_of_range', `${small[0]} … ${small[1]}`)
    // Turns minus zero into zero.
    return value + 0
  }
  const exact = integral(text)
  if (exact === null) throw new BodyError('wrong_type', type)
  const [least, most] = INTEGERS[type]
  if (exact < least || exact > most) throw new BodyError('out_of_range', `${least} … ${most}`)
  if (small) return Number(exact)
  if (schema.safe !== true) return exact
  // The range of the field is checked later. A number outside the safe range could round into it.
  return exact >= Number.MIN_SAFE_INTEGER && exact <= Number.MAX_SAFE_INTEGER ? Number(exact) : exact
}

function readFloat(scanner: Scanner, type: 'f32' | 'f64', schema: FieldSchema): number {
  // A 32-bit fraction is rounded once, from its text.
  const plain = scanner.plainNumber(isQuoted(scanner, schema), type === 'f64')
  const text = Number.isNaN(plain) ? numberText(scanner, type, schema) : null
  const value = text === null ? plain : Number(text)
  const nearest = type === 'f64' ? value : shortFloat(text === null ? value : beforeRounding(text, value))
  if (!Number.isFinite(nearest)) throw new BodyError('out_of_range', type)
  return nearest
}

/**
 * Returns the nearest 32-bit float, as the double with the fewest digits that rounds to it: 0.1, not
 * 0.10000000149011612.
 */
export function shortFloat(value: number): number {
  const nearest = Math.fround(value)
  if (nearest === value || !Number.isFinite(nearest)) return nearest
  for (let digits = 6; digits < 9; digits++) {
    const short = Number(nearest.toPrecision(digits))
    if (Math.fround(short) === nearest) return short
  }
  return Number(nearest.toPrecision(9))
}
