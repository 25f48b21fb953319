// Bodies: JSON text against the types of the spec.

import type { ErrorName } from './errors.ts'
import { beforeRounding } from './floats.ts'
import { JsonFault, hasLoneSurrogate, integral, parseJson } from './json.ts'
import type { Json, JsonObject } from './json.ts'
import type { Field, IntName, Operation, Protocol, Side, Type } from './protocol.ts'

/** What breaks the spec, where, and in words of numbers and names only. */
export interface BodyFault {
  /** What is wrong. */
  name: ErrorName
  /** Wire keys down to the place, such as `data.stations[3].x`. */
  path: string
  /** Character in the text. */
  at: number
  /** What the spec asks for. */
  expected: string
}

/** A key or enum value that the spec does not know. */
export interface UnknownPlace {
  /** Wire keys down to the place. */
  path: string
  /** Character in the text. */
  at: number
}

/** What was found in a body. */
export interface BodyReport {
  /** The body as text. */
  text: string
  /** The text as JSON, `null` if it is none. */
  json: Json | null
  /** What breaks the spec, in the order of the text; a missing key counts at the end of its object. */
  faults: BodyFault[]
  /** Keys and enum values that the spec does not know: kept, not faults. */
  unknown: UnknownPlace[]
  /** The result code of a response, if it has one. */
  resultCode: string | null
}

const INT_BITS: Record<IntName, [bigint, bigint]> = {
  i8: [-(2n ** 7n), 2n ** 7n - 1n],
  i16: [-(2n ** 15n), 2n ** 15n - 1n],
  i32: [-(2n ** 31n), 2n ** 31n - 1n],
  i64: [-(2n ** 63n), 2n ** 63n - 1n],
  u8: [0n, 2n ** 8n - 1n],
  u16: [0n, 2n ** 16n - 1n],
  u32: [0n, 2n ** 32n - 1n],
  u64: [0n, 2n ** 64n - 1n],
}

const isInt = (name: string): name is IntName => name in INT_BITS

/** Characters of a text, of which some are two units of UTF-16. */
function characters(text: string): number {
  let count = 0
  for (const _ of text) count++
  return count
}

/** Whether a text matches. One that is too long for the stack of regular expressions does not. */
function matches(pattern: RegExp, text: string): boolean {
  try {
    return pattern.test(text)
  } catch (problem) {
    if (!(problem instanceof RangeError)) throw problem
    return false
  }
}

