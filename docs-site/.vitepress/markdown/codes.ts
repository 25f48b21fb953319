// The page of command codes, sorted and with what is free.

import { hexNumber, protocol } from '../../lab/fc'
import type { Core, Tokens } from './tables'

/** The rows of a table's body: of each where it begins, where the next does, and its first cell. */
function rowsOf(tokens: Tokens, table: number) {
  const end = tokens.findIndex((token, index) => index > table && token.type === 'table_close')
  const starts = tokens.flatMap((token, index) => (index > table && index < end && token.type === 'tr_open' ? [index] : []))
  const last = tokens.findIndex((token, index) => index > table && token.type === 'tbody_close')
  return starts.slice(1).map((from, row, body) => ({ from, to: body[row + 1] ?? last, first: tokens[from + 2].content }))
}

/**
 * The map of codes. Committed, it is in the order of the groups and names no next free code: what any new
 * command changes would keep two branches from being merged. Here it is sorted, and says what is free.
 */
export function codeMap(tokens: Tokens, state: Parameters<Core>[0]): Tokens {
  const tables = tokens.flatMap((token, index) => (token.type === 'table_open' ? [index] : []))
  const taken = new Set<number>()
  for (const table of tables) {
    const rows = rowsOf(tokens, table)
    const coded = rows.filter(({ first }) => /^`0x[0-9A-F]{4}`(?: = |<br>)/.test(first))
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
    // After the largest that is taken, or the first gap once the end is reached, as `fc new` does it.
    const next = free.find((code) => !all.some((other) => other > code && taken.has(other))) ?? free[0]
    const open = (use === 'commands' || use === 'reports') && next !== undefined
    const code = open ? `\`${hexNumber(next, 4)}\`` : '—'
    made.push(cell(from, 'td', String(free.length)), cell(from, 'td', code))
  }
  // From the end, so that the places of the others hold; two at one place in their order.
  for (const [at, cells] of made.reverse()) tokens.splice(at, 0, ...cells)
  return tokens
}
