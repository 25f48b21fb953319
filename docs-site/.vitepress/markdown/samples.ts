// The same code in several languages. Consecutive fences with a name, such as ```ts [TypeScript], become tabs. The tabs
// are radio buttons with CSS only: they work with the keyboard, with screen readers and without scripts. Readers of the
// Markdown file see the fences one below the other.

import type { MarkdownRenderer } from 'vitepress'
import { html as escaped } from './html'
import type { Core, Tokens } from './tables'

/** A fence with a name: its language and the label of its tab. */
const NAMED = /^\w+ \[([^\]]+)\]$/

function html(state: Parameters<Core>[0], text: string): Tokens[number] {
  const token = new state.Token('html_block', '', 0)
  token.content = text
  return token
}

/** The buttons of a row of tabs. The first one is pressed. */
function buttons(names: string[], row: number, label: string): string {
  const each = names.map((name, index) => {
    const id = `code-${row}-${index + 1}`
    const checked = index === 0 ? ' checked' : ''
    return `<input type="radio" name="code-${row}" id="${id}" value="${escaped(name)}" autocomplete="off"${checked}><label for="${id}">${escaped(name)}</label>`
  })
  return `<div class="fc-samples" role="radiogroup" aria-label="${label}">${each.join('')}\n`
}

export function samples(md: MarkdownRenderer): void {
  md.core.ruler.push('fc-samples', (state) => {
    const label = String(state.env.relativePath ?? '').startsWith('en/') ? 'Programming language' : '编程语言'
    const name = (index: number) => (state.tokens[index]?.type === 'fence' ? NAMED.exec(state.tokens[index].info.trim())?.[1] : undefined)
    const kept: Tokens = []
    let row = 0
    for (let index = 0; index < state.tokens.length; index++) {
      const names: string[] = []
      while (name(index + names.length)) names.push(name(index + names.length)!)
      if (names.length < 2) {
        kept.push(state.tokens[index])
        continue
      }
      row += 1
      kept.push(html(state, buttons(names, row, label)))
      for (const fence of state.tokens.slice(index, index + names.length)) {
        kept.push(html(state, '<div class="fc-sample">'), fence, html(state, '</div>\n'))
      }
      kept.push(html(state, '</div>\n'))
      index += names.length - 1
    }
    state.tokens = kept
  })
}
