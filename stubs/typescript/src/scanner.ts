// JSON, read from left to right: the grammar, and nothing of types.
//
// What steers are the bytes, since looking at one costs a fraction of looking at a character. Strings are cut out of a text
// that has a character for each byte; those that are not ASCII are decoded by themselves, and checked then.

import { decoded, isAscii, oneForEach } from './characters.ts'
import { BodyError } from './fault.ts'
import type { Findings } from './fault.ts'
import { hasLoneSurrogate } from './json.ts'

/** What reading one body may cost. */
export interface Allowance {
  /** Levels of nesting. */
  readonly depth: number
  /** Keys of objects and items of lists, those of all levels together. */
  readonly values: number
}

/** More than a text can have, and still a small integer: the fastest there are. */
const COUNTLESS = 2 ** 30 - 1

/** Any cost, for a text that has been read within its allowance before. */
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
/** What comes behind the last byte. */
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

/** Strings up to this length are looked at byte by byte, which is faster than to begin with an expression. */
const SHORT = 64

/** Numbers of so many digits are exact as they are, and so are the powers of ten that their fractions are of. */
const EXACT = 15
const TENS = Array.from({ length: EXACT + 1 }, (_, power) => 10 ** power)

/**
 * A place in a JSON text. Each method that reads a value skips the white space in front of it, stops right behind it, and
 * throws a `BodyError` where the text is not what it has to be.
 */
export class Scanner {
  /** Bytes read. */
  at: number
  /** Levels that may still be entered. */
  depth: number
  /** Takes errors where the reader goes on behind them; `null` where it stops at the first. */
  readonly findings: Findings | null
  private readonly bytes: Uint8Array
  private readonly end: number
  /** A character for each byte. */
  private readonly text: string
  private values: number
  /** The string that has been read last has an escape. */
  private escaped = false

  /** A place at the start of a text. */
  constructor(bytes: Uint8Array, allowance: Allowance, findings: Findings | null = null) {
    this.at = 0
    this.findings = findings
    this.bytes = bytes
    this.end = bytes.length
    this.text = oneForEach(bytes)
    this.depth = Math.min(allowance.depth, COUNTLESS)
    this.values = Math.min(allowance.values, COUNTLESS)
  }

  /** The byte at a place; `END` behind the last. */
  private byte(at: number): number {
    return at < this.end ? (this.bytes[at] ?? END) : END
  }

  /** Skips white space and gives the next byte; a negative number at the end. */
  peek(): number {
    for (;;) {
      const code = this.byte(this.at)
      if (code > SPACE || (code !== SPACE && code !== 0x0a && code !== 0x0d && code !== 0x09)) return code
      this.at++
    }
  }

  /** Reads these bytes if the text goes on with them. */
  takeBytes(bytes: Uint8Array): boolean {
    const { at } = this
    const { length } = bytes
    if (at + length > this.end) return false
    for (let index = 0; index < length; index++) if (this.bytes[at + index] !== bytes[index]) return false
    this.at = at + length
    return true
  }

  /** Reads `literal` if the text goes on with it. */
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

  /** Whether the next value is a number. */
  isNumber(): boolean {
    const code = this.peek()
    return code === MINUS || (code >= ZERO && code <= NINE)
  }

  /**
   * Reads an integer of few digits, without fraction and exponent, in quotes or without; `NaN`, and nothing read, if that is not
   * what comes.
   */
  plainInteger(quoted: boolean): number {
    const value = this.plainNumber(quoted, false)
    // Minus zero is zero.
    return value === 0 ? 0 : value
  }

  /** The same of a number of few digits, with or without a fraction. */
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
      // Both are exact, and so the quotient is the nearest number there is.
      value /= TENS[behind] ?? Number.NaN
    }
    // A point, an `e` or an `E`: there is more of it.
    if (code === POINT || code === 0x65 || code === 0x45) return Number.NaN
    if (quoted) {
      if (code !== STRING) return Number.NaN
      at++
    }
    this.at = at
    return negative ? -value : value
  }

  /** Reads a number and gives its text. */
  number(): string {
    this.peek()
    NUMBER.lastIndex = this.at
    const found = NUMBER.exec(this.text)
    if (!found) throw this.bad('a number')
    this.at += found[0].length
    return found[0]
  }

  /** Reads a string and gives what it stands for; half of a surrogate pair is no text. */
  string(): string {
    const value = this.rawString()
    // Text from UTF-8 has none by itself: only an escape makes one.
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

  /** Goes to the first byte that does not stand for itself in a string. Whether all up to there are ASCII. */
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

  /** Reads the next value and gives its text. */
  valueText(): string {
    this.peek()
    const start = this.at
    this.skip()
    const text = this.text.slice(start, this.at)
    return isAscii(text) ? text : decoded(this.bytes, start, this.at)
  }

  /** Reads the next value and forgets it. Brackets are counted and not entered, so that no depth fills the stack. */
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

  /** Goes back to the place in front of a value, and skips the value. */
  skipFrom(at: number, depth: number): void {
    this.at = at
    this.depth = depth
    this.skip()
  }

  /** Behind a value: goes to the next one inside the brackets that are open; false if all are closed. */
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

  /** Reads a string and makes nothing of it. */
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

  /** Leaves one at its bracket. */
  leave(): void {
    this.depth++
    this.at++
  }

  /** Reads the closing bracket of what is empty. */
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

  /** Behind a value: whether another one follows before the closing bracket, which is read otherwise. */
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

  /** Nothing but white space may be left. */
  finish(): void {
    if (this.peek() !== END) throw this.bad('nothing behind the value')
  }

  /** Returns the keys of the object at hand and stays in front of it. The keys count, so the search ends at the limits. */
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

  /** The text is no JSON here. */
  bad(expected: string): BodyError {
    return new BodyError('bad_json', expected)
  }
}
