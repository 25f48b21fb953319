// Pages have no part that is cut off or covers another one: on a phone, a tablet, a desktop and paper.

import assert from 'node:assert/strict'
import { after, before, describe, test } from 'node:test'
import { alive, driven, withSite } from './browser.mjs'
import { cut, look, VIEWS } from './cut.mjs'
import { pages } from './site-pages.mjs'

describe('nothing is cut', driven, () => {
  const totals = new Map(VIEWS.map(({ name }) => [name, { table: 0, code: 0, picture: 0, badge: 0, cutTables: 0, cut: 0 }]))
  let site
  let page
  let close

  before(async () => {
    const closed = new Promise((done) => (close = done))
    await new Promise((ready, failed) => {
      withSite(async (made) => {
        site = made
        page = await made.open('/')
        ready()
        await closed
      }).catch(failed)
    })
  })

  after(() => {
    close?.()
    for (const [view, total] of totals) {
      console.log(`# ${view}: ${total.table} tables, ${total.cutTables} of them cut; ${total.code} samples, ${total.picture} pictures, ${total.badge} badges; ${total.cut} places cut in all`)
    }
  })

  for (const url of driven.skip ? [] : pages()) {
    test(`on ${url}`, async () => {
      await page.goto(site.base + url, { waitUntil: 'load' })
      await alive(page)
      const all = []
      for (const view of VIEWS) {
        await look(page, view)
        const found = await cut(page, view)
        const total = totals.get(view.name)
        for (const kind of Object.keys(found.counts)) total[kind] += found.counts[kind]
        total.cutTables += found.cut.filter((one) => one.startsWith('table: ')).length
        total.cut += found.cut.length
        all.push(...found.cut.map((one) => `${view.name}: ${one}`))
      }
      assert.deepEqual(all, [])
    })
  }
})
