// Converts pasted text to bytes, in the forms that engineers copy from their tools, and explains why a text is refused.

import type { Text } from '../fc'
import { readDump, readUnnumbered, type Heads, type Segment } from './dump'
import { isLog, readLog, type Run } from './log'
import { framesIn, parsePackets } from './packets'
import { readCaptureFile } from './pcap'

export type { Segment } from './dump'

/** The form of the bytes. */
export type Spelling = 'hex' | 'dump' | 'numbers' | 'string' | 'base64' | 'log'

/** Bytes in the order of pasting, each run with the number of its stream. */
export interface Pasted {
  spelling: Spelling
  segments: Segment[]
}

/** The reason why a text has no bytes, in words for the reader. */
export class Refusal extends Error {
  constructor(readonly text: Text) {
    super(text.en)
  }
}

const refuse = (zh: string, en: string): never => {
  throw new Refusal({ zh, en })
}

/** Longest text that is read: a page should stay usable. */
export const PASTE_LIMIT = 8 * 1024 * 1024

const begins = (bytes: Uint8Array, heads: Heads) => heads.some((head) => head.every((byte, index) => bytes[index] === byte))

/** Returns the streams in bytes: those with frames for a file of captured packets, otherwise the bytes themselves. */
function streamsIn(bytes: Uint8Array, heads: Heads): Segment[] {
  const packets = readCaptureFile(bytes)
  if (!packets) return parsePackets([{ stream: 0, bytes }])
  const { segments, tcp } = framesIn(packets, heads)
  if (segments.length === 0) {
    refuse(
      `抓包文件中有 ${packets.length} 个包，其中 ${tcp} 个是 TCP，但没有这个协议的帧。`,
      `The capture file has ${packets.length} packets, ${tcp} of them TCP, and no frame of this protocol.`,
    )
  }
  return segments
}

/**
 * Reads pasted text. `heads` are the possible beginnings of a frame: they distinguish bytes from other words. An empty
 * text has no bytes. Throws `Refusal`.
 */
