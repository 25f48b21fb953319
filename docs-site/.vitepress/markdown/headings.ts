// Ids of headings. Generated pages have an anchor above each heading, the same in both languages: it becomes the id of
// the heading, so that the outline, the search and the language switch all lead to one place.

import type { MarkdownRenderer } from 'vitepress'

/** A paragraph of nothing but an anchor. */
const ANCHOR = /^<a id="([^"]+)"><\/a>$/

export function anchoredHeadings(md: MarkdownRenderer): void {
  // Before VitePress makes an id of the words of a heading.
  md.core.ruler.before('anchor', 'fc-headings', (state) => {
    const { tokens } = state
    for (let index = tokens.length - 4; index >= 0; index--) {
      const [open, inline, , heading] = tokens.slice(index, index + 4)
      const id = open.type === 'paragraph_open' && heading.type === 'heading_open' ? ANCHOR.exec(inline.content)?.[1] : undefined
      if (id === undefined) continue
      heading.attrSet('id', id)
      tokens.splice(index, 3)
    }
  })
}
