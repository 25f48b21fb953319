// Reads JSON from left to right: only the grammar, no types.
//
// The scanner works on bytes, since reading a byte costs a fraction of reading a character. Strings are cut out of a
// text with one character per byte. Strings that are not ASCII are decoded and checked one at a time.

import { decoded, isAscii, oneForEach } from './characters.ts'
import { BodyError } from './fault.ts'
import type { Findings } from './fault.ts'
import { hasLoneSurrogate } from './json.ts'

/** Limits on reading one body. */
export interface Allowance {
  /** Levels of nesting. */
  readonly depth: number
  /** Keys of objects and items of lists, on all levels together. */
  readonly values: number
}

/** More than a text can have, and still a small integer: the fastest kind. */
const COUNTLESS = 2 ** 30 - 1

/** No limits, for a text already read within its allowance. */
export const ANY: Allowance = { depth: COUNTLESS, values: COUNTLESS }

const SPACE = 0x20
const COMMA = 0x2c
const MINUS = 0x2d
const POINT = 0x2e
const ZERO = 0x30
const NINE = 0x39
const COLON = 0x3a
const BACKSLASH = 0x5c
const DELETE = 0x7f
/** The code after the last byte. */
const END = -1

/** The closing bracket of a list. */
export const CLOSE_LIST = 0x5d
/** The closing bracket of an object. */
export const CLOSE_OBJECT = 0x7d
/** The opening bracket of an object. */
export const OBJECT = 0x7b
/** The opening bracket of a list. */
export const LIST = 0x5b
/** The quote of a string. */
export const STRING = 0x22

