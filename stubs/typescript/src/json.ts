// JSON with places and exact numbers: `JSON.parse` rounds the 64-bit ids of this protocol and does
// not say where a value begins.

import type { ErrorName } from './errors.ts'

/** `null`. */
export interface JsonNull {
  /** Always this word. */
  is: 'null'
  /** Character in the text. */
  at: number
}

/** `true` or `false`. */
export interface JsonBool {
  /** Always this word. */
  is: 'bool'
  /** Character in the text. */
  at: number
  /** Which of them. */
  value: boolean
}

/** A number. */
export interface JsonNumber {
  /** Always this word. */
  is: 'number'
  /** Character in the text. */
  at: number
  /** The number as written. */
  text: string
}

/** A string. */
export interface JsonString {
  /** Always this word. */
  is: 'string'
  /** Character in the text. */
  at: number
  /** Its text. It may have half of a surrogate pair without the other, which its reader has to refuse. */
  value: string
}

/** A list. */
export interface JsonArray {
  /** Always this word. */
  is: 'array'
  /** Character in the text. */
  at: number
  /** Its items. */
  items: Json[]
}

/** A key with its value. */
export interface JsonEntry {
  /** The key. */
  key: string
  /** Character of the key in the text. */
  at: number
  /** The value. */
  value: Json
}

/** An object. */
export interface JsonObject {
  /** Always this word. */
  is: 'object'
  /** Character in the text. */
  at: number
  /** In order; a repeated key is there repeatedly. */
  entries: JsonEntry[]
}

/** A JSON value, its place and its numbers as they were written. */
export type Json = JsonNull | JsonBool | JsonNumber | JsonString | JsonArray | JsonObject

/** What can be wrong with a JSON text. */
export type JsonFaultName = Extract<ErrorName, 'bad_json' | 'too_deep'>

/** What is wrong with a JSON text, and at which character. */
export class JsonFault extends Error {
  /** What is wrong. */
  readonly fault: JsonFaultName
  /** Character in the text. */
  readonly at: number

  /** `message` says what was expected. */
  constructor(fault: JsonFaultName, at: number, message: string) {
    super(message)
    this.fault = fault
    this.at = at
  }
}

