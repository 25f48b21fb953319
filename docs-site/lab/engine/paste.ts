// Pasted text to bytes: how engineers copy them out of their tools, and why a text is refused.

import type { Text } from '../fc'
import { readDump, type Segment } from './dump'
import { parsePackets } from './packets'

export type { Segment } from './dump'

/** How the bytes were spelled. */
export type Spelling = 'hex' | 'dump' | 'numbers' | 'string' | 'base64'

/** Bytes in the order in which they were pasted, each run with the stream that it belongs to. */
export interface Pasted {
  spelling: Spelling
  segments: Segment[]
}

/** Why a text is no bytes, in words for its reader. */
export class Refusal extends Error {
  constructor(readonly text: Text) {
    super(text.en)
  }
}

const refuse = (zh: string, en: string): never => {
  throw new Refusal({ zh, en })
}

/** More text than this is not read: a page should stay usable. */
export const PASTE_LIMIT = 8 * 1024 * 1024

/**
 * Reads pasted text. `heads` are the ways in which a frame can begin: only they tell base64 from any
 * other word. An empty text has no bytes. Throws `Refusal`.
 */
export function readPaste(text: string, heads: number[][]): Pasted {
  if (text.length > PASTE_LIMIT) refuse('内容太长，请分段粘贴。', 'This is too long. Paste a part of it.')
  const source = text.replace(/^\ufeff/, '').replace(/\r\n?/g, '\n')
  const alone = (spelling: Spelling, bytes: Uint8Array): Pasted => ({ spelling, segments: parsePackets([{ stream: 0, bytes }]) })

  if (/^\s*[{[]\s*("|[{[]\s*")/.test(source)) {
    refuse('这是 JSON，不是帧的字节。请粘到下面的“JSON → 帧”。', 'This is JSON, not the bytes of a frame. Paste it under “JSON → frame” below.')
  }
  const dump = readDump(source)
  if (dump && 'missing' in dump) {
    const { line, offset, before } = dump.missing
    refuse(
      `第 ${line} 行的偏移是 0x${offset.toString(16)}，而前面只到 0x${before.toString(16)}：中间缺了内容，或者有一行不完整。`,
      `Line ${line} has the offset 0x${offset.toString(16)}, but the bytes before it end at 0x${before.toString(16)}: a line is missing or not complete.`,
    )
  }
  if (dump && 'segments' in dump) return { spelling: 'dump', segments: parsePackets(dump.segments) }
  if (/\\(?:x[0-9a-fA-F]{2}|[0-7]{3})/.test(source)) return alone('string', readString(source))
  const numbers = readNumbers(source)
  if (numbers) return { spelling: 'numbers', segments: numbers }

  const digits = source.replace(/^\s*0x/i, '').replace(/[\s,;:|'"{}()[\]_-]+/g, '')
  if (digits !== '' && !/[^0-9a-fA-F]/.test(digits)) {
    if (digits.length % 2 !== 0) {
      refuse(
        `共 ${digits.length} 个十六进制数字，是奇数：多了或少了一个。`,
        `There are ${digits.length} hex digits, an odd number: one is missing or too many.`,
      )
    }
    return alone('hex', Uint8Array.from(digits.match(/../g) ?? [], (pair) => Number.parseInt(pair, 16)))
  }
  if (digits === '') return { spelling: 'hex', segments: [] }

  const packed = source.split('\n').map((line) => line.trim()).join('')
  // Hex with a slip is no base64: that has many letters behind F.
  const others = packed.match(/[^0-9a-fA-F]/g)?.length ?? 0
  if (packed.length % 4 === 0 && others * 8 > packed.length && /^[A-Za-z0-9+/]+={0,2}$/.test(packed)) {
    const bytes = Uint8Array.from(atob(packed), (character) => character.charCodeAt(0))
    if (heads.some((head) => head.every((byte, index) => bytes[index] === byte))) return alone('base64', bytes)
    refuse(
      '看起来像 base64，但解码后不是以帧头开始，无法确定，所以不读。请改用十六进制。',
      'This may be base64, but no frame begins it, so it is not read. Use hex instead.',
    )
  }
  const lines = source.split('\n')
  const strange = /[^0-9a-fA-F\s,;:|'"{}()[\]_-]/
  const line = lines.findIndex((one) => strange.test(one))
  const character = strange.exec(lines[line] ?? '')?.[0] ?? ''
  return refuse(
    `第 ${line + 1} 行的“${character}”不是十六进制。`,
    `“${character}” in line ${line + 1} is not hex.`,
  )
}

const ESCAPED: Record<string, number> = { n: 10, r: 13, t: 9, a: 7, b: 8, f: 12, v: 11, '\\': 92, '"': 34, "'": 39 }

/** The bytes of a string literal of C, Python or the shell; of several, one after the other. */
function readString(source: string): Uint8Array {
  // What stands in quotes; without quotes, all of it.
  const quoted = source.match(/"(?:[^"\\]|\\[^])*"|'(?:[^'\\]|\\[^])*'/g)?.map((literal) => literal.slice(1, -1))
  const bytes: number[] = []
  for (const literal of quoted ?? [source.replace(/\\?\s+/g, '')]) {
    // A backslash at the end of a line continues it.
    for (const [whole, hex, octal, letter, plain] of literal.matchAll(/\\x([0-9a-fA-F]{2})|\\([0-7]{1,3})|\\\n|\\([^])|([^\\])/g)) {
      if (hex !== undefined) bytes.push(Number.parseInt(hex, 16))
      else if (octal !== undefined) bytes.push(Number.parseInt(octal, 8) & 0xff)
      else if (letter !== undefined) {
        bytes.push(
          ESCAPED[letter] ?? refuse(`转义 \\${letter} 不是一个字节。`, `The escape \\${letter} is not a byte.`),
        )
      } else if (plain !== undefined) {
        const code = plain.charCodeAt(0)
        if (code > 0x7e) refuse(`字符串里的“${plain}”不是单个字节。`, `“${plain}” in the string is not one byte.`)
        bytes.push(code)
      } else if (whole !== '\\\n') refuse('字符串不完整。', 'The string is not complete.')
    }
  }
  return Uint8Array.from(bytes)
}

/** Lists of numbers: arrays of C, Go, Rust, Java, Python. `null` if this is none. */
function readNumbers(source: string): Segment[] | null {
  const bare = source.replace(/\/\*[^]*?\*\//g, ' ').replace(/\/\/.*$/gm, ' ')
  // Between brackets where there are any: a declaration stands in front.
  const runs = bare.split(/[{}]/)
  const bodies = runs.length < 3 ? [{ name: '', body: bare }] : runs.flatMap((body, at) => (at % 2 === 1 ? [{ name: runs[at - 1], body }] : []))
  const segments: Segment[] = []
  for (const { name, body } of bodies) {
    const tokens = body.replace(/[[\]();]/g, ' ').split(/[\s,]+/).filter(Boolean)
    const hex = tokens.some((token) => /^0x[0-9a-f]{1,2}$/i.test(token))
    // Decimal only where nothing else fits: signs, or three digits between commas.
    const decimal = body.includes(',') && tokens.some((token) => /^(?:-\d+|\d{3})$/.test(token)) && tokens.every((token) => /^-?\d{1,3}$/.test(token))
    if (!hex && !decimal) {
      if (tokens.length > 1 && tokens.every((token) => /^0x[0-9a-f]+$/i.test(token))) {
        refuse(
          `“${tokens[0]}”不止一个字节，字节序不明，所以不读。请逐字节复制。`,
          `“${tokens[0]}” has more than one byte, in an order that cannot be known. Copy byte by byte.`,
        )
      }
      return null
    }
    const bytes = tokens.map((token) => {
      if (hex ? !/^0x[0-9a-f]{1,2}$/i.test(token) : Number(token) < -128 || Number(token) > 255) {
        refuse(`“${token}”不是一个字节。`, `“${token}” is not a byte.`)
      }
      return Number(token) & 0xff
    })
    // The two sides of a followed stream, as Wireshark names them.
    const peer = /\bpeer(\d+)_\d+/.exec(name)
    segments.push({ stream: peer ? Number(peer[1]) : 0, bytes: Uint8Array.from(bytes) })
  }
  return parsePackets(segments)
}
