// JSON with places and exact numbers: `JSON.parse` rounds the 64-bit ids of this protocol and does
// not say where a value stands.

import type { ErrorName } from './protocol'

export type Json =
  | { is: 'null'; at: number }
  | { is: 'bool'; at: number; value: boolean }
  /** `text` is the number as written. */
  | { is: 'number'; at: number; text: string }
  /** Halves of surrogate pairs may stand alone in `value`: it is for who reads it to refuse them. */
  | { is: 'string'; at: number; value: string }
  | { is: 'array'; at: number; items: Json[] }
  /** Keys in order; a repeated key stands repeatedly. */
  | { is: 'object'; at: number; entries: { key: string; at: number; value: Json }[] }

/** What is wrong with a JSON text, and at which character. */
export class JsonFault extends Error {
  constructor(
    readonly fault: ErrorName,
    readonly at: number,
    message: string,
  ) {
    super(message)
  }
}

const NUMBER = /-?(?:0|[1-9][0-9]*)(?:\.[0-9]+)?(?:[eE][+-]?[0-9]+)?/y
const PLAIN = /[^"\\\u0000-\u001f]+/y
const ESCAPES: Record<string, string> = {
  '"': '"', '\\': '\\', '/': '/', b: '\b', f: '\f', n: '\n', r: '\r', t: '\t',
}

/** Whether half of a surrogate pair stands alone in it. */
export const hasLoneSurrogate = (text: string): boolean => /\p{Surrogate}/u.test(text)

/** Digits that no integer type of the spec has, by far. */
const MANY_DIGITS = 40

/** The integer that a JSON number amounts to, exactly: `1.0` and `1e2` are integers. `null` for a fraction. What is
 * far beyond any type comes out as some number that is, too. */
export function integral(number: string): bigint | null {
  const [, minus, whole, part = '', exponent = '0'] = /^(-?)(\d+)(?:\.(\d+))?(?:[eE](.+))?$/.exec(number)!
  const digits = (whole + part).replace(/^0+/, '').replace(/0+$/, '')
  if (digits === '') return 0n
  const zeros = (whole + part).match(/0*$/)![0].length
  const power = Number(exponent) - part.length + zeros
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
    while (at < text.length && ' \t\n\r'.includes(text[at])) at++
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
      const escape = text[at++]
      if (escape === 'u') {
        value += String.fromCharCode(hexEscape())
      } else if (escape in ESCAPES) value += ESCAPES[escape]
      else bad('unknown escape')
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
  return text.replace(/("(?:[^"\\]|\\.)*")|\s+/g, (_, string) => string ?? '')
}

/** Indents JSON without parsing numbers, which would round 64-bit ids. */
export function indent(text: string): string {
  let depth = 0
  const line = () => '\n' + '  '.repeat(depth)
  return text.replace(/("(?:[^"\\]|\\.)*")|\s+|([{[])(?:\s*([}\]]))?|([}\]])|(,)|(:)/g, (_, string, open, shut, close, comma, colon) => {
    if (string !== undefined) return string
    if (open) {
      if (shut) return open + shut
      depth++
      return open + line()
    }
    if (close) {
      depth--
      return line() + close
    }
    if (comma) return ',' + line()
    return colon ? ': ' : ''
  })
}

/** The text without comments outside strings, `null` if it has none. */
export function withoutComments(text: string): string | null {
  let found = false
  const bare = text.replace(/("(?:[^"\\\n]|\\.)*")|[ \t]*\/\/[^\n]*|[ \t]*\/\*[^]*?\*\//g, (_, string) => {
    if (string !== undefined) return string
    found = true
    return ''
  })
  return found ? bare : null
}