export function readPaste(text: string, heads: Heads): Pasted {
  if (text.length > PASTE_LIMIT) refuse('内容太长，请分段粘贴。', 'This is too long. Paste a part of it.')
  const source = text.replace(/^\ufeff/, '').replace(/\r\n?/g, '\n')
  const alone = (spelling: Spelling, bytes: Uint8Array): Pasted => ({ spelling, segments: streamsIn(bytes, heads) })
  /** Returns bytes between words; `null` if no frame begins among them. */
  const among = (): Pasted | null => {
    const segments = readLog(source, heads, (line) => spelledIn(line, heads))
    if (segments === null) return null
    if (Array.isArray(segments)) return { spelling: 'log', segments: parsePackets(segments) }
    const { line, token } = segments
    return typeof token === 'string'
      ? refuse(`第 ${line} 行的“${token}”不是十六进制。`, `“${token}” in line ${line} is not hex.`)
      : refuse(
          `第 ${line} 行共 ${token} 个十六进制数字，是奇数：多了或少了一个。`,
          `Line ${line} has ${token} hex digits, an odd number: one is missing or too many.`,
        )
  }

  const buffers = readBuffers(source)
  if (buffers) return { spelling: 'hex', segments: buffers }
  const dump = readDump(source, heads)
  const log = isLog(source) && !(dump && 'segments' in dump) ? among() : null
  if (log) return log
  if (/^\s*[{[]\s*("|[{[]\s*")/.test(source)) {
    const found = /"type"\s*:\s*"Buffer"/.test(source) ? readNumbers(source) : null
    if (found) return { spelling: 'numbers', segments: found }
    return among() ?? refuse('这是 JSON，不是帧的字节。请粘到下面的“JSON → 帧”。', 'This is JSON, not the bytes of a frame. Paste it under “JSON → frame” below.')
  }
  if (dump && 'missing' in dump) {
    const { line, offset, before } = dump.missing
    refuse(
      `第 ${line} 行的偏移是 0x${offset.toString(16)}，而前面只到 0x${before.toString(16)}：中间缺了内容，或者有一行不完整。`,
      `Line ${line} has the offset 0x${offset.toString(16)}, but the bytes before it end at 0x${before.toString(16)}: a line is missing or not complete.`,
    )
  }
  if (dump && 'segments' in dump) {
    const { segments } = dump
    return segments.length === 1 ? alone('dump', segments[0].bytes) : { spelling: 'dump', segments: parsePackets(segments) }
  }
  if (ESCAPE.test(source)) return alone('string', readString(source))
  const numbers = readNumbers(source)
  if (numbers) return { spelling: 'numbers', segments: numbers }

  const digits = source.replace(/^\s*0x/i, '').replace(/[\s,;:|'"{}()[\]<>_-]+/g, '')
  if (digits !== '' && !/[^0-9a-fA-F]/.test(digits)) {
    if (digits.length % 2 !== 0) {
      refuse(
        `共 ${digits.length} 个十六进制数字，是奇数：多了或少了一个。`,
        `There are ${digits.length} hex digits, an odd number: one is missing or too many.`,
      )
    }
    const plain = Uint8Array.from(digits.match(/../g) ?? [], (pair) => Number.parseInt(pair, 16))
    return alone('hex', begins(plain, heads) ? plain : (readUnnumbered(source, heads) ?? plain))
  }
  if (digits === '') return { spelling: 'hex', segments: [] }
  const words = readUnnumbered(source, heads) ?? null
  if (words) return alone('numbers', words)

  const packed = source.split('\n').map((line) => line.trim()).join('')
  // Hex with a typing error is not base64, which has many letters after F.
  const others = packed.match(/[^0-9a-fA-F]/g)?.length ?? 0
  if (packed.length % 4 === 0 && others * 8 > packed.length && /^[A-Za-z0-9+/]+={0,2}$/.test(packed)) {
    const bytes = fromBase64(packed)
    if (begins(bytes, heads) || readCaptureFile(bytes)) return alone('base64', bytes)
    refuse(
      '看起来像 base64，但解码后不是以帧头开始，无法确定，所以不读。请改用十六进制。',
      'This may be base64, but no frame begins it, so it is not read. Use hex instead.',
    )
  }
  const found = among()
  if (found) return found
  const lines = source.split('\n')
  const strange = /[^0-9a-fA-F\s,;:|'"{}()[\]_-]/
  const line = lines.findIndex((one) => strange.test(one))
  const character = strange.exec(lines[line] ?? '')?.[0] ?? ''
  return refuse(
    `第 ${line + 1} 行的“${character}”不是十六进制。`,
    `“${character}” in line ${line + 1} is not hex.`,
  )
}

const fromBase64 = (text: string) => Uint8Array.from(atob(text), (character) => character.charCodeAt(0))

/** An escape of a byte in a string literal. */
const ESCAPE = /\\(?:x[0-9a-fA-F]{2}|[0-7]{3})/

/** Buffers as Node prints them: `<Buffer fc aa … 10 more bytes>`, and the contents of an `ArrayBuffer`. */
function readBuffers(source: string): Segment[] | null {
  const found = source.matchAll(/<(?:Slow)?Buffer((?:\s+[0-9a-fA-F]{2})*)[^<>]*>|\[Uint8Contents\]: <([0-9a-fA-F\s]*)[^<>]*>/g)
  const segments = Array.from(found, ([, buffer, contents]) => {
    const pairs = (buffer ?? contents).match(/[0-9a-fA-F]{2}/g) ?? []
    return { stream: 0, bytes: Uint8Array.from(pairs, (pair) => Number.parseInt(pair, 16)) }
  })
  return segments.length > 0 ? segments : null
}

/** Returns bytes in a line of a log that are not hex: a string literal, a list of numbers or base64. */
function spelledIn(line: string, heads: Heads): Run | null {
  const literal = ESCAPE.test(line) ? /"(?:[^"\\]|\\.)*"|'(?:[^'\\]|\\.)*'/g : null
  for (const { 0: text, index } of literal ? line.matchAll(literal) : []) {
    if (ESCAPE.test(text)) return { from: index, to: index + text.length, bytes: readString(text) }
  }
  for (const { 0: text, index } of line.matchAll(/\[[-\d\s,]+\]/g)) {
    const bytes = readNumbers(text)?.[0]?.bytes
    if (bytes) return { from: index, to: index + text.length, bytes }
  }
  for (const { 0: text, index } of line.matchAll(/(?<![\w+/=])[A-Za-z0-9+/]{16,}={0,2}(?![\w+/=])/g)) {
    const bytes = text.length % 4 === 0 ? fromBase64(text) : null
    if (bytes && begins(bytes, heads)) return { from: index, to: index + text.length, bytes }
  }
  return null
}

/** Largest file that is opened. */
export const FILE_LIMIT = 64 * 1024 * 1024

/**
 * Returns the text of an opened file, for the box of the frame lab. Captured packets become a dump of their streams,
 * and other bytes a dump; a text file does not change. Throws `Refusal`.
 */
export function readFile(bytes: Uint8Array, heads: Heads): string {
  if (bytes.length > FILE_LIMIT) refuse('文件太大，请截取一部分。', 'This file is too large. Take a part of it.')
  const isCapture = readCaptureFile(bytes) !== null
  const text = isCapture ? null : textOf(bytes)
  const written = text ?? dumpOf(isCapture ? streamsIn(bytes, heads) : [{ stream: 0, bytes }])
  if (written.length > PASTE_LIMIT) refuse('文件太大，请截取一部分。', 'This file is too large. Take a part of it.')
  return written
}

/** Returns the text in the bytes, in UTF-8 or, as PowerShell writes it, in UTF-16; `null` if they are not text. */
function textOf(bytes: Uint8Array): string | null {
  const wide = bytes[0] === 0xff && bytes[1] === 0xfe
  try {
    const text = new TextDecoder(wide ? 'utf-16le' : 'utf-8', { fatal: true }).decode(bytes)
    return /[\0-\x08\x0e-\x1a\x1c-\x1f]/.test(text) ? null : text
  } catch {
    return null
  }
}

/** Returns a dump of streams, each indented by its number, as Wireshark shows the two sides of a connection. */
function dumpOf(segments: Segment[]): string {
  const at = new Map<number, number>()
  const lines: string[] = []
  for (const { stream, bytes } of segments) {
    let offset = at.get(stream) ?? 0
    for (let from = 0; from < bytes.length; from += 16) {
      const row = bytes.subarray(from, from + 16)
      const spelled = Array.from(row, (byte) => byte.toString(16).padStart(2, '0')).join(' ')
      lines.push(`${' '.repeat(2 * stream)}${offset.toString(16).padStart(8, '0')}: ${spelled}`)
      offset += row.length
    }
    at.set(stream, offset)
  }
  return lines.join('\n')
}

const ESCAPED: Record<string, number> = { n: 10, r: 13, t: 9, a: 7, b: 8, f: 12, v: 11, '\\': 92, '"': 34, "'": 39 }

/** Returns the bytes of a string literal of C, Python or the shell; several literals are joined. */
function readString(source: string): Uint8Array {
  // The text in quotes, or all of it without quotes.
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

/** Returns the lists in a text with the words before each, between braces or brackets if there are any. */
function listsOf(bare: string): { name: string; body: string }[] {
  const runs = bare.split(/[{}]/)
  const bodies = runs.length < 3 ? [{ name: '', body: bare }] : runs.flatMap((body, at) => (at % 2 === 1 ? [{ name: runs[at - 1], body }] : []))
  return bodies.flatMap(({ name, body }) => {
    // Words before the brackets, as in `Uint8Array(60) [`, `type: 'Buffer', data: [` and `byteArrayOf(`.
    const brackets = /\[([^[\]]*)\]|\(([^()]*)\)/g
    if (!/[A-WYZa-wyz]{2}/.test(body.replace(brackets, ' '))) return [{ name, body }]
    const lists = Array.from(body.matchAll(brackets), ([, square, round]) => square ?? round)
    const numeric = lists.filter((list) => /^[\s,\dxa-f[\]-]+$/i.test(list) && /[\s,]/.test(list.trim()))
    return numeric.length > 0 ? numeric.map((list) => ({ name, body: list })) : [{ name, body }]
  })
}

/** Reads lists of numbers: arrays of C, Go, Rust, Java, Python, JavaScript. Returns `null` if there is none. */
function readNumbers(source: string): Segment[] | null {
  const bare = source.replace(/\/\*[^]*?\*\//g, ' ').replace(/\/\/.*$/gm, ' ').replace(/\.\.\. *\d+ more items?|\(\s*(?:byte|unsigned char|uint8_t)\s*\)|\.toByte\(\)|(?<=0x[0-9a-f]{2})u8\b/gi, ' ')
  const segments: Segment[] = []
  for (const { name, body } of listsOf(bare)) {
    const tokens = body.replace(/[[\]();]/g, ' ').split(/[\s,]+/).filter(Boolean)
    const hex = tokens.some((token) => /^0x[0-9a-f]{1,2}$/i.test(token))
    // Decimal only if nothing else fits: signs, or numbers without exactly two digits.
    const separated = body.includes(',') || /^\s*\[[\d\s]+\]\s*$/.test(body)
    const decimal = separated && tokens.some((token) => /^(?:-\d+|\d{3})$/.test(token)) && tokens.every((token) => /^-?\d{1,3}$/.test(token))
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
