// Tables that fit every screen. Tables of fields show nesting, and each field has a link. On a phone, each row of
// another wide table becomes a card with one line per column. Names in code may break between their words.

import type { MarkdownRenderer } from 'vitepress'

export type Core = Parameters<MarkdownRenderer['core']['ruler']['push']>[1]
export type Tokens = Parameters<Core>[0]['tokens']
type State = Parameters<Core>[0]
type Token = Tokens[number]

/** A table with more columns than fit on a phone. */
const WIDE = 4

interface Row {
  open: Token
  /** The opening and the content of each cell. */
  cells: { open: Token; content: Token }[]
}

/** The tables of a page: their opening, their columns and the rows of their bodies. */
function* found(tokens: Tokens): Generator<{ open: Token; heads: string[]; rows: Row[] }> {
  let open: Token | null = null
  let heads: string[] = []
  let rows: Row[] = []
  for (const [index, token] of tokens.entries()) {
    const content = tokens[index + 1]
    if (token.type === 'table_open') [open, heads, rows] = [token, [], []]
    else if (token.type === 'th_open') heads.push(words(content))
    else if (token.type === 'tr_open') rows.push({ open: token, cells: [] })
    else if (token.type === 'td_open') rows.at(-1)?.cells.push({ open: token, content })
    else if (token.type === 'table_close' && open) yield { open, heads, rows: rows.filter(({ cells }) => cells.length > 0) }
  }
}

/** The text of a cell, up to its first line break. */
function words(cell: Token): string {
  const children = cell.children ?? []
  const end = children.findIndex(({ type, content }) => type === 'html_inline' && content.startsWith('<br'))
  const line = end < 0 ? children : children.slice(0, end)
  return line.map(({ type, content }) => (type === 'html_inline' ? '' : content)).join('').trim()
}

const ANCHOR = /^<a id="([^"]+)">$/

/** A table of fields: each row begins with an anchor, and the columns are key, type, presence and meaning. */
const listsFields = (heads: string[], rows: Row[]) =>
  heads.length === 4 && rows.every(({ cells }) => ANCHOR.test(cells[0].content.children?.[0]?.content ?? ''))

/** Em spaces, which indent rows in the Markdown file. */
const INDENT = /^\u2003*/

/** Moves anchors to the rows and indentation to the style, and adds a link to each field. */
function fields(rows: Row[], state: State, english: boolean): void {
  const path: string[] = []
  for (const { open, cells } of rows) {
    const [key, type] = cells.map(({ content }) => content)
    const [anchor, , ...rest] = key.children ?? []
    const id = ANCHOR.exec(anchor.content)?.[1] ?? ''
    const depth = rest[0].type === 'text' ? INDENT.exec(rest[0].content)![0].length : 0
    rest[0].content = rest[0].content.slice(depth)
    const name = rest.find((child) => child.type === 'code_inline')
    // The name of a one-of form follows a word, and is not part of the path.
    const form = rest.some((child) => child.type === 'text' && child.content.trim())
    path.length = depth
    path.push(form ? '' : (name?.content ?? '') + (words(type).startsWith('[') ? '[]' : ''))
    const whole = path.filter(Boolean).join('.')
    if (name && !form && depth > 0) name.attrSet('title', whole.replace(/\[\]$/, ''))
    open.attrSet('id', id)
    open.attrSet('style', `--depth: ${depth}`)
    const link = new state.Token('html_inline', '', 0)
    const label = `${english ? 'Link to' : '链接到'} ${id}`
    link.content = `<a class="fc-here" href="#${id}" aria-label="${label}"></a>`
    key.children = [...rest, link]
  }
}

/** Positions at which a name may break: after dots, bars and underscores, and before capitals. Numbers do not break. */
export const breakable = (html: string) =>
  html.replace(/([_./:=]|-+(?=\w)|(?<=[a-z])(?<!0x)(?=[A-Z]))/g, (at) => `${at}<wbr>`)

export function tables(md: MarkdownRenderer): void {
  md.core.ruler.push('fc-tables', (state) => {
    const english = String(state.env.relativePath ?? '').startsWith('en/')
    for (const { open, heads, rows } of found(state.tokens)) {
      const ofFields = rows.length > 0 && listsFields(heads, rows)
      if (ofFields) {
        open.attrJoin('class', 'fc-fields')
        fields(rows, state, english)
      } else if (heads.length >= WIDE) open.attrJoin('class', 'fc-wide')
      for (const { cells } of rows) {
        for (const [column, { open, content }] of cells.entries()) {
          for (const child of content.children ?? []) if (child.type === 'code_inline') child.meta = { breakable: true }
          if (ofFields || heads.length < WIDE) continue
          if (content.content.trim() === '—') open.attrJoin('class', 'fc-none')
          if (heads[column]) open.attrSet('data-label', heads[column])
        }
      }
    }
  })
  // VitePress makes tables reachable by keyboard because its own scroll.
  md.renderer.rules.table_open = (tokens, index, options, _env, self) => self.renderToken(tokens, index, options)
  const plain = md.renderer.rules.code_inline!
  md.renderer.rules.code_inline = (tokens, index, options, env, self) => {
    const html = plain(tokens, index, options, env, self)
    if (!tokens[index].meta?.breakable) return html
    return html.replace(/^(<code[^>]*>)([\s\S]*)(<\/code>)$/, (_, open, text, close) => open + breakable(text) + close)
  }
}
