// JSON text, read from left to right: the grammar, and nothing of types.

import { BodyError } from './fault.ts'
import { hasLoneSurrogate } from './json.ts'

/** What reading one body may cost. */
export interface Allowance {
  /** Levels of nesting. */
  readonly depth: number
  /** Keys of objects and items of lists, those of all levels together. */
  readonly values: number
}

/** Any cost, for a text that has been read within its allowance before. */
export const ANY: Allowance = { depth: Number.POSITIVE_INFINITY, values: Number.POSITIVE_INFINITY }

const SPACE = 0x20
const COMMA = 0x2c
const MINUS = 0x2d
const ZERO = 0x30
const NINE = 0x39
const COLON = 0x3a
const BACKSLASH = 0x5c
const CLOSE_LIST = 0x5d
const CLOSE_OBJECT = 0x7d

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

/** Strings up to this length are looked at character by character, which is faster than to begin with an expression. */
const SHORT = 64

/**
 * A place in a JSON text. Each method that reads a value skips the white space in front of it, stops right behind it, and
 * throws a `BodyError` where the text is not what it has to be.
 */
export class Scanner {
  /** The text. */
  readonly text: string
  /** Characters read. */
  at: number
  private depth: number
  private values: number

  /** A place at the start of a text. */
  constructor(text: string, allowance: Allowance, at: number = 0) {
    this.text = text
    this.at = at
    this.depth = allowance.depth
    this.values = allowance.values
  }

  /** Skips white space and gives the next character's code; `NaN` at the end. */
  peek(): number {
    for (;;) {
      const code = this.text.charCodeAt(this.at)
      if (code !== SPACE && code !== 0x0a && code !== 0x0d && code !== 0x09) return code
      this.at++
    }
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
    const start = this.at
    const open = this.peek()
    const close = open === OBJECT ? CLOSE_OBJECT : open === LIST ? CLOSE_LIST : open === STRING ? STRING : null
    if (close !== null) {
      this.at++
      const next = open === STRING ? this.text.charCodeAt(this.at) : this.peek()
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

  /** Reads an integer of few digits, without fraction and exponent; `NaN`, and nothing read, if that is not what comes. */
  plainInteger(): number {
    const { text } = this
    const first = this.peek()
    let at = first === MINUS ? this.at + 1 : this.at
    const start = at
    let value = 0
    let code = text.charCodeAt(at)
    while (code >= ZERO && code <= NINE) {
      value = value * 10 + (code - ZERO)
      code = text.charCodeAt(++at)
    }
    const digits = at - start
    const leads = digits > 1 && text.charCodeAt(start) === ZERO
    // A point, an `e` or an `E`: there is more of it.
    if (digits === 0 || digits > 15 || leads || code === 0x2e || code === 0x65 || code === 0x45) return Number.NaN
    this.at = at
    // Minus zero is zero.
    return first === MINUS && value !== 0 ? -value : value
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

  private escaped = false

  private rawString(): string {
    if (this.peek() !== STRING) throw this.bad('a string')
    const { text } = this
    this.escaped = false
    let value = ''
    let start = ++this.at
    for (;;) {
      this.toPlainEnd()
      const code = text.charCodeAt(this.at)
      if (code === STRING) {
        const run = text.slice(start, this.at++)
        return value === '' ? run : value + run
      }
      if (code !== BACKSLASH) throw this.bad('the end of a string')
      value += text.slice(start, this.at)
      value += this.escape()
      this.escaped = true
      start = this.at
    }
  }

  /** Goes to the first character that does not stand for itself in a string. */
  private toPlainEnd(): void {
    const { text } = this
    const limit = this.at + SHORT
    while (this.at < limit) {
      const code = text.charCodeAt(this.at)
      // Also at the end of the text, where there is no code.
      if (code === STRING || code === BACKSLASH || !(code >= SPACE)) return
      this.at++
    }
    PLAIN.lastIndex = this.at
    PLAIN.exec(text)
    this.at = PLAIN.lastIndex
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
    return this.text.slice(start, this.at)
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
    if (code === STRING) this.rawString()
    else if (code === MINUS || (code >= ZERO && code <= NINE)) this.number()
    else if (!this.take('true') && !this.take('false') && !this.take('null')) throw this.bad('a value')
  }

  private skipKey(): void {
    this.rawString()
    this.colon()
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

  /** Reads the closing brace of an object without keys. */
  endsAtOnce(close: '}' | ']'): boolean {
    const ends = this.peek() === close.charCodeAt(0)
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
  goesOn(close: '}' | ']'): boolean {
    const code = this.peek()
    if (code === COMMA) {
      this.at++
      return true
    }
    if (code !== close.charCodeAt(0)) throw this.bad('a comma or a closing bracket')
    this.leave()
    return false
  }

  /** Counts a key or an item. */
  count(values: number): void {
    this.values -= values
    if (this.values < 0) throw new BodyError('too_many_values', 'fewer keys and items')
  }

  /** Nothing but white space may be left. */
  end(): void {
    if (!Number.isNaN(this.peek())) throw this.bad('nothing behind the value')
  }

  /** The text is no JSON here. */
  bad(expected: string): BodyError {
    return new BodyError('bad_json', expected)
  }
}
