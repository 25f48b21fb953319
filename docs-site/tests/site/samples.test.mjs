// Samples in several languages: every operation has them, one choice applies to all pages, and all are reachable without
// scripts.

import assert from 'node:assert/strict'
import { test } from 'node:test'
import { engine, needs } from '../support.mjs'
import { alive, driven, withSite } from './browser.mjs'
import { look, VIEWS } from './cut.mjs'
import { html, pages, pageWithMost } from './site-pages.mjs'

const built = needs(!driven.skip, driven.skip)
const PAPER = VIEWS.find(({ media }) => media === 'print')
const COMMAND = '/reference/commands/get_robot_sn.html'
const REPORT = /\/reference\/reports\//

/** The languages of each row of tabs of a page. */
const rows = (url) => Array.from(html(url).matchAll(/<div class="fc-samples"[^>]*>(.*)/g), ([, row]) => Array.from(row.matchAll(/<label[^>]*>([^<]+)</g), ([, name]) => name))

/** The language that each row of tabs shows, by the class of its code, and the state of its buttons. */
const shown = (page) =>
  page.locator('.fc-samples').evaluateAll((all) =>
    all.map((row) => {
      const seen = Array.from(row.querySelectorAll('.fc-sample')).filter((sample) => sample.checkVisibility())
      const classes = seen.map((sample) => /language-(\w+)/.exec(sample.innerHTML)[1])
      return `${row.querySelector('input:checked').value} ${classes.join(' ')}`
    }),
  )
const PYTHON = ['Python python', 'Python python']
const RUST = ['Rust rust', 'Rust rust']

test('app and robot samples have the same languages', built, async () => {
  const { protocol } = await engine()
  const languages = rows(COMMAND)[0]
  assert.ok(['Rust', 'TypeScript', 'Python'].every((language) => languages.includes(language)), languages.join())
  const missing = protocol.operations
    .filter(({ code, kind }) => code !== null && kind !== 'stream')
    .flatMap(({ name, kind }) => ['', '/en'].map((language) => `${language}/reference/${kind}s/${name}.html`))
    .filter((url) => JSON.stringify(rows(url)) !== JSON.stringify([languages, languages]))
  assert.deepEqual(missing, [])
})

test('without scripts each language can be looked at', driven, async () => {
  await withSite(async ({ open }) => {
    const page = await open(COMMAND, { javaScriptEnabled: false })
    assert.deepEqual(await shown(page), RUST)
    for (const [language, code] of [['TypeScript', 'ts'], ['Python', 'python']]) {
      await page.locator('.fc-samples label', { hasText: language }).first().click()
      assert.deepEqual(await shown(page), [`${language} ${code}`, RUST[1]])
    }
  })
})

test('a language chosen by keyboard applies to all code without scrolling', driven, async () => {
  await withSite(async ({ open, faults }) => {
    // The code above is longer in one language than in the other.
    const difference = (html) => {
      const above = html.split('class="fc-samples"')[1] ?? ''
      const lines = (language) => above.split(`class="language-${language} `)[1]?.split('</pre>')[0].split('class="line"').length ?? 0
      return Math.abs(lines('rust') - lines('python'))
    }
    // Some browsers keep the scroll position automatically, others do not.
    for (const anchor of ['auto', 'none']) {
      const page = await open(pageWithMost(difference, 'zh'))
      await alive(page)
      await page.addStyleTag({ content: `* { overflow-anchor: ${anchor} !important }` })
      assert.deepEqual(await shown(page), RUST)
      const row = page.locator('.fc-samples').last()
      await row.scrollIntoViewIfNeeded()
      await row.locator('input').first().focus()
      const outline = await row.locator('label').first().evaluate((label) => getComputedStyle(label).outlineStyle)
      assert.notEqual(outline, 'none')
      const top = () => row.evaluate((element) => Math.round(element.getBoundingClientRect().top))
      const height = () => page.locator('.fc-samples').first().evaluate((element) => element.offsetHeight)
      const [before, high] = [await top(), await height()]
      await page.keyboard.press('ArrowLeft')
      const last = await row.locator('input').last().getAttribute('value')
      assert.equal(await row.locator('input:checked').getAttribute('value'), last)
      while ((await row.locator('input:checked').getAttribute('value')) !== 'Python') await page.keyboard.press('ArrowLeft')
      assert.deepEqual(await shown(page), PYTHON, 'other code does not follow')
      assert.notEqual(await height(), high, 'nothing above has changed')
      assert.ok(Math.abs((await top()) - before) <= 1, `${before} became ${await top()}`)
    }
    assert.deepEqual(faults, [])
  })
})

test('the choice applies to other pages and later visits', driven, async () => {
  await withSite(async ({ base, browser, open, faults }) => {
    const page = await open(COMMAND)
    await alive(page)
    await page.locator('.fc-samples label', { hasText: 'Python' }).first().click()
    const heading = await page.locator('h1').textContent()
    const report = pages().find((url) => REPORT.test(url) && !url.startsWith('/en/') && rows(url).length === 2)
    await page.evaluate((url) => document.body.append(Object.assign(document.createElement('a'), { href: url, id: 'elsewhere', textContent: 'x' })), report)
    await page.locator('#elsewhere').evaluate((link) => link.click())
    await page.waitForURL((now) => now.pathname === report)
    await page.waitForFunction((was) => document.querySelector('h1')?.textContent !== was, heading)
    assert.deepEqual(await shown(page), PYTHON, 'not where a link leads')
    await page.goto(`${base}/en${COMMAND}`)
    await alive(page)
    assert.deepEqual(await shown(page), PYTHON, 'not in the other language')

    // The chosen language shows before the site's scripts run.
    const context = await browser.newContext({ storageState: await page.context().storageState() })
    await context.route('**/*.js', (route) => route.abort())
    const bare = await context.newPage()
    await bare.goto(base + COMMAND, { waitUntil: 'domcontentloaded' })
    assert.deepEqual(await shown(bare), PYTHON, 'not before the scripts')
    assert.deepEqual(faults, [])
  })
})

test('print has the chosen code and its language only', driven, async () => {
  await withSite(async ({ open }) => {
    const page = await open(COMMAND)
    await alive(page)
    await page.locator('.fc-samples label', { hasText: 'Python' }).first().click()
    await look(page, PAPER)
    assert.equal((await shown(page))[0], PYTHON[0])
    assert.deepEqual(await page.locator('.fc-samples').first().locator('label:visible').allTextContents(), ['Python'])
  })
})
