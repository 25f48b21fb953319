// Fences of the generated pages that the site draws: a frame's hexdump becomes the byte view, a
// sequence diagram becomes a picture. Readers of the plain Markdown see the text itself.

import type { MarkdownRenderer } from 'vitepress'
import { parseHex } from '../lab/engine/bytes'
import { decodeFrame } from '../lab/engine/frame'
import { partsOf } from '../lab/engine/parts'
import { protocol } from '../lab/generated/protocol'

/** A value as a Vue prop inside a double-quoted attribute. */
function prop(value: unknown): string {
  return JSON.stringify(value).replace(/&/g, '&amp;').replace(/"/g, '&quot;').replace(/</g, '\\u003c').replace(/\{\{/g, '{ {')
}

function frame(text: string): string {
  const bytes = parseHex(text)
  if (!bytes) throw new Error(`a frame's hexdump does not parse:\n${text}`)
  const parts = partsOf(protocol, decodeFrame(protocol, bytes))
  return `<FrameBytes :bytes="${prop(Array.from(bytes))}" :parts="${prop(parts)}" />\n`
}

/** `App->>Robot: label`, `-->>` for what is sent again or only perhaps. */
const ARROW = /^\s*(App|Robot)\s*(-->>|->>)\s*(App|Robot)\s*:\s*(.+)$/

function sequence(text: string): string | null {
  const steps = []
  for (const line of text.split('\n')) {
    const arrow = ARROW.exec(line)
    if (arrow) steps.push({ from: arrow[1].toLowerCase(), label: arrow[4], dashed: arrow[2] === '-->>' })
  }
  return steps.length > 0 ? `<SequencePicture :steps="${prop(steps)}" />\n` : null
}

export function drawnFences(md: MarkdownRenderer): void {
  const plain = md.renderer.rules.fence
  md.renderer.rules.fence = (tokens, index, options, env, self) => {
    const { info, content } = tokens[index]
    if (info.trim() === 'fc-frame') return frame(content)
    if (info.trim() === 'mermaid') {
      const drawn = sequence(content)
      if (drawn) return drawn
    }
    return plain ? plain(tokens, index, options, env, self) : self.renderToken(tokens, index, options)
  }
}
