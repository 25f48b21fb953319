// Hex dumps: lines of an offset, bytes, and perhaps the same bytes as text. xxd, hexdump, od, tcpdump -X, Wireshark,
// gdb, PowerShell and this site print them.

/** A run of bytes with the number of its stream. */
export interface Segment {
  stream: number
  bytes: Uint8Array
}

/** The bytes that a frame may begin with. */
export type Heads = readonly (readonly number[])[]

interface Missing {
  missing: { line: number; offset: number; before: number }
}

export type Dump = { segments: Segment[] } | Missing

interface Group {
  gap: number
  /** Column after its last digit, counted from the offset. */
  end: number
  digits: string
  /** A number with `0x`: the lower byte first. */
  swapped: boolean
}

interface Line {
  /** Counted from 1. */
  number: number
  indent: string
  offset: string
  /** Followed by a colon or preceded by 0x: surely an offset. */
  marked: boolean
  /** The text after the offset. */
  rest: string
  groups: Group[]
  /** A star: the line before is repeated up to here. */
  squeezed: boolean
}

const OFFSET = /^(\s*)(0x)?([0-9a-fA-F]{4,16})(?: <[^>]*>)?(:?)(?=\s|$)/
/** Lines that PowerShell prints above a dump. */
const CAPTION = /^\s*(?:(?:0?[0-9a-f] ){8,}.*|[-\s]+|(?:Offset|Label|Path)\b.*)$/i

/** Returns the lines of a text that look like a dump; empty if it cannot be one. */
function linesOf(text: string): Line[] {
  const lines: Line[] = []
  let squeezed = false
  let others = false
  text.split('\n').forEach((line, index) => {
    if (/^\s*\*\s*$/.test(line)) squeezed = true
    const found = OFFSET.exec(line)
    if (!found) {
      others ||= line.trim() !== '' && !squeezed && !CAPTION.test(line)
      return
    }
    const [all, indent, prefix, offset, colon] = found
    const rest = line.slice(all.length)
    const groups: Group[] = []
    for (const { 0: all, 1: gap, 2: token, index } of rest.matchAll(/(\s+)(\S+)/g)) {
      const [, number, digits] = /^(0x)?((?:[0-9a-fA-F]{2})+)$/.exec(token) ?? []
      if (digits === undefined) break
      groups.push({ gap: gap.length, end: index + all.length, digits, swapped: number !== undefined })
    }
    lines.push({ number: index + 1, indent, offset, marked: colon !== '' || prefix !== undefined, rest, groups, squeezed })
    squeezed = false
  })
  // Other lines are between those of a dump only where a tool marks its offsets, as tcpdump does.
  return others && lines.some(({ marked }) => !marked) ? [] : lines
}

/** Order of the bytes in a line: one after another, the lower byte of a group first, or in bits. */
interface Order {
  is: 'plain' | 'swapped' | 'bits'
  /** Column where the bytes end; `xxd -e` leaves a gap before the last of them. */
  end?: number
}
const PLAIN: Order = { is: 'plain' }

/** Returns the first `cap` bytes of a line. The column of text follows them. */
function bytesOf({ groups }: Line, cap: number, order: Order): number[] {
  const bytes: number[] = []
  for (const { gap, end, digits, swapped } of groups) {
    const outside = order.end === undefined ? bytes.length > 0 && gap > 2 : end > order.end
    if (bytes.length >= cap || outside) break
    if (order.is === 'bits') {
      bytes.push(Number.parseInt(digits, 2))
      continue
    }
    const pairs = digits.match(/../g) ?? []
    for (const pair of swapped || order.is === 'swapped' ? pairs.reverse() : pairs) bytes.push(Number.parseInt(pair, 16))
  }
  return bytes.slice(0, cap)
}

/**
 * Returns the bytes of a dump, or the place of a gap; `null` if the text is not a dump. `heads` decide between two
 * readings.
 */
