// The page of command codes: those in use, sorted, and what is free.

import { readFileSync } from 'node:fs'
import path from 'node:path'
import { hexNumber, protocol } from '../../lab/fc'
import type { Core, Tokens } from './tables'

/** The rows of a table's body: of each where it begins, where the next does, and its first cell. */
function rowsOf(tokens: Tokens, table: number) {
  const end = tokens.findIndex((token, index) => index > table && token.type === 'table_close')
  const starts = tokens.flatMap((token, index) => (index > table && index < end && token.type === 'tr_open' ? [index] : []))
  const last = tokens.findIndex((token, index) => index > table && token.type === 'tbody_close')
  return starts.slice(1).map((from, row, body) => ({ from, to: body[row + 1] ?? last, first: tokens[from + 2].content }))
}

/** The table of the operations with a code: the overview has them by group, in a table each. */
function operations(state: Parameters<Core>[0]): Tokens {
  const overview = path.join(path.dirname(state.env.path), 'index.md')
  // VitePress makes this page again when that one changes.
  state.env.includes?.push(overview)
  const tokens = state.md.parse(readFileSync(overview, 'utf8'), {})
  const tables = tokens.flatMap((token, index) => (token.type === 'table_open' ? [index] : []))
  const rows = tables.map((table) => rowsOf(tokens, table).filter(({ first }) => CODED.test(first)))
  const first = rows.findIndex((found) => found.length > 0)
  if (first < 0) return []
  const body = rows.flat().flatMap(({ from, to }) => tokens.slice(from, to))
  const end = tokens.findIndex((token, index) => index > tables[first] && token.type === 'tbody_close')
  return [...tokens.slice(tables[first], rows[first][0].from), ...body, ...tokens.slice(end, end + 2)]
}

/** The first cell of a row with a code in use, or with one that is retired. */
const CODED = /^`0x[0-9A-F]{4}`(?: = |<br>)/

/**
 * The map of codes. Committed, it lists neither the codes in use nor the next free one: what any new command
 * changes would keep two branches from being merged. Here it has both, sorted.
 */
export function codeMap(page: Tokens, state: Parameters<Core>[0]): Tokens {
  const named = page.findIndex((token) => token.content === '<a id="in-use"></a>')
  const place = page.findIndex((token, index) => index > named && token.type === 'heading_close') + 1
  // In the place of the sentence that says where they are listed.
  const rest = page.findIndex((token, index) => index > place && token.type === 'paragraph_close') + 1
  const tokens = named < 0 ? page : [...page.slice(0, place), ...operations(state), ...page.slice(rest)]
  const tables = tokens.flatMap((token, index) => (token.type === 'table_open' ? [index] : []))
  const taken = new Set<number>()
  for (const table of tables) {
    const rows = rowsOf(tokens, table)
    const coded = rows.filter(({ first }) => CODED.test(first))
    for (const { first } of coded) taken.add(parseInt(first.slice(3), 16))
    if (!coded.length || coded.length < rows.length) continue
    const sorted = [...rows].sort((a, b) => (a.first < b.first ? -1 : 1)).flatMap(({ from, to }) => tokens.slice(from, to))
    tokens.splice(rows[0].from, sorted.length, ...sorted)
  }

  const english = (state.env.relativePath ?? '').startsWith('en/')
  const cell = (row: number, kind: 'th' | 'td', words: string): [number, Tokens] => {
    const close = tokens.findIndex((token, index) => index > row && token.type === 'tr_close')
    const inline = state.md.parse(words, {}).find(({ type }) => type === 'inline')!
    return [close, [new state.Token(`${kind}_open`, kind, 1), inline, new state.Token(`${kind}_close`, kind, -1)]]
  }
  const made: [number, Tokens][] = []
  const ranges = tables.find((table) => rowsOf(tokens, table).some(({ first }) => first.includes('` … `')))
  if (ranges === undefined) return tokens
  const head = tokens.findIndex((token, index) => index > ranges && token.type === 'tr_open')
  made.push(cell(head, 'th', english ? 'Unused' : '未使用'), cell(head, 'th', english ? 'Next free' : '下一个可用'))
  for (const { from, first } of rowsOf(tokens, ranges)) {
    const [low, high] = Array.from(first.matchAll(/0x([0-9A-F]{4})/g), ([, hex]) => parseInt(hex, 16))
    const use = protocol.ranges.find((range) => range.first === low)?.use
    const all = Array.from({ length: high - low + 1 }, (_, offset) => low + offset)
    const free = all.filter((code) => !taken.has(code))
    // After the largest that is taken, or the first gap once the end is reached, as `fcproto new` does it.
    const next = free.find((code) => !all.some((other) => other > code && taken.has(other))) ?? free[0]
    const open = (use === 'commands' || use === 'reports') && next !== undefined
    const code = open ? `\`${hexNumber(next, 4)}\`` : '—'
    made.push(cell(from, 'td', String(free.length)), cell(from, 'td', code))
  }
  // From the end, so that the places of the others hold; two at one place in their order.
  for (const [at, cells] of made.reverse()) tokens.splice(at, 0, ...cells)
  return tokens
}