const WHITE = ' \t\n\r'
const NUMBER = /-?(?:0|[1-9][0-9]*)(?:\.[0-9]+)?(?:[eE][+-]?[0-9]+)?/y
const PLAIN = /[^"\\\u0000-\u001f]+/y
const ESCAPES: ReadonlyMap<string, string> = new Map([
  ['"', '"'],
  ['\\', '\\'],
  ['/', '/'],
  ['b', '\b'],
  ['f', '\f'],
  ['n', '\n'],
  ['r', '\r'],
  ['t', '\t'],
])

/** What newer platforms have of their own. */
const { isWellFormed } = String.prototype as { isWellFormed?: (this: string) => boolean }

/** Whether it has half of a surrogate pair without the other. */
export const hasLoneSurrogate = (text: string): boolean =>
  isWellFormed ? !isWellFormed.call(text) : /\p{Surrogate}/u.test(text)

/** Digits that no integer type of the spec has, by far. */
const MANY_DIGITS = 40

/** The integer that a JSON number amounts to, exactly: `1.0` and `1e2` are integers. `null` for a fraction, and for what is
 * not a number. What is far beyond any type comes out as some number that is, too. */
export function integral(number: string): bigint | null {
  const found = /^(-?)(\d+)(?:\.(\d+))?(?:[eE]([+-]?\d+))?$/.exec(number)
  if (!found) return null
  const [, minus, whole = '', part = '', exponent = '0'] = found
  const all = (whole + part).replace(/^0+/, '')
  if (all === '') return 0n
  let end = all.length
  // No regular expression: from each zero on it would look for the end again.
  while (all[end - 1] === '0') end--
  const digits = all.slice(0, end)
  const power = Number(exponent) - part.length + all.length - end
  if (power < 0) return null
  const exact = digits.length + power > MANY_DIGITS ? 10n ** BigInt(MANY_DIGITS) : BigInt(digits) * 10n ** BigInt(power)
  return minus ? -exact : exact
}

/** Parses one JSON value that fills the text. Throws `JsonFault`. */
export function parseJson(text: string, maxDepth: number): Json {
  let at = 0

  const bad = (message: string): never => {
    throw new JsonFault('bad_json', at, message)
  }
  const space = () => {
    while (at < text.length && WHITE.includes(text.charAt(at))) at++
  }
  const expect = (character: string) => {
    if (text[at] !== character) bad(`expected ${character}`)
    at++
  }

  function hexEscape(): number {
    const digits = text.slice(at, at + 4)
    if (!/^[0-9a-fA-F]{4}$/.test(digits)) bad('expected four hex digits')
    at += 4
    return Number.parseInt(digits, 16)
  }

  function string(): string {
    expect('"')
    let value = ''
    for (;;) {
      PLAIN.lastIndex = at
      const run = PLAIN.exec(text)
      if (run) {
        value += run[0]
        at += run[0].length
      }
      const next = text[at]
      if (next === '"') {
        at++
        return value
      }
      if (next !== '\\') bad(next === undefined ? 'the string does not end' : 'control character in a string')
      at++
      const escape = text.charAt(at++)
      value += escape === 'u' ? String.fromCharCode(hexEscape()) : (ESCAPES.get(escape) ?? bad('unknown escape'))
    }
  }

  function nested<T>(depth: number, close: string, item: () => T): T[] {
    if (depth > maxDepth) throw new JsonFault('too_deep', at, `more than ${maxDepth} levels`)
    at++
    const items: T[] = []
    space()
    if (text[at] === close) {
      at++
      return items
    }
    for (;;) {
      items.push(item())
      space()
      if (text[at] === close) {
        at++
        return items
      }
      expect(',')
      space()
    }
  }

  function value(depth: number): Json {
    space()
    const start = at
    switch (text[at]) {
      case '{':
        return {
          is: 'object',
          at: start,
          entries: nested(depth + 1, '}', () => {
            space()
            const keyAt = at
            const key = string()
            space()
            expect(':')
            return { key, at: keyAt, value: value(depth + 1) }
          }),
        }
      case '[':
        return { is: 'array', at: start, items: nested(depth + 1, ']', () => value(depth + 1)) }
      case '"':
        return { is: 'string', at: start, value: string() }
    }
    for (const [word, made] of [
      ['null', { is: 'null', at: start }],
      ['true', { is: 'bool', at: start, value: true }],
      ['false', { is: 'bool', at: start, value: false }],
    ] as [string, Json][]) {
      if (text.startsWith(word, at)) {
        at += word.length
        return made
      }
    }
    NUMBER.lastIndex = at
    const number = NUMBER.exec(text)
    if (!number) return bad('expected a value')
    at += number[0].length
    return { is: 'number', at: start, text: number[0] }
  }

  const result = value(0)
  space()
  if (at < text.length) bad('text after the value')
  return result
}

/** Drops white space outside strings, and touches nothing else: numbers keep their spelling. What is not JSON stays as it is. */
export function compact(text: string, maxDepth: number): string {
  try {
    parseJson(text, maxDepth)
  } catch (problem) {
    if (!(problem instanceof JsonFault)) throw problem
    return text
  }
  // No regular expression: one for strings with escapes fills the stack where there are millions of these.
  let bare = ''
  let from = 0
  let quoted = false
  for (let at = 0; at < text.length; at++) {
    const character = text.charAt(at)
    if (character === '"') quoted = !quoted
    else if (quoted && character === '\\') at++
    else if (!quoted && WHITE.includes(character)) {
      bare += text.slice(from, at)
      from = at + 1
    }
  }
  return bare + text.slice(from)
}
