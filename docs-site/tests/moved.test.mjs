// Links to moved sections lead to their new addresses.

import assert from 'node:assert/strict'
import { existsSync, readFileSync } from 'node:fs'
import path from 'node:path'
import { test } from 'node:test'
import { load, site } from './support.mjs'

const { MOVED, leadOn, movedFrom } = await load(`export * from './.vitepress/moved'`)

/** The anchors that a page's source names. */
const anchors = (file) => Array.from(readFileSync(file, 'utf8').matchAll(/\{#([\w-]+)\}$/gm), ([, name]) => name)

/** The address to which the script in a page's head leads from an anchor. `there` has the anchors of the page. */
function led(moved, hash, there = []) {
  let to = null
  const location = { hash, replace: (place) => (to = place) }
  const document = { getElementById: (id) => (there.includes(id) ? {} : null) }
  new Function('location', 'document', 'addEventListener', leadOn(moved))(location, document, (_, then) => then())
  return to
}

for (const [page, { anchors: places = {}, others }] of Object.entries(MOVED)) {
  for (const language of ['', 'en']) {
    test(`${path.join(language, page)}: what has moved is on its new page, and no longer on this one`, () => {
      const source = (name) => path.join(site, language, path.dirname(page), name)
      const old = anchors(source(`${path.basename(page)}.md`))
      for (const [anchor, place] of Object.entries(places)) {
        const [name, target] = place.split('#')
        const file = source(name.replace(/\.html$/, '.md'))
        assert.ok(existsSync(file), place)
        if (target) assert.ok(anchors(file).includes(target), place)
        assert.ok(!old.includes(anchor), `${anchor} is still there`)
      }
      if (others) assert.ok(existsSync(source(others.replace(/\.html$/, '.md'))), others)
    })
  }
}

test('a moved anchor leads to its new place, others stay', () => {
  const promises = movedFrom('guides/promises.md')
  assert.equal(movedFrom('en/guides/promises.md'), promises)
  assert.equal(movedFrom('en/guides/limits.md'), undefined)
  assert.equal(led(promises, '#chaos'), 'testing.html#chaos')
  for (const hash of ['', '#', '#calls', '#constructor', '#%']) assert.equal(led(promises, hash), null, hash)
})

test('an anchor missing from its page leads to the results', () => {
  const performance = movedFrom('guides/performance.md')
  assert.equal(led(performance, '#%E5%B8%A7', ['summary']), 'performance-results.html#%E5%B8%A7')
  for (const hash of ['', '#summary', '#%']) assert.equal(led(performance, hash, ['summary']), null, hash)
})
