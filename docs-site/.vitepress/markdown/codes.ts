// The page of command codes: the used codes, sorted, and the free ones.

import { readFileSync } from 'node:fs'
import path from 'node:path'
import { hexNumber, protocol } from '../../lab/fc'
import { codeAnchor, isOpen, nextFree, unusedRuns, type UnusedRun } from '../code-map'
import type { Core, Tokens } from './tables'

type Token = Tokens[number]

/** The rows of a table's body: the start of each, the start of the next, and its first cell. */
function rowsOf(tokens: Tokens, table: number) {
  const end = tokens.findIndex((token, index) => index > table && token.type === 'table_close')
  const starts = tokens.flatMap((token, index) => (index > table && index < end && token.type === 'tr_open' ? [index] : []))
  const last = tokens.findIndex((token, index) => index > table && token.type === 'tbody_close')
  return starts.slice(1).map((from, row, body) => ({ from, to: body[row + 1] ?? last, first: tokens[from + 2].content }))
}

/** The table of all operations with a code. The overview has one table per group. */
function operations(state: Parameters<Core>[0]): Tokens {
  const overview = path.join(path.dirname(state.env.path), 'index.md')
  // VitePress builds this page again after a change of that one.
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

/** The first cell of a row with a used or a retired code. */
const CODED = /^`0x[0-9A-F]{4}`(?: = |<br>)/

/**
 * The map of codes. The committed page lists neither used nor free codes: each new command would change these
 * lists, and two branches could not be merged. The site adds both, the free codes first, each with an anchor.
 */
export function codeMap(page: Tokens, state: Parameters<Core>[0]): Tokens {
  const named = page.findIndex((token) => token.type === 'heading_open' && token.attrGet('id') === 'in-use')
  const place = page.findIndex((token, index) => index > named && token.type === 'heading_close') + 1
  // It replaces the sentence that refers to the lists.
  const rest = page.findIndex((token, index) => index > place && token.type === 'paragraph_close') + 1
  const tokens = named < 0 ? page : [...page.slice(0, place), ...operations(state), ...page.slice(rest)]
  const tables = tokens.flatMap((token, index) => (token.type === 'table_open' ? [index] : []))
  const taken = new Set<number>()
  for (const table of tables) {
    const rows = rowsOf(tokens, table)
    const coded = rows.filter(({ first }) => CODED.test(first))
    for (const { from, first } of coded) {
      const code = parseInt(first.slice(3), 16)
      // A stream may have the code of its command.
      if (!taken.has(code)) tokens[from].attrSet('id', codeAnchor(code))
      taken.add(code)
    }
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
  const ranges = tables.find((table) => rowsOf(tokens, table).some(({ first }) => first.includes('` … `')))
  if (ranges === undefined) return tokens
  const made: [number, Tokens][] = []
  const head = tokens.findIndex((token, index) => index > ranges && token.type === 'tr_open')
  made.push(cell(head, 'th', english ? 'Unused' : '未使用'), cell(head, 'th', english ? 'Next free' : '下一个可用'))
  const runs = unusedRuns(taken)
  const rangeAt = ({ first }: { first: string }) => protocol.ranges.findIndex((range) => range.first === parseInt(first.slice(3), 16))
  for (const row of rowsOf(tokens, ranges)) {
    const at = rangeAt(row)
    const own = runs.filter(({ range }) => range === at)
    const next = at >= 0 && isOpen(protocol.ranges[at]) ? nextFree(at, taken) : undefined
    const count = own.reduce((sum, { first, last }) => sum + last - first + 1, 0)
    made.push(cell(row.from, 'td', String(count)), cell(row.from, 'td', next === undefined ? '—' : `\`${hexNumber(next, 4)}\``))
    // The list of free codes has those of an open range.
    if (at >= 0 && !isOpen(protocol.ranges[at])) anchorsInto(tokens[row.from + 2], own, state)
  }
  // Inserting from the end keeps the other positions valid. Two at one position keep their order.
  for (const [at, cells] of made.reverse()) tokens.splice(at, 0, ...cells)
  // Ranges for new operations come first.
  const rows = rowsOf(tokens, ranges)
  const isFirst = (row: (typeof rows)[number]) => protocol.ranges[rangeAt(row)] !== undefined && isOpen(protocol.ranges[rangeAt(row)])
  const sorted = [...rows.filter(isFirst), ...rows.filter((row) => !isFirst(row))].flatMap(({ from, to }) => tokens.slice(from, to))
  tokens.splice(rows[0].from, sorted.length, ...sorted)
  const section = tokens.findLastIndex((token, index) => index < ranges && token.type === 'heading_open')
  tokens.splice(section, 0, ...freeCodes(runs, taken, english, state))
  return tokens
}

/** Adds an anchor to a cell for each code of the runs. */
function anchorsInto(cell: Token, runs: UnusedRun[], state: Parameters<Core>[0]): void {
  const anchor = new state.Token('html_inline', '', 0)
  for (const { first, last } of runs) for (let code = first; code <= last; code++) anchor.content += `<a id="${codeAnchor(code)}"></a>`
  if (anchor.content) cell.children = [anchor, ...(cell.children ?? [])]
}

/** The section of codes that a new operation may take. */
function freeCodes(runs: UnusedRun[], taken: Set<number>, english: boolean, state: Parameters<Core>[0]): Tokens {
  const free = runs.filter(({ range }) => isOpen(protocol.ranges[range]))
  if (free.length === 0) return []
  const spelled = (code: number) => `\`${hexNumber(code, 4)}\``
  const rows = free.map(({ first, last, range }) => {
    const codes = first === last ? spelled(first) : `${spelled(first)} … ${spelled(last)}`
    const next = nextFree(range, taken)
    const isNext = next !== undefined && first <= next && next <= last
    return `| ${codes} | ${last - first + 1} | ${protocol.ranges[range].use === 'commands' ? (english ? 'new commands' : '新增指令') : english ? 'new reports' : '新增主动上报'} | ${isNext ? spelled(next) : '—'} |`
  })
  const [title, text, outside, ...heads] = english
    ? ['Free codes', 'A new operation takes the next free code; `fcproto new` finds it.', 'Codes outside of all ranges are not assigned.', 'Free', 'Number', 'For', 'Next free']
    : ['可用的功能码', '新接口取下一个可用的功能码，由 `fcproto new` 给出。', '号段以外的功能码不分配。', '可用', '个数', '用于', '下一个可用']
  const markdown = `<a id="free"></a>\n\n## ${title}\n\n${text}\n\n| ${heads.join(' | ')} |\n|---|---|---|---|\n${rows.join('\n')}\n\n<a id="outside"></a>${outside}\n`
  const tokens = state.md.parse(markdown, {})
  const table = tokens.findIndex(({ type }) => type === 'table_open')
  rowsOf(tokens, table).forEach(({ from }, index) => anchorsInto(tokens[from + 2], [free[index]], state))
  return tokens
}
