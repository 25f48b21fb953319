// Bytes in the lines of a log: logcat, SLF4J and similar, serial and network tools, socat, Netty, Node, Python.
//
// Each line has a time, words and perhaps bytes. The words before bytes distinguish frames from ids, addresses and
// digests. If a frame begins after these words once, all bytes after them are read.

import { readDump, type Heads, type Segment } from './dump'

/** Bytes in a line, and the columns that they take. */
export interface Run {
  from: number
  to: number
  bytes: Uint8Array
}

/** Finds bytes in a line in a form other than hex. */
export type Spelled = (line: string) => Run | null

/** The reason why bytes of a log are not read. */
export interface LogSlip {
  line: number
  /** A token that is not a byte, or the number of digits of a run with an odd one. */
  token: string | number
}

const DATE = String.raw`(?:\d{4}[-/.]\d{1,2}[-/.]\d{1,2}|\d{1,2}[-/.]\d{1,2}(?:[-/.]\d{2,4})?|(?:[A-Z][a-z]{2},? )?(?:\d{1,2} )?[A-Z][a-z]{2} {1,2}\d{1,2}(?:,? \d{4})?)`
const TIME = String.raw`\d{1,2}:\d{2}:\d{2}(?:[.,]\d{1,9}|:\d{3})?(?: ?[AP]M\b)?(?:Z|[+-]\d{2}:?\d{2})?`
const STAMP = new RegExp(String.raw`(?<![\w:])(?:${DATE}[ T,]{1,2})?${TIME}(?![\w:])|(?<![\w:])${DATE}(?=[\])] )|\b\d{10}\.\d{3,9}\b|\[ *\d{1,7}\.\d{3,6}\]`, 'g')
const LEVEL = /(?:^|[\s[(|])(?:TRACE|DEBUG|INFO|NOTICE|WARN(?:ING)?|ERROR|FATAL|[Tt]race|[Dd]ebug|[Ii]nfo|[Ww]arn)(?=[\s\])|:]|$)|^\s*[VDIWEF]\/[^\s:]+.*?: /
/** Words and signs before sent bytes, and before received ones. */
const SENT = /\b(?:tx|sen[dt]\w*|writ\w*|wrote|out(?:going|bound)?|request)\b|>>|->|=>|→|◇|发|^\s*> /gi
const RECEIVED = /\b(?:rx|recv|receiv\w*|read|in(?:coming|bound)?|response)\b|<<|<-|<=|←|◆|收|^\s*< /gi

/** The times and lengths in a line are not bytes. */
const blank = (text: string) => '\u0001'.repeat(text.length)
const without = (line: string) =>
  line
    .replace(STAMP, blank)
    .replace(/\b(?:len(?:gth)?|size|bytes|count|from|to|port|pid|tid|fd)\s*[=:]?\s*\d+\b/gi, blank)
    .replace(/\b\d+ ?(?:bytes?\b|字节)/gi, blank)

const BYTE = '[0-9A-Fa-f]{2}'
const RUN = new RegExp(String.raw`(?<![0-9A-Za-z_.])(?:0x)?${BYTE}(?:(?:[ \t]{1,2}|, ?|[:;|-])?(?:0x)?${BYTE})*(?![0-9A-Za-z_])`, 'g')
/** Shorter runs count as numbers. */
const SHORT = 4
/** A line of a dump after other words: its offset and its bytes. */
const DUMPED = /(?:^|[^0-9A-Za-z])((?:0x)?[0-9a-fA-F]{4,8})(?:[:|]| (?= ?[0-9a-fA-F]{2}[ 0-9a-fA-F]))((?: {0,2}[0-9a-fA-F]{2})+)(?=\s*$|\s*[|>]|\s{2})/

/** A token that is almost a byte, between bytes. */
const ALMOST = new RegExp(String.raw`^[ \t]([0-9a-f][g-z]|[g-z][0-9a-f])[ \t]${BYTE}`, 'i')

const bytesOf = (run: string) => Uint8Array.from(run.replace(/0x/gi, '').match(/[0-9A-Fa-f]{2}/g) ?? [], (pair) => Number.parseInt(pair, 16))

interface Found {
  line: number
  /** The words before the bytes, with all digits alike. */
  label: string
  /** The text after them. */
  rest: string
  bytes: Uint8Array
  stream: Way
}

type Way = 'sent' | 'received' | null