export function readDump(text: string, heads: Heads = []): Dump | null {
  const lines = linesOf(text)
  const first = lines[0]
  if (!first) return null
  // `od` and `hexdump` print numbers of several notations and sizes after six or seven digits.
  const { length } = first.offset
  if ((length === 6 || length === 7) && lines.every(({ offset, marked }) => offset.length === length && !marked)) return readNumbered(lines)

  const order = orderOf(lines, heads)
  for (const radix of first.marked && length === 8 ? [16, 10] : [16]) {
    const read = walk(lines, radix, order)
    if ('segments' in read) return isDump(lines, radix) ? read : null
  }
  // A text with the marks of a dump is one: report the missing line instead of reading offsets as bytes.
  const marked = first.marked || (Number.parseInt(first.offset, 16) === 0 && lines.length > 1)
  return marked ? walk(lines, 16, order) : null
}

/** Returns the order of the bytes. The column of text or the head of a frame shows `xxd -e`; bits show `xxd -b`. */
function orderOf(lines: Line[], heads: Heads): Order {
  const [first, second] = lines
  const all = (digits: RegExp) => lines.every(({ marked, groups }) => marked && groups.length > 0 && (groups[0].gap > 2 || digits.test(groups[0].digits)))
  const size = second ? Number.parseInt(second.offset, 16) - Number.parseInt(first.offset, 16) : 16
  const bits = first.groups.filter(({ digits }) => /^[01]{8}$/.test(digits)).length
  if (all(/^[01]{8}$/) && (second ? bits === size : bits <= 6)) return { is: 'bits' }
  if (!all(/^[0-9a-fA-F]{8}$/)) return PLAIN
  const swapped: Order = { is: 'swapped', end: first.groups[Math.ceil(size / 4) - 1]?.end }
  const agrees = (order: Order) => {
    const bytes = bytesOf(first, size, order)
    if (heads.some((head) => head.every((byte, index) => bytes[index] === byte))) return true
    const text = bytes.map((byte) => (byte > 0x20 && byte < 0x7f ? String.fromCharCode(byte) : '.')).join('')
    return bytes.length > 4 && first.rest.trimEnd().slice(-bytes.length) === text
  }
  return !agrees(PLAIN) && agrees(swapped) ? swapped : PLAIN
}

/**
 * Returns `true` for a dump: it begins at zero, marks its offsets, or counts. Plain hex may also have four digits in
 * front.
 */
function isDump(lines: Line[], radix: number): boolean {
  const [first, second] = lines
  if (first.groups.length === 0) return false
  if (first.marked || Number.parseInt(first.offset, radix) === 0) return true
  return second !== undefined && Number.parseInt(second.offset, radix) > Number.parseInt(first.offset, radix)
}

/** Reads the lines with offsets in one radix, or stops at the first that does not continue the lines before. */
function walk(lines: Line[], radix: number, order: Order): Dump {
  const segments: { stream: number; indent: string; bytes: number[] }[] = []
  const next = new Map<string, number>()
  const streams: string[] = []
  /** The next line of the same side, for each line. */
  const followers = new Array<Line | undefined>(lines.length)
  const seen = new Map<string, Line>()
  for (let at = lines.length - 1; at >= 0; at--) {
    followers[at] = seen.get(lines[at].indent)
    seen.set(lines[at].indent, lines[at])
  }
  /** Number of bytes in a full line, unless another line shows it. */
  let width = 16
  for (const [index, line] of lines.entries()) {
    const offset = Number.parseInt(line.offset, radix)
    if (Number.isNaN(offset)) return { missing: { line: line.number, offset: 0, before: 0 } }
    if (!streams.includes(line.indent)) streams.push(line.indent)
    const expected = next.get(line.indent)
    const last = segments.at(-1)
    if (line.squeezed && last && expected !== undefined && offset > expected) {
      repeat(last.bytes, width, offset - expected)
      next.set(line.indent, offset)
    } else if (expected !== undefined && offset !== 0 && offset !== expected) {
      return { missing: { line: line.number, offset, before: expected } }
    }
    const following = followers[index]
    const after = following ? Number.parseInt(following.offset, radix) : Number.NaN
    const known = after > offset && after - offset <= 64 && !following?.squeezed
    const bytes = bytesOf(line, known ? after - offset : width, order)
    if (known) width = Math.max(bytes.length, segments.length === 0 ? 0 : 1)
    next.set(line.indent, offset + bytes.length)
    // A block that begins again is a separate packet, and so is the other side's turn.
    if (last && last.indent === line.indent && offset !== 0) last.bytes.push(...bytes)
    else if (bytes.length > 0) segments.push({ stream: streams.indexOf(line.indent), indent: line.indent, bytes })
  }
  return { segments: segments.map(({ stream, bytes }) => ({ stream, bytes: Uint8Array.from(bytes) })) }
}

