// Nothing that a page shows is cut off or lies over something else: on a phone, a tablet, a desktop and paper.

import assert from 'node:assert/strict'
import { test } from 'node:test'
import { alive, driven, withSite } from './browser.mjs'
import { cut, look, VIEWS } from './cut.mjs'
import { pages } from './site-pages.mjs'

test('nothing is cut on any page, at any width, in print', driven, async () => {
  await withSite(async ({ base, open }) => {
    const page = await open('/')
    const totals = new Map(VIEWS.map(({ name }) => [name, { table: 0, code: 0, picture: 0, badge: 0 }]))
    const wrong = new Map(VIEWS.map(({ name }) => [name, []]))
    for (const url of pages()) {
      await page.goto(base + url, { waitUntil: 'load' })
      await alive(page)
      for (const view of VIEWS) {
        await look(page, view)
        const found = await cut(page, view)
        for (const kind of Object.keys(found.counts)) totals.get(view.name)[kind] += found.counts[kind]
        wrong.get(view.name).push(...found.cut.map((one) => `${url}: ${one}`))
      }
    }
    for (const [view, total] of totals) {
      const all = wrong.get(view)
      const tables = all.filter((one) => one.includes(': table: ')).length
      console.log(`# ${view}: ${total.table} tables, ${tables} of them cut; ${total.code} samples, ${total.picture} pictures, ${total.badge} badges; ${all.length} places in all`)
    }
    const all = [...wrong].flatMap(([view, all]) => all.map((one) => `${view} ${one}`))
    assert.deepEqual(all.slice(0, 60), [], `${all.length} places are cut`)
  })
})
