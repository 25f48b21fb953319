// What is asked for is found first.

import assert from 'node:assert/strict'
import { test } from 'node:test'
import { alive, driven, withSite } from './browser.mjs'

const RECHARGE = /\/reference\/(commands\/(start_recharge|cancel_recharge|get_recharge_status)|reports\/recharge_progress)\.html/
const CELL = /\/reference\/commands\/[gs]et_cell_config\.html/
const SERIAL = /\/reference\/commands\/get_robot_sn\.html/

const CHINESE = [
  ['充电', RECHARGE], ['电桩', RECHARGE], ['充电桩', RECHARGE], ['回充', RECHARGE], ['取消回充', /cancel_recharge/],
  ['格口', CELL], ['分格表', /tables\.html|cell_config/],
  ['0x0A01', SERIAL], ['0x0a01', SERIAL], ['2561', SERIAL], ['robotSn', SERIAL], ['get_robot_sn', SERIAL], ['序列号', SERIAL],
  ['stationType', /station|types/], ['C001', /open-questions/],
  ['字节序', /wire|what-changed/], ['抓包', /guides\/reading-a-capture/],
]
const ENGLISH = [
  ['recharge', RECHARGE], ['charging pile', RECHARGE], ['compartment', CELL],
  ['0x0A01', SERIAL], ['2561', SERIAL], ['robotSn', SERIAL], ['get_robot_sn', SERIAL], ['serial number', SERIAL],
  ['porting', /guides\/porting/], ['C001', /open-questions/],
]

for (const [language, base, queries] of [
  ['Chinese', '/', CHINESE],
  ['English', '/en/', ENGLISH],
]) {
  test(`search in ${language}`, driven, async () => {
    await withSite(async ({ open, faults }) => {
      const page = await open(base)
      await alive(page)
      await page.locator('.VPNavBarSearch button').first().click()
      const input = page.locator('#localsearch-input')
      await input.waitFor()
      const wrong = []
      for (const [query, right] of queries) {
        await input.fill('')
        await input.fill(query)
        await page.waitForFunction(() => document.querySelector('.VPLocalSearchBox .result'), null, { timeout: 15000 }).catch(() => {})
        // The list settles when the query's own hits are marked.
        await page.waitForTimeout(350)
        const found = await page.locator('.VPLocalSearchBox a.result').evaluateAll((all) =>
          all.slice(0, 4).map((one) => new URL(one.href).pathname + new URL(one.href).hash),
        )
        console.log(`# ${query}: ${found.join('  ')}`)
        if (!right.test(found[0] ?? '')) wrong.push(`${query}: ${found.join(' ')}`)
        if (!base.startsWith('/en') !== !(found[0] ?? '').startsWith('/en/')) wrong.push(`${query}: the other language`)
      }
      assert.deepEqual(wrong, [])
      // Hits are marked in what is shown, Chinese ones too.
      await input.fill(queries[0][0])
      await page.locator('.VPLocalSearchBox mark').first().waitFor({ timeout: 5000 }).catch(() => {})
      await input.fill(language === 'Chinese' ? '回充' : 'recharging')
      await page.locator('.VPLocalSearchBox mark').first().waitFor()
      assert.deepEqual(faults, [])
    })
  })
}