/** Most bytes that a star repeats: it could mean gigabytes. */
const REPEATED_LIMIT = 4 * 1024 * 1024

/** Repeats the last row, as `*` in a dump requests. */
function repeat(bytes: number[], width: number, count: number): void {
  const row = bytes.slice(-width)
  if (row.length === 0) return
  for (let at = 0; at < Math.min(count, REPEATED_LIMIT); at++) bytes.push(row[at % row.length])
}

/** A notation of a number, with its size in bytes. */
interface Notation {
  size: number
  spelled: RegExp
  read: (token: string) => bigint
}

const hexadecimal = (token: string) => BigInt(`0x${token}`)
const octal = (token: string) => BigInt(`0o${token}`)
const NOTATIONS: Notation[] = [
  { size: 1, spelled: /^[0-9a-fA-F]{2}$/, read: hexadecimal },
  { size: 1, spelled: /^[0-3][0-7]{2}$/, read: octal },
  { size: 2, spelled: /^[0-9a-fA-F]{4}$/, read: hexadecimal },
  { size: 2, spelled: /^[01][0-7]{5}$/, read: octal },
  { size: 4, spelled: /^[0-9a-fA-F]{8}$/, read: hexadecimal },
  { size: 4, spelled: /^[0-3][0-7]{10}$/, read: octal },
  { size: 8, spelled: /^[0-9a-fA-F]{16}$/, read: hexadecimal },
  { size: 8, spelled: /^[01][0-7]{21}$/, read: octal },
  { size: 1, spelled: /^[-+]?\d{1,3}$/, read: BigInt },
  { size: 2, spelled: /^[-+]?\d{1,5}$/, read: BigInt },
  { size: 4, spelled: /^[-+]?\d{1,10}$/, read: BigInt },
  { size: 8, spelled: /^[-+]?\d{1,20}$/, read: BigInt },
]

/** Returns the numbers of a line, without a column of text. */
const tokensOf = ({ rest }: Line) => rest.replace(/\s{2}[>|].*$/, '').trim().split(/\s+/).filter(Boolean)

/** Returns the bytes of numbers, the lower byte of each first. */
function littleEndian(tokens: string[], { size, read }: Notation): number[] {
  return tokens.flatMap((token) => {
    const value = BigInt.asUintN(64, read(token))
    return Array.from({ length: size }, (_, at) => Number((value >> BigInt(8 * at)) & 0xffn))
  })
}

/** Reads characters as `od -c` prints them, four columns each; `null` if the line has none, or not `count` of them. */
const NAMED: Record<string, number> = { '\\0': 0, '\\a': 7, '\\b': 8, '\\t': 9, '\\n': 10, '\\v': 11, '\\f': 12, '\\r': 13 }
function characters({ rest }: Line, count: number | null): number[] | null {
  const bytes: number[] = []
  const end = count === null ? rest.length : 4 * count
  if (rest.length <= end - 4 || rest.slice(end).trim() !== '') return null
  for (let at = 0; at < Math.min(end, rest.length); at += 4) {
    const cell = rest.slice(at, at + 4)
    const word = cell.trim()
    const byte = /^[0-3][0-7]{2}$/.test(word) ? Number.parseInt(word, 8) : NAMED[word]
    if (byte === undefined && (word.length > 1 || word > '~')) return null
    bytes.push(byte ?? (word === '' ? 0x20 : word.charCodeAt(0)))
  }
  return bytes
}