const NUMBER = /-?(?:0|[1-9][0-9]*)(?:\.[0-9]+)?(?:[eE][+-]?[0-9]+)?/y
const PLAIN = /[^"\\\u0000-\u001f]*/y
const ESCAPES: Readonly<Record<string, string>> = {
  '"': '"',
  '\\': '\\',
  '/': '/',
  b: '\b',
  f: '\f',
  n: '\n',
  r: '\r',
  t: '\t',
}

/** Strings up to this length are read byte by byte, which is faster than a regular expression. */
const SHORT = 64

/** Numbers of up to this many digits are exact doubles. So are the powers of ten that their fractions need. */
const EXACT = 15
const TENS = Array.from({ length: EXACT + 1 }, (_, power) => 10 ** power)

/**
 * A position in a JSON text. Each method that reads a value first skips white space and stops right after the value. It
 * throws a `BodyError` if the text is invalid there.
 */
export class Scanner {
  /** Bytes read. */
  at: number
  /** Levels that may still be entered. */
  depth: number
  /** Collects errors if the reader continues after them; `null` if it stops at the first. */
  readonly findings: Findings | null
  private readonly bytes: Uint8Array
  private readonly end: number
  /** One character per byte. */
  private readonly text: string
  private values: number
  /** `true` if the last string had an escape. */
  private escaped = false

  /** Creates a scanner at the start of a text. */
  constructor(bytes: Uint8Array, allowance: Allowance, findings: Findings | null = null) {
    this.at = 0
    this.findings = findings
    this.bytes = bytes
    this.end = bytes.length
    this.text = oneForEach(bytes)
    this.depth = Math.min(allowance.depth, COUNTLESS)
    this.values = Math.min(allowance.values, COUNTLESS)
  }

  /** Returns the byte at an index; `END` after the last. */
  private byte(at: number): number {
    return at < this.end ? (this.bytes[at] ?? END) : END
  }

  /** Skips white space and returns the next byte; a negative number at the end. */
  peek(): number {
    for (;;) {
      const code = this.byte(this.at)
      if (code > SPACE || (code !== SPACE && code !== 0x0a && code !== 0x0d && code !== 0x09)) return code
      this.at++
    }
  }

  /** Reads these bytes if they come next. Returns `true` if they do. */
  takeBytes(bytes: Uint8Array): boolean {
    const { at } = this
    const { length } = bytes
    if (at + length > this.end) return false
    for (let index = 0; index < length; index++) if (this.bytes[at + index] !== bytes[index]) return false
    this.at = at + length
    return true
  }

  /** Reads `literal` if it comes next. Returns `true` if it does. */
  take(literal: string): boolean {
    const found = this.text.startsWith(literal, this.at)
    if (found) this.at += literal.length
    return found
  }

  /** Reads `null` if it is the next value. */
  takeNull(): boolean {
    return this.peek() === 0x6e && this.take('null')
  }

  /** Reads `null`, `{}`, `[]` or `""` if it is the next value. */
  takeEmpty(): boolean {
    if (this.takeNull()) return true
    const open = this.peek()
    const start = this.at
    const close = open === OBJECT ? CLOSE_OBJECT : open === LIST ? CLOSE_LIST : open === STRING ? STRING : null
    if (close !== null) {
      this.at++
      const next = open === STRING ? this.byte(this.at) : this.peek()
      if (next === close) {
        this.at++
        return true
      }
    }
    this.at = start
    return false
  }

  /** Returns `true` if the next value is a number. */
  isNumber(): boolean {
    const code = this.peek()
    return code === MINUS || (code >= ZERO && code <= NINE)
  }

  /**
   * Reads an integer of few digits without fraction or exponent, in quotes if `quoted`. Otherwise returns `NaN` and
   * reads nothing.
   */
  plainInteger(quoted: boolean): number {
    const value = this.plainNumber(quoted, false)
    // Minus zero is zero.
    return value === 0 ? 0 : value
  }

  /** Reads a number of few digits, with or without a fraction. Otherwise returns `NaN`. */
  plainNumber(quoted: boolean, fraction: boolean = true): number {
    let code = this.peek()
    let { at } = this
    if (quoted) {
      if (code !== STRING) return Number.NaN
      code = this.byte(++at)
    }
    const negative = code === MINUS
    if (negative) code = this.byte(++at)
    const start = at
    let value = 0
    while (code >= ZERO && code <= NINE) {
      value = value * 10 + (code - ZERO)
      code = this.byte(++at)
    }
    let digits = at - start
    if (digits === 0 || digits > EXACT || (digits > 1 && this.bytes[start] === ZERO)) return Number.NaN
    if (fraction && code === POINT) {
      const point = at
      code = this.byte(++at)
      while (code >= ZERO && code <= NINE) {
        value = value * 10 + (code - ZERO)
        code = this.byte(++at)
      }
      const behind = at - point - 1
      digits += behind
      if (behind === 0 || digits > EXACT) return Number.NaN
      // Both are exact, so the quotient is the nearest double.
      value /= TENS[behind] ?? Number.NaN
    }
    // A point, an `e` or an `E` means that the number continues.
    if (code === POINT || code === 0x65 || code === 0x45) return Number.NaN
    if (quoted) {
      if (code !== STRING) return Number.NaN
      at++
    }
    this.at = at
    return negative ? -value : value
  }

  /** Reads a number and returns its text. */
  number(): string {
    this.peek()
    NUMBER.lastIndex = this.at
    const found = NUMBER.exec(this.text)
    if (!found) throw this.bad('a number')
    this.at += found[0].length
    return found[0]
  }

  /** Reads a string and returns its value. Half of a surrogate pair is an error. */
  string(): string {
    const value = this.rawString()
    // Decoded UTF-8 has none: only an escape can make one.
    if (this.escaped && hasLoneSurrogate(value)) throw new BodyError('lone_surrogate', 'Unicode')
    return value
  }

  private rawString(): string {
    if (this.peek() !== STRING) throw this.bad('a string')
    this.escaped = false
    let value = ''
    let start = ++this.at
    for (;;) {
      const ascii = this.toPlainEnd()
      const code = this.byte(this.at)
      if (code !== STRING && code !== BACKSLASH) throw this.bad('the end of a string')
      const run = ascii ? this.text.slice(start, this.at) : decoded(this.bytes, start, this.at)
      if (code === STRING) {
        this.at++
        return value === '' ? run : value + run
      }
      value += run
      value += this.escape()
      this.escaped = true
      start = this.at
    }
  }

  /** Advances to the first byte that needs decoding in a string. Returns `true` if all bytes up to there are ASCII. */
  private toPlainEnd(): boolean {
    const { bytes } = this
    const start = this.at
    const limit = Math.min(start + SHORT, this.end)
    let all = 0
    let at = start
    for (; at < limit; at++) {
      const code = bytes[at] ?? 0
      if (code === STRING || code === BACKSLASH || code < SPACE) {
        this.at = at
        return all <= DELETE
      }
      all |= code
    }
    PLAIN.lastIndex = at
    PLAIN.exec(this.text)
    this.at = PLAIN.lastIndex
    return all <= DELETE && isAscii(this.text.slice(at, this.at))
  }

  /** Reads an escape at its backslash. */
  private escape(): string {
    const letter = this.text.charAt(this.at + 1)
    if (letter === 'u') {
      const digits = this.text.slice(this.at + 2, this.at + 6)
      if (!/^[0-9a-fA-F]{4}$/.test(digits)) throw this.bad('four hex digits')
      this.at += 6
      return String.fromCharCode(Number.parseInt(digits, 16))
    }
    const stands = ESCAPES[letter]
    if (stands === undefined) throw this.bad('an escape')
    this.at += 2
    return stands
  }

  /** Reads the next value and returns its text. */
  valueText(): string {
    this.peek()
    const start = this.at
    this.skip()
    const text = this.text.slice(start, this.at)
    return isAscii(text) ? text : decoded(this.bytes, start, this.at)
  }

  /** Skips the next value. Brackets are counted without recursion, so that no depth overflows the stack. */
  skip(): void {
    const closing: number[] = []
    for (;;) {
      const code = this.peek()
      if (code === OBJECT || code === LIST) {
        this.enter()
        const close = code === OBJECT ? CLOSE_OBJECT : CLOSE_LIST
        if (this.peek() !== close) {
          closing.push(close)
          if (close === CLOSE_OBJECT) this.skipKey()
          this.count(1)
          continue
        }
        this.leave()
      } else this.skipScalar(code)
      if (!this.toNextValue(closing)) return
    }
  }

  /** Returns to the place before a value, and skips the value. */
  skipFrom(at: number, depth: number): void {
    this.at = at
    this.depth = depth
    this.skip()
  }

  /** Moves from the end of a value to the next value inside the open brackets. Returns `false` if all are closed. */
  private toNextValue(closing: number[]): boolean {
    for (;;) {
      const close = closing.at(-1)
      if (close === undefined) return false
      const code = this.peek()
      if (code === COMMA) {
        this.at++
        if (close === CLOSE_OBJECT) this.skipKey()
        this.count(1)
        return true
      }
      if (code !== close) throw this.bad('a comma or a closing bracket')
      this.leave()
      closing.pop()
    }
  }

  private skipScalar(code: number): void {
    if (code === STRING) this.skipString()
    else if (code === MINUS || (code >= ZERO && code <= NINE)) this.number()
    else if (!this.take('true') && !this.take('false') && !this.take('null')) throw this.bad('a value')
  }

  private skipKey(): void {
    this.skipString()
    this.colon()
  }

  /** Skips a string. */
  private skipString(): void {
    if (this.peek() !== STRING) throw this.bad('a string')
    this.at++
    for (;;) {
      this.toPlainEnd()
      const code = this.byte(this.at)
      if (code === STRING) break
      if (code !== BACKSLASH) throw this.bad('the end of a string')
      this.escape()
    }
    this.at++
  }

  /** Enters an object or a list at its bracket. */
  enter(): void {
    if (--this.depth < 0) throw new BodyError('too_deep', 'fewer levels')
    this.at++
  }

  /** Leaves an object or a list after its bracket. */
  leave(): void {
    this.depth++
    this.at++
  }

  /** Reads the closing bracket if the object or list is empty. Returns `true` if it did. */
  endsAtOnce(close: number): boolean {
    const ends = this.peek() === close
    if (ends) this.leave()
    return ends
  }

  /** Reads a key and its colon. */
  key(): string {
    const key = this.string()
    this.colon()
    return key
  }

  private colon(): void {
    if (this.peek() !== COLON) throw this.bad('a colon')
    this.at++
  }

  /** Returns `true` if another item follows. Otherwise reads the closing bracket. */
  goesOn(close: number): boolean {
    const code = this.peek()
    if (code === COMMA) {
      this.at++
      return true
    }
    if (code !== close) throw this.bad('a comma or a closing bracket')
    this.leave()
    return false
  }

  /** Counts a key or an item. */
  count(values: number): void {
    this.values -= values
    if (this.values < 0) throw new BodyError('too_many_values', 'fewer keys and items')
  }

  /** Checks that only white space is left. */
  finish(): void {
    if (this.peek() !== END) throw this.bad('nothing behind the value')
  }

  /**
   * Returns the keys of the present object without moving. The keys count towards the limits, which bounds the search.
   */
  keysAhead(): Set<string> {
    const { at, depth, values } = this
    const keys = new Set<string>()
    this.enter()
    if (!this.endsAtOnce(CLOSE_OBJECT)) {
      do {
        this.count(1)
        keys.add(this.key())
        this.skip()
      } while (this.goesOn(CLOSE_OBJECT))
    }
    this.at = at
    this.depth = depth
    this.values = values
    return keys
  }

  /** Returns the error for invalid JSON at this place. */
  bad(expected: string): BodyError {
    return new BodyError('bad_json', expected)
  }
}
