// The search box in the page. `queries.json` has the queries and their hits.

import assert from 'node:assert/strict'
import { test } from 'node:test'
import { alive, driven, withSite } from './browser.mjs'

for (const [language, base, query] of [
  ['Chinese', '/', '回充'],
  ['English', '/en/', 'recharge'],
]) {
  test(`the search box finds in ${language}, marks what it found and leads there`, driven, async () => {
    await withSite(async ({ base: site, open, faults }) => {
      const page = await open(base)
      await alive(page)
      await page.locator('.VPNavBarSearch button').first().click()
      await page.locator('#localsearch-input').fill(query)
      await page.locator('.VPLocalSearchBox mark').first().waitFor()
      const hits = page.locator('.VPLocalSearchBox a.result')
      const found = await hits.evaluateAll((all) => all.map((one) => new URL(one.href).pathname))
      assert.match(found[0], /\/reference\/(commands|reports)\/\w*recharge\w*\.html$/)
      assert.deepEqual(found.filter((url) => url.startsWith('/en/') !== (base === '/en/')), [], 'of the other language')
      await hits.first().click()
      await page.waitForURL((url) => url.href.startsWith(site + found[0]))
      assert.deepEqual(faults, [])
    })
  })
}