/** Reads a body's text. `operation` may be `null` for a code the spec does not know: then only JSON is checked. */
export function readBody(protocol: Protocol, operation: Operation | null, side: Side, data: Uint8Array): BodyReport {
  const report: BodyReport = { text: '', json: null, faults: [], unknown: [], resultCode: null }
  const fault = (name: ErrorName, path: string, at: number, expected: string) => {
    report.faults.push({ name, path, at, expected })
  }
  try {
    report.text = new TextDecoder('utf-8', { fatal: true, ignoreBOM: true }).decode(data)
  } catch {
    report.text = new TextDecoder().decode(data)
    fault('not_utf8', '', 0, 'UTF-8')
    return report
  }
  // An empty data area stands for an object without keys.
  try {
    report.json =
      data.length === 0 ? { is: 'object', at: 0, entries: [] } : parseJson(report.text, protocol.limits.jsonDepth)
  } catch (problem) {
    if (!(problem instanceof JsonFault)) throw problem
    fault(problem.fault, '', problem.at, problem.message)
    return report
  }
  if (report.json.is !== 'object') {
    fault('not_an_object', '', report.json.at, '{ … }')
    return report
  }

  const structFields = (name: string): Field[] => {
    const type = protocol.types[name]
    return type?.is === 'struct' ? type.fields : []
  }

  function object(fields: Field[], json: JsonObject, path: string): void {
    const missing = new Set(fields.filter((field) => !field.optional))
    const seen = new Set<Field>()
    for (const { key, at, value: entry } of json.entries) {
      const inner = path ? `${path}.${key}` : key
      if (hasLoneSurrogate(key)) {
        fault('lone_surrogate', path, at, 'Unicode')
        continue
      }
      const field = fields.find((candidate) => candidate.key === key || candidate.also.includes(key))
      if (!field) {
        report.unknown.push({ path: inner, at })
        continue
      }
      if (seen.has(field)) {
        fault('duplicate_key', inner, entry.at, field.key)
        continue
      }
      seen.add(field)
      missing.delete(field)
      const empty =
        entry.is === 'null' ||
        (field.emptyIsAbsent &&
          ((entry.is === 'object' && entry.entries.length === 0) ||
            (entry.is === 'array' && entry.items.length === 0) ||
            (entry.is === 'string' && entry.value === '')))
      if (field.optional && empty) continue
      value(field.type, field, entry, inner)
    }
    for (const field of missing) fault('missing_field', path ? `${path}.${field.key}` : field.key, json.at, field.key)
  }

  function value(type: Type, field: Field, json: Json, path: string): void {
    const wrong = (expected: string) => fault('wrong_type', path, json.at, expected)
    if (lone(type, json, path)) return
    if (type.is === 'array') {
      if (json.is !== 'array') return wrong('[ … ]')
      length(field, json.items.length, json, path)
      json.items.forEach((item, index) => value(type.of, { ...field, length: null }, item, `${path}[${index}]`))
    } else if (type.is === 'named') named(type.name, field, json, path)
    else if (type.is === 'json') return
    else if (type.is === 'bool') {
      if (!isBool(field, json))
        wrong(field.wireString ? '"true" | "false"' : field.wireNumber ? '0 | 1' : 'true | false')
    } else if (type.is === 'string') {
      if (json.is !== 'string') return wrong('" … "')
      length(field, characters(json.value), json, path)
      if (field.pattern !== null && !matches(new RegExp(`^(?:${field.pattern})$`, 'u'), json.value)) {
        fault('bad_pattern', path, json.at, field.pattern)
      }
    } else if (type.is === 'base64') {
      if (json.is !== 'string') return wrong('base64')
      const padding = json.value.endsWith('==') ? 2 : json.value.endsWith('=') ? 1 : 0
      const digits = json.value.length - padding
      // The last digits before padding, without bits that no byte takes.
      const last = padding === 2 ? 'AQgw' : 'AEIMQUYcgkosw048'
      const whole = padding === 0 || last.includes(json.value.charAt(digits - 1))
      if (json.value.length % 4 !== 0 || !whole || /[^A-Za-z0-9+/]/.test(json.value.slice(0, digits))) {
        fault('bad_base64', path, json.at, 'RFC 4648')
      } else length(field, Math.floor((digits * 3) / 4), json, path)
    } else number(type.is, field, json, path)
  }

  /** Whether a value is a bool in the form of its field, or in one that its field takes as well. */
  function isBool(field: Field, json: Json): boolean {
    if (json.is === 'bool') return field.lenientBool || !(field.wireString || field.wireNumber)
    if (json.is === 'string') return (field.lenientBool || field.wireString) && ['true', 'false'].includes(json.value)
    if (json.is === 'number')
      return (field.lenientBool || field.wireNumber === true) && ['0', '1'].includes(String(integral(json.text)))
    return false
  }

  /** Half a surrogate pair is no text, whatever the field would make of it. */
  function lone(type: Type, json: Json, path: string): boolean {
    const found = type.is !== 'json' && json.is === 'string' && hasLoneSurrogate(json.value)
    if (found) fault('lone_surrogate', path, json.at, 'Unicode')
    return found
  }

  function number(name: string, field: Field, json: Json, path: string): void {
    let text: string
    if (json.is === 'number' && (!field.wireString || field.lenientNumber)) text = json.text
    else if (json.is === 'string' && (field.wireString || field.lenientNumber)) text = json.value
    else return fault('wrong_type', path, json.at, field.wireString ? `"${name}"` : name)
    if (field.lenientNumber && /^0[xX][0-9a-fA-F]+$/.test(text)) {
      const whole = BigInt(text)
      if (whole > INT_BITS.u64[1]) return fault('out_of_range', path, json.at, `0 … ${INT_BITS.u64[1]}`)
      text = whole.toString()
    }
    if (!/^-?(0|[1-9][0-9]*)(\.[0-9]+)?([eE][+-]?[0-9]+)?$/.test(text)) return fault('wrong_type', path, json.at, name)
    if (isInt(name)) {
      const exact = integral(text)
      if (exact === null) return fault('wrong_type', path, json.at, name)
      const [low, high] = INT_BITS[name]
      if (exact < low || exact > high) return fault('out_of_range', path, json.at, `${low} … ${high}`)
      if ((field.min !== null && exact < BigInt(field.min)) || (field.max !== null && exact > BigInt(field.max))) {
        fault('out_of_range', path, json.at, `${field.min ?? low} … ${field.max ?? high}`)
      }
    } else {
      const rounded = Number(text)
      const finite = Number.isFinite(name === 'f32' ? Math.fround(beforeRounding(text, rounded)) : rounded)
      const inside =
        (field.min === null || rounded >= Number(field.min)) && (field.max === null || rounded <= Number(field.max))
      if (!finite || !inside) fault('out_of_range', path, json.at, `${field.min ?? '−∞'} … ${field.max ?? '∞'}`)
    }
  }

  function length(field: Field, found: number, json: Json, path: string): void {
    if (!field.length) return
    const [low, high] = field.length
    if (found < low || found > high) fault('bad_length', path, json.at, low === high ? String(low) : `${low} … ${high}`)
  }

  function named(name: string, field: Field, json: Json, path: string): void {
    const type = protocol.types[name]
    if (!type) throw new Error(`the protocol has no type ${name}`)
    if (type.is === 'enum') {
      if (type.repr === 'string') {
        if (json.is !== 'string') return fault('wrong_type', path, json.at, '" … "')
      } else {
        const before = report.faults.length
        number(type.repr, field, json, path)
        if (report.faults.length > before) return
      }
      const text = json.is === 'number' ? String(integral(json.text)) : json.is === 'string' ? json.value : ''
      const known = type.values.some(({ wire }) => wire === text)
      if (field.only && (known || !type.closed)) {
        if (!field.only.includes(text)) fault('out_of_range', path, json.at, field.only.join(' | '))
      } else if (known) return
      else if (type.closed) fault('unknown_value', path, json.at, type.values.map(({ wire }) => wire).join(' | '))
      else report.unknown.push({ path, at: json.at })
      return
    }
    if (json.is !== 'object') return fault('wrong_type', path, json.at, '{ … }')
    if (type.is === 'struct') return object(type.fields, json, path)
    const keys = new Set(json.entries.map(({ key }) => key))
    const variant = type.variants.find((candidate) =>
      structFields(candidate.type).every(
        (need) => need.optional || keys.has(need.key) || need.also.some((also) => keys.has(also)),
      ),
    )
    if (variant) object(structFields(variant.type), json, path)
    else fault('no_variant', path, json.at, type.variants.map(({ name }) => name).join(' | '))
  }

  // The frame of a stream carries its own keys alone.
  const envelope = operation?.kind === 'stream' ? [] : protocol.envelope[side]
  const own = operation && (side === 'request' ? operation.request : operation.response)
  object([...envelope, ...(own ? structFields(own) : [])], report.json, '')

  const roles = protocol.results.find(({ role }) => role === 'success')
  const codeKey = side === 'response' ? protocol.resultCodeKey : null
  const last = report.json.entries.filter(({ key }) => key === codeKey).at(-1)?.value
  report.resultCode = last?.is === 'number' ? String(integral(last.text) ?? last.text) : null
  // A refusal carries the envelope and nothing else.
  if (report.resultCode !== null && report.resultCode !== String(roles?.code)) {
    const names = new Set(envelope.map(({ key }) => key))
    report.faults = report.faults.filter(({ path }) => names.has(path))
  }
  return report
}
