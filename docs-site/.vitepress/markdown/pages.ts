// What the site makes of the generated pages beyond their fences: links into the spec lead to the
// site's own pages of it, the line under a title becomes badges, what a picture shows already is not
// said again, and the list of open questions gets a filter.

import type { MarkdownRenderer } from 'vitepress'

type Core = Parameters<MarkdownRenderer['core']['ruler']['push']>[1]
type Tokens = Parameters<Core>[0]['tokens']

/** `../../spec/commands/cell.yaml#L41` */
const SPEC = /^(?:\.\.\/)+spec\/(.+)\.yaml(?:#(L\d+))?$/

function specLinks(tokens: Tokens, english: boolean): void {
  for (const token of tokens) {
    for (const child of token.children ?? []) {
      const href = child.type === 'link_open' ? child.attrGet('href') : null
      const found = href ? SPEC.exec(href) : null
      if (found) child.attrSet('href', `${english ? '/en' : ''}/spec/${found[1]}${found[2] ? '#' + found[2] : ''}`)
    }
  }
}

function badges(tokens: Tokens): void {
  tokens.forEach((token, index) => {
    const children = token.children ?? []
    if (!children.some((child) => child.type === 'html_inline' && child.content.startsWith('<span class="fc-badge'))) return
    tokens[index - 1].attrJoin('class', 'fc-badges')
    // The dots between them are for readers of the plain Markdown.
    for (const child of children) if (child.type === 'text' && child.content.trim() === '·') child.content = ' '
  })
}

/** The table behind a drawn frame says what the drawing says. */
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

function filter(tokens: Tokens): void {
  const first = tokens.find((token) => token.type === 'html_block' && token.content.includes('class="fc-question"'))
  if (first) first.content = `<QuestionFilter />\n\n${first.content}`
}

export function referencePages(md: MarkdownRenderer): void {
  md.core.ruler.push('fc-pages', (state) => {
    const page: string = state.env.relativePath ?? ''
    specLinks(state.tokens, page.startsWith('en/'))
    badges(state.tokens)
    state.tokens = withoutRepetition(state.tokens)
    if (page.endsWith('reference/open-questions.md')) filter(state.tokens)
  })
}
