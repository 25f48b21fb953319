// Hex dumps: lines of an offset, bytes, and perhaps the same bytes as text. Those of xxd, hexdump,
// od, tcpdump -X, Wireshark (bytes of a packet, or a followed stream) and of this site.

/** A run of bytes, and which of several streams it belongs to. */
export interface Segment {
  stream: number
  bytes: Uint8Array
}

export type Dump = { segments: Segment[] } | { missing: { line: number; offset: number; before: number } }

interface Line {
  /** Counted from 1. */
  number: number
  indent: string
  offset: string
  /** Followed by a colon or opened by 0x: surely an offset. */
  marked: boolean
  groups: { gap: number; digits: string }[]
  /** The line before is repeated down to here. */
  squeezed: boolean
}

const OFFSET = /^(\s*)(0x)?([0-9a-fA-F]{4,8})(:?)(?=\s|$)/

/** The lines of a text that look like those of a dump, if it can be one. */
function linesOf(text: string): Line[] {
  const lines: Line[] = []
  let squeezed = false
  let others = false
  text.split('\n').forEach((line, index) => {
    if (/^\s*\*\s*$/.test(line)) squeezed = true
    const found = OFFSET.exec(line)
    if (!found) {
      others ||= line.trim() !== '' && !squeezed
      return
    }
    const [all, indent, prefix, offset, colon] = found
    const groups: Line['groups'] = []
    for (const [, gap, token] of line.slice(all.length).matchAll(/(\s+)(\S+)/g)) {
      if (!/^(?:[0-9a-fA-F]{2})+$/.test(token)) break
      groups.push({ gap: gap.length, digits: token })
    }
    lines.push({ number: index + 1, indent, offset, marked: colon !== '' || prefix !== undefined, groups, squeezed })
    squeezed = false
  })
  // Other lines stand between those of a dump only where a tool marks its offsets, as tcpdump does.
  return others && lines.some(({ marked }) => !marked) ? [] : lines
}

/** Bytes of a line, of which at most `cap` belong to it: what follows is the column of text. */
function bytesOf({ groups }: Line, cap: number, swapped: boolean): number[] {
  const bytes: number[] = []
  for (const { gap, digits } of groups) {
    if (bytes.length >= cap || (bytes.length > 0 && gap > 2)) break
    const pairs = digits.match(/../g) ?? []
    for (const pair of swapped ? pairs.reverse() : pairs) bytes.push(Number.parseInt(pair, 16))
  }
  return bytes.slice(0, cap)
}

/** The bytes of a dump, or where it has a hole; `null` if the text is none. */
export function readDump(text: string): Dump | null {
  const lines = linesOf(text)
  const first = lines[0]
  if (!first) return null
  // `hexdump` and `od` without options print words of two bytes, the lower byte first, behind seven digits.
  const seven = lines.every(({ offset, marked }) => offset.length === 7 && !marked)
  const swapped = seven && lines.some(({ groups }) => groups.length > 0) && lines.every(({ groups }) => groups.every(({ digits }) => digits.length === 4))

  // Seven digits are octal where `od` wrote them.
  for (const radix of seven ? [16, 8] : [16]) {
    const read = walk(lines, radix, swapped)
    if ('segments' in read) return isDump(lines, radix) ? read : null
  }
  // With the marks of a dump it is one all the same: better to say what is missing than to read offsets as bytes.
  const marked = first.marked || (Number.parseInt(first.offset, 16) === 0 && lines.length > 1)
  return marked ? walk(lines, 16, swapped) : null
}

/** Plain hex can have four digits in front, too: a dump begins at zero, marks its offsets, or counts. */
function isDump(lines: Line[], radix: number): boolean {
  const [first, second] = lines
  if (first.groups.length === 0) return false
  if (first.marked || Number.parseInt(first.offset, radix) === 0) return true
  return second !== undefined && Number.parseInt(second.offset, radix) > Number.parseInt(first.offset, radix)
}

/** Reads the lines with offsets in one radix, or stops at the first that does not continue what is before. */
function walk(lines: Line[], radix: number, swapped: boolean): Dump {
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
  /** Bytes of a whole line, where no other tells how many there are. */
  let width = 16
  for (const [index, line] of lines.entries()) {
    const offset = Number.parseInt(line.offset, radix)
    if (Number.isNaN(offset)) return { missing: { line: line.number, offset: 0, before: 0 } }
    if (!streams.includes(line.indent)) streams.push(line.indent)
    const expected = next.get(line.indent)
    const last = segments.at(-1)
    if (line.squeezed && last && expected !== undefined && offset > expected) {
      const repeated = last.bytes.slice(-width)
      while (last.bytes.length > 0 && (next.get(line.indent) ?? 0) < offset) {
        const some = repeated.slice(0, offset - (next.get(line.indent) ?? 0))
        last.bytes.push(...some)
        next.set(line.indent, (next.get(line.indent) ?? 0) + some.length)
      }
    } else if (expected !== undefined && offset !== 0 && offset !== expected) {
      // The last line of `hexdump` and `od` is only an offset: the length, one less than the words say if it is odd.
      if (swapped && line.groups.length === 0 && offset === expected - 1 && last) {
        last.bytes.pop()
        continue
      }
      return { missing: { line: line.number, offset, before: expected } }
    }
    const following = followers[index]
    const after = following ? Number.parseInt(following.offset, radix) : Number.NaN
    const inside = after > offset && after - offset <= 64 && !following?.squeezed
    const known = inside && !(swapped && following?.groups.length === 0)
    const bytes = bytesOf(line, known ? after - offset : width, swapped)
    if (known) width = Math.max(bytes.length, segments.length === 0 ? 0 : 1)
    next.set(line.indent, offset + bytes.length)
    // A block that begins anew is a packet of its own; so is the other side's turn.
    if (last && last.indent === line.indent && offset !== 0) last.bytes.push(...bytes)
    else if (bytes.length > 0) segments.push({ stream: streams.indexOf(line.indent), indent: line.indent, bytes })
  }
  return { segments: segments.map(({ stream, bytes }) => ({ stream, bytes: Uint8Array.from(bytes) })) }
}
