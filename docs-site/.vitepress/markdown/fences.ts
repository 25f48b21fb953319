// Fences of the generated pages that the site draws. A frame's hexdump becomes the byte view. Sequence and state
// diagrams, the header's ruler and a table of layouts become pictures. Readers of the Markdown file see the text.

import type { MarkdownRenderer } from 'vitepress'
import { codec } from '../../lab/codec'
import { partsOf } from '../../lab/engine/parts'
import { readPaste } from '../../lab/engine/paste'
import { decodeFrame, messageFrame, protocol } from '../../lab/fc'
import { specPlaces, specText } from '../spec-pages'
import { html } from './html'
import { chains } from './states'

/** A value as a Vue prop inside a double-quoted attribute. */
const prop = (value: unknown) => html(JSON.stringify(value).replace(/</g, '\\u003c'))

function frame(text: string): string {
  const [whole, ...more] = readPaste(text, []).segments
  if (!whole || more.length > 0) throw new Error(`a frame's hexdump does not parse:\n${text}`)
  return frameOf(whole.bytes)
}

function frameOf(bytes: Uint8Array): string {
  const parts = partsOf(protocol, decodeFrame(codec, bytes))
  return `<FrameBytes :bytes="${prop(Array.from(bytes))}" :parts="${prop(parts)}" />\n`
}

/** `get_robot_sn request`, optionally followed by `gzip`: the frame of the spec's example. */
function example(text: string): string {
  const [name, side, packed] = text.trim().split(/\s+/)
  const operation = protocol.operations.find((operation) => operation.name === name)
  const response = side === 'response'
  const parts = { side: response ? 'response' : 'request', id: 1, gzip: packed === 'gzip' } as const
  const bytes = operation && messageFrame(codec, operation, parts, response ? operation.responseExample : operation.requestExample)
  if (!bytes) throw new Error(`there is no operation ${name} with a code`)
  return frameOf(bytes)
}

/** `App->>Robot: label`, `-->>` for a repeated or optional message. */
const ARROW = /^\s*(App|Robot)\s*(-->>|->>)\s*(App|Robot)\s*:\s*(.+)$/

function sequence(text: string): string {
  const steps = []
  for (const line of text.trim().split('\n').slice(1)) {
    const arrow = ARROW.exec(line)
    if (!arrow) throw new Error(`a line of a sequence diagram is not drawn: ${line}`)
    steps.push({ from: arrow[1].toLowerCase(), label: arrow[4], dashed: arrow[2] === '-->>' })
  }
  return `<SequencePicture :steps="${prop(steps)}" />\n`
}

const states = (text: string) => `<StatePicture :rows="${prop(chains(text))}" />\n`

const mermaid = (text: string) => (text.startsWith('stateDiagram') ? states(text) : sequence(text))

/** `1: left #1 = 1 3; right #2 = 2 4`: the row's number, its groups with their numbers and parts. */
function layouts(text: string): string {
  const rows = text.trim().split('\n').map((line) => {
    const [, label, groups] = /^(\S+): (.+)$/.exec(line) ?? []
    const cells = groups?.split('; ').map((group) => {
      const [, name, id, parts] = /^(.+) #(\d+) = ([\d ]+)$/.exec(group) ?? []
      if (!parts) throw new Error(`a group of a layout is not drawn: ${group}`)
      return { name, id: Number(id), parts: parts.split(' ').map(Number) }
    })
    if (!cells) throw new Error(`a layout is not drawn: ${line}`)
    return { label, cells }
  })
  return `<div class="fc-layouts">${rows
    .map((row) => `<DoorLayout :cells="${prop(row.cells)}" label="${html(row.label)}" />`)
    .join('')}</div>\n`
}

const ruler = () => `<ByteRuler :fields="${prop(protocol.header.map(({ name, ...field }) => ({ ...field, anchor: `header-${name}` })))}" />\n`

/** YAML of the spec. Each line has an anchor: the name that other pages link to, or else its number. */
function source(html: string, text: string): string {
  const places = specPlaces(text)
  let line = 0
  return html.replace(/<span class="line">/g, () => {
    const [name, ...others] = places.get(line++) ?? [`L${line}`]
    const more = others.map((other) => `<a id="${other}"></a>`).join('')
    return `<span class="line" id="${name}">${more}<a class="fc-line" href="#${name}" data-line="${line}" aria-label="L${line}"></a>`
  })
}

const DRAWN: Record<string, (text: string) => string> = {
  'fc-example': example,
  'fc-frame': frame,
  'fc-layout': layouts,
  'fc-ruler': ruler,
  mermaid,
}

/** A fence with a file of the spec and its name. */
const SOURCE = 'fc-source'

export function drawnFences(md: MarkdownRenderer): void {
  const plain = md.renderer.rules.fence!
  md.renderer.rules.fence = (tokens, index, options, env, self) => {
    const { info, content } = tokens[index]
    const draw = DRAWN[info.trim()]
    if (draw) return draw(content)
    if (info.trim() !== SOURCE) return plain(tokens, index, options, env, self)
    const text = specText(content.trim())
    const shown = Object.assign(Object.create(tokens[index]), { info: 'yaml', content: `${text}\n` })
    return source(plain(tokens.with(index, shown), index, options, env, self), text)
  }
}
