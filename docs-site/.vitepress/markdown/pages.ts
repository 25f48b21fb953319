// Changes to pages outside of their fences. Links into the spec lead to the site's pages of it. The line under a title
// becomes badges. Text that a picture already shows is removed. The lists of open questions and codes get a filter.

import type { MarkdownRenderer } from 'vitepress'
import { codeMap } from './codes'
import { tables, type Core, type Tokens } from './tables'

/** `../../spec/commands/cell.yaml#commands.get_cell_config` */
const SPEC = /^(?:\.\.\/)+spec\/(.+)\.yaml(#.+)?$/

function specLinks(tokens: Tokens, english: boolean): void {
  for (const token of tokens) {
    for (const child of token.children ?? []) {
      const href = child.type === 'link_open' ? child.attrGet('href') : null
      const found = href ? SPEC.exec(href) : null
      if (found) child.attrSet('href', `${english ? '/en' : ''}/spec/${found[1]}${found[2] ?? ''}`)
    }
  }
}

/** References of packages. Other tools write these pages, so the browser opens them instead of the site's router. */
export const API = /^\/api\//

function apiLinks(tokens: Tokens): void {
  for (const token of tokens) {
    for (const child of token.children ?? []) {
      // With `target`, VitePress would omit the base.
      if (child.type === 'link_open' && API.test(child.attrGet('href') ?? '')) child.attrJoin('class', 'vp-raw')
    }
  }
}

function badges(tokens: Tokens): void {
  tokens.forEach((token, index) => {
    const children = token.children ?? []
    // Links in a table cell stay below each other.
    if (tokens[index - 1]?.type !== 'paragraph_open') return
    if (!children.some((child) => child.type === 'html_inline' && child.content.startsWith('<span class="fc-badge'))) return
    tokens[index - 1].attrJoin('class', 'fc-badges')
    // The dots between them serve readers of the Markdown file.
    for (const child of children) if (child.type === 'text' && child.content.trim() === '·') child.content = ' '
  })
}

/** Removes the table after a drawn frame, because the drawing has the same content. */
function withoutRepetition(tokens: Tokens): Tokens {
  const kept: Tokens = []
  let hidden = false
  tokens.forEach((token, index) => {
    const before = tokens[index - 1]
    if (token.type === 'table_open' && before?.type === 'fence' && before.info.trim() === 'fc-frame') hidden = true
    if (!hidden) kept.push(token)
    if (token.type === 'table_close') hidden = false
  })
  return kept
}

function filter(tokens: Tokens, state: Parameters<Core>[0]): void {
  const first = tokens.findIndex((token) => token.type === 'html_block' && token.content.includes('class="fc-question"'))
  if (first < 0) return
  // Above the heading of the first category.
  const heading = tokens.slice(0, first).findLastIndex((token) => token.type === 'heading_open' && token.tag === 'h3')
  const made = new state.Token('html_block', '', 0)
  made.content = '<QuestionFilter />\n'
  tokens.splice(heading < 0 ? first : heading, 0, made)
}

/** Follows the list of audiences, if there is one. */
function audienceFilter(tokens: Tokens, state: Parameters<Core>[0]): void {
  const listed = tokens.findIndex((token) => token.type === 'inline' && token.content.startsWith('<a id="audience-'))
  if (listed < 0) return
  const end = tokens.findIndex((token, index) => index > listed && token.type === 'table_close')
  const made = new state.Token('html_block', '', 0)
  made.content = '<AudienceFilter />\n'
  tokens.splice(end + 1, 0, made)
}

export function referencePages(md: MarkdownRenderer): void {
  md.core.ruler.push('fc-pages', (state) => {
    const page: string = state.env.relativePath ?? ''
    specLinks(state.tokens, page.startsWith('en/'))
    apiLinks(state.tokens)
    badges(state.tokens)
    state.tokens = withoutRepetition(state.tokens)
    if (page.endsWith('reference/codes.md')) {
      state.tokens = codeMap(state.tokens, state)
      audienceFilter(state.tokens, state)
    }
    if (page.endsWith('reference/open-questions.md')) filter(state.tokens, state)
  })
  tables(md)
}
