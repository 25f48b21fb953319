// The site contains everything in the resolved spec, in both languages.

import assert from 'node:assert/strict'
import { execFileSync } from 'node:child_process'
import { existsSync, readFileSync } from 'node:fs'
import path from 'node:path'
import { test } from 'node:test'
import { dist, needs, obligatory, root } from '../support.mjs'

const built = needs(existsSync(path.join(dist, 'index.html')), 'needs the built site (npm run build)')

function inspect() {
  const command = ['run', '--quiet', ...(obligatory ? ['--locked'] : []), '--bin', 'fcproto', '--', 'inspect', '--format', 'json']
  return JSON.parse(execFileSync('cargo', command, { cwd: root, encoding: 'utf8', maxBuffer: 1 << 28 }))
}

const UNESCAPED = { amp: '&', lt: '<', gt: '>', quot: '"', '#39': "'" }

/** The visible text of a page, without white space. */
function text(file) {
  const html = readFileSync(path.join(dist, file), 'utf8')
  const main = html.slice(html.indexOf('<main'), html.indexOf('</main>'))
  return main
    .replace(/<[^>]*>/g, '')
    .replace(/&(amp|lt|gt|quot|#39);/g, (_, name) => UNESCAPED[name])
    .replace(/[\s\u200b]+/g, '')
}

/** A sentence of the spec without Markdown syntax. */
const read = (sentence) => sentence.replace(/[`*_\\]|\]\([^)]*\)|\[|^- /gm, '').replace(/\s+/g, '')
const bare = (words) => words.replace(/[`*_[\]]/g, '')

/** The content of each code span. */
function codes(html) {
  const spans = html.matchAll(/<code\b[^>]*>([\s\S]*?)<\/code>/g)
  return Array.from(spans, ([, span]) => span.replace(/<[^>]*>/g, '').replace(/&(amp|lt|gt|quot|#39);/g, (_, name) => UNESCAPED[name]))
}

/** The rows of field tables by anchor: the key and the depth of each. */
function rows(html) {
  const rows = new Map()
  for (const [, id, depth, key] of html.matchAll(/<tr id="([^"]+)" style="--depth:\s*(\d+);?">\s*<td\b[^>]*>([\s\S]*?)<\/td>/g)) {
    assert.ok(!rows.has(id), `two fields share the anchor ${id}`)
    rows.set(id, { key: codes(key)[0], depth: Number(depth) })
  }
  return rows
}

test('the site has every operation, field, enum value, result code and question', built, () => {
  const spec = inspect()
  const counts = { operations: 0, fields: 0, values: 0, results: 0, questions: 0 }
  const missing = []
  for (const [language, base] of [['zh', ''], ['en', 'en/']]) {
    const cache = new Map()
    const page = (name) => {
      if (!cache.has(name)) {
        const file = `${base}reference/${name}.html`
        const there = existsSync(path.join(dist, file))
        const html = there ? readFileSync(path.join(dist, file), 'utf8') : ''
        cache.set(name, { text: there ? bare(text(file)) : '', codes: new Set(codes(html)), rows: rows(html) })
      }
      return cache.get(name)
    }
    /** A sentence or a number anywhere in the text. */
    const want = (name, what, kind) => {
      counts[kind]++
      if (!page(name).text.includes(bare(read(String(what))))) missing.push(`${language} ${name}: ${what}`)
    }
    /** A name that fills a code span. */
    const named = (name, what, kind) => {
      counts[kind]++
      if (!page(name).codes.has(what)) missing.push(`${language} ${name}: \`${what}\``)
    }
    for (const operation of spec.operations) {
      const name = `${operation.kind}s/${operation.name}`
      want(name, operation[language], 'operations')
      named(name, operation.name, 'operations')
      named('index', operation.name, 'operations')
      if (operation.code !== null) {
        want(name, '0x' + operation.code.toString(16).toUpperCase().padStart(4, '0'), 'operations')
        want(name, operation.code, 'operations')
      }
      for (const [side, body] of [['request', operation.request], ['response', operation.response]]) {
        for (const field of body?.fields ?? []) {
          // A path that ends in `[]` is the item of an array. Its row is that of its type.
          if (field.path.endsWith('[]')) continue
          const keys = field.path.replaceAll('[]', '').split('.')
          // The form of a one-of is between a key and its fields.
          const found = [...page(name).rows].find(([id, row]) => {
            const steps = id.split('-')
            const rest = steps.slice(1).filter((step) => keys.includes(step))
            return steps[0] === side && rest.join('.') === keys.join('.') && row.key === keys.at(-1) && row.depth === steps.length - 2
          })
          counts.fields++
          if (!found) missing.push(`${language} ${name}: no row of ${side} ${field.path}`)
          want(name, field[language], 'fields')
        }
      }
    }
    for (const type of spec.types) {
      if (type.kind === 'enum') {
        for (const value of type.values) {
          named('types', value.name, 'values')
          want('types', value[language], 'values')
          named('types', typeof value.value === 'string' ? JSON.stringify(value.value) : String(value.value), 'values')
        }
      }
    }
    for (const range of spec.ranges) {
      if (range.next !== null) named('codes', '0x' + range.next.toString(16).toUpperCase().padStart(4, '0'), 'operations')
    }
    const spelled = Array.from(page('codes').text.matchAll(/0x([0-9A-F]{4})=?(\d{1,5})/g))
    const listed = spelled.filter(([, hex, decimal]) => parseInt(hex, 16) === Number(decimal)).map(([, hex]) => hex)
    if (listed.join() !== [...listed].sort().join() || !listed.length) missing.push(`${language} codes: not in order`)
    for (const result of spec.result_codes) {
      want('results', result.code, 'results')
      want('results', result[language], 'results')
    }
    for (const question of spec.open_questions) {
      want('open-questions', question.id, 'questions')
      want('open-questions', question.gap[language], 'questions')
      want('open-questions', question[language], 'questions')
    }
  }
  console.log(`# looked for ${Object.entries(counts).map(([kind, count]) => `${count} ${kind}`).join(', ')}`)
  assert.deepEqual(missing.slice(0, 40), [], `${missing.length} missing`)
})