/** Reads a dump of `od` or `hexdump`. The offsets show the size of each number. */
function readNumbered(lines: Line[]): Dump | null {
  const bare = lines.filter((line, index) => tokensOf(line).length === 0 && index < lines.length - 1)
  if (bare.length > 0 || tokensOf(lines[0]).length === 0) return null
  for (const radix of [8, 16, 10]) {
    const digits = { 8: /^[0-7]+$/, 10: /^\d+$/, 16: /^[0-9a-fA-F]+$/ }[radix]!
    if (!lines.every(({ offset }) => digits.test(offset))) continue
    const read = numbered(lines, radix)
    if (read) return read
  }
  // It counts from zero, so it is a dump: report the missing line instead of reading offsets as bytes.
  if (/[^0]/.test(lines[0].offset) || lines.length < 2) return null
  const radix = { '20': 8, '10': 16, '16': 10 }[lines[1].offset.replace(/^0+/, '')] ?? 16
  let before = 0
  for (const [index, { number, offset, squeezed }] of lines.entries()) {
    const here = Number.parseInt(offset, radix)
    if (index > 0 && !squeezed && here > before + 16) return { missing: { line: number, offset: here, before: before + 16 } }
    before = here
  }
  return null
}

/** Returns the bytes with offsets in this radix, if the lines have the lengths that the offsets imply. */
function numbered(lines: Line[], radix: number): Dump | null {
  const offsets = lines.map(({ offset }) => Number.parseInt(offset, radix))
  if (offsets.some((offset, index) => index > 0 && offset <= offsets[index - 1])) return null
  const full = offsets[1] - offsets[0]
  /** Returns the number of bytes in a line; `null` for the last one and before a squeezed one. */
  const count = (index: number) => (index + 1 < lines.length && !lines[index + 1].squeezed ? offsets[index + 1] - offsets[index] : null)
  const row = lines.length > 1 && !lines[1].squeezed ? full : 16
  for (const notation of NOTATIONS) {
    const fits = lines.every((line, index) => {
      const tokens = tokensOf(line)
      const bytes = count(index)
      const enough = bytes === null ? tokens.length * notation.size <= Math.max(row, 16) : Math.ceil(bytes / notation.size) === tokens.length && bytes <= row
      return enough && tokens.every((token) => notation.spelled.test(token) && fitsIn(token, notation))
    })
    if (fits) return joined(lines, offsets, (line) => littleEndian(tokensOf(line), notation), count, row)
  }
  if (!lines.every((line, index) => index === lines.length - 1 || characters(line, count(index)))) return null
  return joined(lines, offsets, (line, index) => characters(line, count(index)) ?? [], count, row)
}

/** Returns `true` if a number fits the size of its notation. */
function fitsIn(token: string, { size, read }: Notation): boolean {
  const value = read(token)
  return value >= -(1n << BigInt(8 * size - 1)) && value < 1n << BigInt(8 * size)
}

function joined(lines: Line[], offsets: number[], bytesOf: (line: Line, index: number) => number[], count: (index: number) => number | null, row: number): Dump {
  const bytes: number[] = []
  for (const [index, line] of lines.entries()) {
    if (line.squeezed) repeat(bytes, row, offsets[index] - offsets[0] - bytes.length)
    bytes.push(...bytesOf(line, index).slice(0, count(index) ?? undefined))
  }
  return { segments: [{ stream: 0, bytes: Uint8Array.from(bytes) }] }
}

/** Reads numbers of `od -An`, which prints no offsets, but only if they begin with a frame. */
export function readUnnumbered(text: string, heads: Heads): Uint8Array | null {
  const tokens = text.trim().split(/\s+/)
  for (const notation of NOTATIONS) {
    // Single bytes in hex are plain hex, and decimal numbers of several bytes are ambiguous.
    if ((notation.size === 1 && notation.read === hexadecimal) || notation.read === BigInt) continue
    if (!tokens.every((token) => notation.spelled.test(token))) continue
    const bytes = littleEndian(tokens, notation)
    if (heads.some((head) => head.every((byte, index) => bytes[index] === byte))) return Uint8Array.from(bytes)
  }
  return null
}
