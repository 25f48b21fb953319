// The rows of a state diagram on the site.

import assert from 'node:assert/strict'
import { test } from 'node:test'
import { load } from './support.mjs'

const { chains } = await load(`export * from './.vitepress/markdown/states'`)

/** One line per arrow, as on the generated pages. `*a b`: a is a start. `b c!`: c is an end. */
function diagram(...lines) {
  const names = [...new Set(lines.flatMap((line) => line.replace(/[*!]/g, '').split(' ')))]
  const id = (name) => `s${names.indexOf(name)}`
  const boxes = names.map((name) => `  state "${name}" as ${id(name)}`)
  const arrows = lines.flatMap((line) => {
    const words = line.split(' ')
    const bare = words.map((word) => word.replace(/[*!]/g, ''))
    const outside = words.flatMap((word, at) => [
      ...(word.startsWith('*') ? [`  [*] --> ${id(bare[at])}`] : []),
      ...(word.endsWith('!') ? [`  ${id(bare[at])} --> [*]`] : []),
    ])
    return [...outside, ...bare.slice(1).map((to, at) => `  ${id(bare[at])} --> ${id(to)}`)]
  })
  return ['stateDiagram-v2', ...boxes, ...arrows].join('\n')
}

/** A row as one line. Starts have a `*`, ends a `!`. */
const shown = (...lines) =>
  chains(diagram(...lines)).map(({ states, choice }) => {
    const row = states.map(({ name, starts, ends }) => `${starts ? '*' : ''}${name}${ends ? '!' : ''}`).join(' ')
    return choice.length > 0 ? `${row} (${choice.join('|')})` : row
  })

const CASES = [
  ['a chain is one row', ['*a b', 'b c', 'c d!'], ['*a b c d!']],
  ['a choice ends a row', ['*a b', 'b c!', 'b d!'], ['*a b (c|d)']],
  ['what a choice leads to goes on below', ['*a b', 'a c', 'b d', 'c d!'], ['*a (b|c)', 'b d!', 'c d!']],
  ['a circle without a beginning is shown once', ['a b', 'b a'], ['a b a']],
  ['the beginning comes first, wherever it stands', ['c d!', '*a b', 'b c'], ['*a b c d!']],
  ['a way back leads to a row above', ['*a b', 'b a'], ['*a b *a']],
  ['a state without an arrow has a row', ['*a b', '*c!'], ['*a b', '*c!']],
]

for (const [name, lines, rows] of CASES) test(name, () => assert.deepEqual(shown(...lines), rows))

test('an invalid state diagram is refused', () => {
  assert.throws(() => chains('stateDiagram-v2\n  s0 --> s1'), /no box/)
  assert.throws(() => chains('stateDiagram-v2\n  note left of s0'), /not drawn/)
})