/** Returns the direction shown by the words before the bytes; the last word counts. */
function way(words: string): Way {
  const last = (signs: RegExp) => Array.from(words.matchAll(signs)).at(-1)?.index ?? -1
  const [sent, received] = [last(SENT), last(RECEIVED)]
  return sent === received ? null : sent > received ? 'sent' : 'received'
}

/** Returns `true` if a line has a time, a level or a direction in front of its bytes. */
export const isLog = (source: string): boolean =>
  source.split('\n').some((line) => {
    const place = line.search(STAMP)
    return (place >= 0 && place < 12) || LEVEL.test(line)
  })

/** Returns the bytes of a log; `null` if they cannot be distinguished from other words. */
export function readLog(source: string, heads: Heads, spelled: Spelled): Segment[] | LogSlip | null {
  const begins = (bytes: Uint8Array) => heads.some((head) => head.every((byte, index) => bytes[index] === byte))
  const lines = source.split('\n')
  const dump = readDumped(lines)
  if (dump) return dump

  const found: Found[] = []
  let told: Way = null
  for (const [index, line] of lines.entries()) {
    const clean = without(line)
    const isEntry = clean !== line || LEVEL.test(line)
    const best = spelled(line) ?? longest(clean, begins)
    if (best) {
      const words = clean.slice(0, best.from)
      const here: Way = way(words.slice(-60)) ?? (isEntry ? null : told)
      found.push({ line: index + 1, label: words.replace(/\d/g, '0').replace(/\u0001+/g, '\u0001').trim().slice(-24), rest: clean.slice(best.to), bytes: best.bytes, stream: here })
    }
    const odd = /(?<![0-9A-Za-z_])[0-9a-fA-F]{9,}(?![0-9A-Za-z_])/.exec(clean)?.[0]
    if (odd && odd.length % 2 !== 0 && begins(bytesOf(odd.slice(0, -1)))) return { line: index + 1, token: odd.length }
    if (isEntry || !best) told = way(clean) ?? (isEntry ? null : told)
  }

  const labels = new Set(found.filter(({ bytes }) => begins(bytes)).map(({ label }) => label))
  if (labels.size === 0) return null
  const kept = found.filter(({ bytes, label }) => begins(bytes) || labels.has(label))
  for (const { line, rest } of kept) {
    // A digit is wrong, so the bytes after it would be lost.
    const token = ALMOST.exec(rest)?.[1]
    if (token !== undefined) return { line, token }
  }
  const ways = [...new Set(kept.map(({ stream }) => stream))]
  return kept.map(({ bytes, stream }) => ({ stream: ways.indexOf(stream), bytes }))
}

/** Returns the longest run of bytes in a line, or the one that begins a frame. */
function longest(line: string, begins: (bytes: Uint8Array) => boolean): Run | null {
  let best: Run | null = null
  for (const { 0: run, index } of line.matchAll(RUN)) {
    const to = index + run.length
    let bytes = bytesOf(run)
    // Some tools print a length in front.
    if (Number(/^\d+(?=\s)/.exec(run)?.[0]) === bytes.length - 1 && begins(bytes.subarray(1))) bytes = bytes.subarray(1)
    if (bytes.length < SHORT && !begins(bytes) && (line.slice(0, index) + line.slice(to)).trim() !== '') continue
    const better = best === null || (begins(bytes) && !begins(best.bytes)) || (begins(bytes) === begins(best.bytes) && bytes.length > best.bytes.length)
    if (better) best = { from: index, to, bytes }
  }
  return best
}

/** Reads dumps in a log, whose lines may have a time in front. */
function readDumped(lines: string[]): Segment[] | null {
  const dumps: string[] = []
  const ways: Way[] = []
  let told: Way = null
  for (const line of lines) {
    const clean = without(line)
    const [, offset, bytes] = DUMPED.exec(clean) ?? []
    if (offset === undefined || (dumps.length === 0 && Number.parseInt(offset, 16) !== 0)) {
      told = way(clean) ?? told
      continue
    }
    if (!ways.includes(told)) ways.push(told)
    dumps.push(`${' '.repeat(ways.indexOf(told))}${offset.replace(/^0x/, '')}: ${bytes.trim()}`)
  }
  const read = dumps.length > 0 ? readDump(dumps.join('\n')) : null
  return read && 'segments' in read ? read.segments : null
}
