// axe finds no barrier on a page of each kind: in both languages, light and dark, on a phone and a desktop.

import assert from 'node:assert/strict'
import { readFileSync } from 'node:fs'
import { createRequire } from 'node:module'
import { test } from 'node:test'
import { engine } from '../support.mjs'
import { alive, driven, withSite } from './browser.mjs'
import { look, VIEWS } from './cut.mjs'
import { pages } from './site-pages.mjs'

const axe = readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8')

/** One page of each kind. */
const KINDS = [
  /^\/index\.html$/, /^\/guides\//, /^\/lab\//, /^\/spec\/commands\//, /^\/reference\/commands\//, /^\/reference\/reports\//, /^\/reference\/streams\//,
  ...['index', 'wire', 'codes', 'types', 'tables', 'results', 'changelog', 'open-questions', 'errors'].map((page) => new RegExp(`^/reference/${page}\\.html$`)),
]

/** The lab with two frames, the second invalid. It then has a list, a red verdict and an expected value. */
async function faultyCapture() {
  const { codec, hex, messageFrame, protocol, toHash } = await engine()
  const operation = protocol.operations.find(({ kind, code }) => kind === 'command' && code !== null)
  const state = { paste: '', operation: operation.name, side: 'request', id: 1, gzip: false, json: '{ // why\n}' }
  const frame = messageFrame(codec, operation, state, operation.requestExample)
  const damaged = Uint8Array.from(frame, (byte, at) => (at === frame.length - 1 ? byte ^ 1 : byte))
  return `/lab/index.html#${toHash({ ...state, paste: `${hex(frame)} ${hex(damaged)}` })}`
}

/** Accepted barriers of VitePress: rule, elements, reason. */
const THEIRS = [
  ['nested-interactive', '.VPSidebarItem > .item', 'the head of a group in the sidebar is a button around the button with its arrow'],
  ['landmark-one-main', 'html:has(.VPHome)', 'the home page has no main element, and its layout no slot around all of it'],
  ['region', '#VPContent:has(.VPHome), .VPHome *', 'the same: what the home page shows lies in no landmark'],
  ['label-content-name-mismatch', '.DocSearch', 'the name of the search button lacks the keys that open it'],
]

const WIDTHS = VIEWS.filter(({ name }) => name === '390 px' || name === '1440 px')

for (const appearance of ['light', 'dark']) {
  test(`axe finds nothing (${appearance})`, driven, async () => {
    await withSite(async ({ base, open }) => {
      const chinese = pages().filter((url) => !url.startsWith('/en/'))
      const urls = KINDS.map((kind) => chinese.find((url) => kind.test(url))).filter(Boolean)
      urls.push(await faultyCapture())
      const page = await open(undefined, { bypassCSP: true, reducedMotion: 'reduce' })
      await page.addInitScript((appearance) => localStorage.setItem('vitepress-theme-appearance', appearance), appearance)
      const wrong = new Map()
      let looked = 0
      for (const url of urls.flatMap((url) => [url, `/en${url}`])) {
        await page.goto(base + url, { waitUntil: 'load' })
        await alive(page)
        await page.evaluate(axe)
        for (const view of WIDTHS) {
          await look(page, view)
          const violations = await page.evaluate(async (theirs) => {
            const { violations } = await window.axe.run(document, { resultTypes: ['violations'], elementRef: true })
            const known = (id, element) => theirs.some(([rule, selector]) => rule === id && element.matches(selector))
            return violations.flatMap(({ id, impact, nodes }) =>
              nodes.filter(({ element }) => !known(id, element)).map(({ target, any }) => ({ id, impact, target: target.join(' '), why: any[0]?.message ?? '' })),
            )
          }, THEIRS)
          looked++
          for (const { id, impact, target, why } of violations) {
            const what = `${id} (${impact}): ${target}`
            if (!wrong.has(what)) wrong.set(what, `${what} on ${url} at ${view.name}: ${why}`)
          }
        }
      }
      console.log(`# ${looked} views in ${appearance}`)
      assert.deepEqual([...wrong.values()].slice(0, 40), [], `${wrong.size} kinds of violations`)
    })
  })
}
