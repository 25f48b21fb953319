// Ids of headings. Both languages have the same ids, for the outline, the search and the language switch.
//
// Generated pages have an anchor above each heading, which becomes its id. The title of a page has one id everywhere.
// Other headings of a Chinese page without an id get that of the English page.

import { existsSync, readFileSync } from 'node:fs'
import { fileURLToPath } from 'node:url'
import type { MarkdownRenderer } from 'vitepress'

/** A paragraph with only an anchor. */
const ANCHOR = /^<a id="([^"]+)"><\/a>$/

/** Front matter, which would parse as a heading. */
const FRONT = /^---\n[^]*?\n---\n/

const english = (page: string) => fileURLToPath(new URL(`../../en/${page}`, import.meta.url))

export function anchoredHeadings(md: MarkdownRenderer): void {
  // Before VitePress makes an id of the words of a heading.
  md.core.ruler.before('anchor', 'fc-headings', (state) => {
    const { tokens } = state
    for (let index = tokens.length - 1; index >= 0; index--) {
      const heading = tokens[index]
      if (heading.type !== 'heading_open') continue
      if (heading.tag === 'h1' && !heading.attrGet('id')) heading.attrSet('id', 'top')
      const above = tokens.slice(Math.max(0, index - 3), index)
      const id = above[0]?.type === 'paragraph_open' && above.length === 3 ? ANCHOR.exec(above[1].content)?.[1] : undefined
      if (id === undefined) continue
      heading.attrSet('id', id)
      tokens.splice(index - 3, 3)
    }
    const headings = tokens.filter(({ type }) => type === 'heading_open')
    const page: string = state.env.relativePath ?? 'en/'
    if (page.startsWith('en/') || headings.every((heading) => heading.attrGet('id')) || !existsSync(english(page))) return
    const there = state.md.parse(readFileSync(english(page), 'utf8').replace(FRONT, ''), { path: english(page), realPath: english(page) }).filter(({ type }) => type === 'heading_open')
    if (there.length !== headings.length) return
    headings.forEach((heading, index) => heading.attrSet('id', heading.attrGet('id') ?? there[index].attrGet('id') ?? ''))
  })
}
