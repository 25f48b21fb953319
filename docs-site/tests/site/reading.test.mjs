// Readers' needs: fields nest and have links, a phone shows blocks, paper shows all content and no controls, and every
// operation is reachable.

import assert from 'node:assert/strict'
import { readFileSync } from 'node:fs'
import path from 'node:path'
import { test } from 'node:test'
import { site as folder } from '../support.mjs'
import { alive, driven, withSite } from './browser.mjs'
import { look, VIEWS } from './cut.mjs'
import { html, pages, pageWithMost } from './site-pages.mjs'

const [PHONE, , DESKTOP, PAPER] = VIEWS
const LANGUAGES = ['zh', 'en']
const depths = (html) => Array.from(html.matchAll(/style="--depth:\s*(\d)/g), ([, depth]) => Number(depth))
const deepest = (language) => pageWithMost((html) => Math.max(0, ...depths(html)), language)
const navigation = JSON.parse(readFileSync(path.join(folder, 'reference/navigation.json'), 'utf8'))

test('a field lies further in than what it lies in', driven, async () => {
  await withSite(async ({ open }) => {
    for (const language of LANGUAGES) {
      const page = await open(deepest(language))
      for (const view of [DESKTOP, PHONE, PAPER]) {
        await look(page, view)
        const rows = await page.locator('.fc-fields tbody tr').evaluateAll((rows) =>
          rows.map((row) => {
            const range = document.createRange()
            range.selectNodeContents(row.cells[0])
            return { table: Array.from(document.querySelectorAll('.fc-fields')).indexOf(row.closest('table')), steps: row.id.split('-').length, left: Math.round(range.getBoundingClientRect().left) }
          }),
        )
        for (const [index, row] of rows.entries()) {
          const before = rows[index - 1]
          if (!before || before.table !== row.table) continue
          assert.equal(Math.sign(row.left - before.left), Math.sign(row.steps - before.steps), `${view.name}: row ${index} of ${page.url()}`)
        }
        assert.ok(new Set(rows.map(({ left }) => left)).size >= 3, 'three steps at least')
      }
    }
  })
})

test('the link of a field works with and without scripts', driven, async () => {
  await withSite(async ({ base, open, faults }) => {
    const url = deepest('en')
    const page = await open(url, { reducedMotion: 'reduce' })
    await alive(page)
    const row = page.locator('.fc-fields tbody tr').last()
    const link = row.locator('.fc-here')
    const seen = () => link.evaluate((element) => Number(getComputedStyle(element).opacity) > 0.5)
    assert.equal(await seen(), false)
    await row.scrollIntoViewIfNeeded()
    await row.hover()
    assert.equal(await seen(), true)
    await link.click()
    const id = await row.getAttribute('id')
    await page.waitForURL((now) => now.hash === `#${id}`)
    for (const javaScriptEnabled of [true, false]) {
      for (const { width, height } of [DESKTOP, PHONE]) {
        const opened = await open(undefined, { javaScriptEnabled, viewport: { width, height } })
        await opened.goto(`${base}${url}#${id}`, { waitUntil: 'load' })
        if (javaScriptEnabled) await alive(opened)
        await opened.waitForFunction(() => scrollY > 0)
        // Fixed elements at the top of the screen do not cover it.
        await opened.waitForFunction((id) => {
          const { left, top, height } = document.getElementById(id).querySelector('code').getBoundingClientRect()
          const seen = document.elementFromPoint(left + 4, top + height / 2)
          return top < innerHeight && seen?.closest('tr')?.id === id
        }, id)
      }
    }
    assert.deepEqual(faults, [])
  })
})

test('phones show fields as blocks and wide tables as cards', driven, async () => {
  await withSite(async ({ open }) => {
    const page = await open(deepest('zh'))
    await look(page, PHONE)
    const fields = await page.locator('.fc-fields tbody tr').evaluateAll((rows) =>
      rows.map((row) => {
        const [key, type, presence, meaning] = Array.from(row.cells, (cell) => cell.getBoundingClientRect())
        return { below: type.top >= key.bottom && meaning.top >= type.bottom, beside: presence.left >= type.right && presence.top < type.bottom }
      }),
    )
    assert.ok(fields.length > 0)
    assert.deepEqual(fields.filter(({ below, beside }) => !below || !beside), [])

    const url = pageWithMost((html) => html.split('class="fc-wide"').length, 'zh')
    const wide = await open(url)
    const heads = await wide.locator('.fc-wide').evaluateAll((tables) => tables.map((table) => Array.from(table.tHead.rows[0].cells, (cell) => cell.textContent.trim())))
    await look(wide, PHONE)
    const named = await wide.locator('.fc-wide').evaluateAll((tables) =>
      tables.map((table) => Array.from(table.tBodies[0].rows, (row) => Array.from(row.cells, (cell) => JSON.parse(getComputedStyle(cell, '::before').content)))),
    )
    assert.ok(named.length > 0)
    named.forEach((rows, table) => rows.forEach((row) => row.forEach((name, column) => assert.ok(heads[table][column] === '' || (name !== '' && heads[table][column].startsWith(name)), `"${name}" instead of ${heads[table][column]}`))))
    assert.equal(await wide.locator('.fc-wide thead:visible').count(), 0)
  })
})

test('print has only the text, black on white, with every byte', driven, async () => {
  await withSite(async ({ open }) => {
    const url = pageWithMost((html) => html.split('class="fc-more').length, 'en')
    const page = await open()
    await page.addInitScript(() => localStorage.setItem('vitepress-theme-appearance', 'dark'))
    await page.goto(new URL(url, await siteOf(open)).href, { waitUntil: 'load' })
    await alive(page)
    assert.ok(await page.locator('.fc-more').count(), 'a frame is folded')
    await look(page, PAPER)
    await page.waitForFunction(() => !document.querySelector('.fc-more'))
    for (const gone of ['.VPNav', '.VPLocalNav', '.VPSidebar', '.VPDocFooter', '.VPDoc .aside', 'button.copy']) {
      assert.equal(await page.locator(`${gone}:visible`).count(), 0, gone)
    }
    const light = await page.evaluate(() => {
      const sum = (color) => color.match(/[\d.]+/g).slice(0, 3).reduce((sum, part) => sum + Number(part), 0)
      const texts = [...document.querySelectorAll('.vp-doc p, .vp-doc td, .vp-code .line span')]
      return { ground: sum(getComputedStyle(document.body).backgroundColor), palest: Math.max(...texts.map((text) => sum(getComputedStyle(text).color))) }
    })
    assert.ok(light.ground > 750 && light.palest < 400, JSON.stringify(light))
    // The text takes the whole width.
    const { x, width } = await page.locator('.vp-doc').first().boundingBox()
    assert.ok(x < 2 && width > PAPER.width - 4, `${x} ${width}`)
  })
})

test('whole frames open in the lab', driven, async () => {
  const framed = pages().filter((url) => html(url).includes('class="fc-frame"') && !/\/lab\//.test(url))
  const wrong = []
  for (const url of framed) {
    const frames = html(url).split('<div class="fc-frame"').slice(1)
    for (const frame of frames) {
      const [, length] = /aria-label="(\d+) (?:字节|bytes)"/.exec(frame)
      const [, to, hex] = /data-do="open-in-lab" href="([^"#]*)#hex=([0-9A-F]+)"|href="([^"#]*)#hex=([0-9A-F]+)"[^>]*data-do="open-in-lab"/.exec(frame)?.filter((part) => part !== undefined) ?? []
      const shown = Array.from(frame.matchAll(/class="fc-byte[^>]*>([0-9A-F]{2})</g), ([, byte]) => byte).join('')
      if (!hex || hex.length !== 2 * length || !hex.startsWith(shown)) wrong.push(url)
      else if (to !== `${url.startsWith('/en/') ? '/en' : ''}/lab/index.html`) wrong.push(`${url}: ${to}`)
    }
  }
  assert.ok(framed.length > 50)
  assert.deepEqual(wrong, [])
  // The Markdown shows all of it as well.
  assert.deepEqual(pages().filter((url) => /\d+ bytes left out|略去 \d+ 字节/.test(html(url))), [])
  await withSite(async ({ open, faults }) => {
    for (const url of ['/reference/commands/get_cell_config.html', '/en/index.html']) {
      const page = await open(url)
      await alive(page)
      const link = page.locator('[data-do=open-in-lab]').last()
      const hex = (await link.getAttribute('href')).split('#hex=')[1]
      await link.click()
      await page.locator('[data-out=overall][data-level=good]').waitFor()
      assert.equal((await page.locator('[data-field=hex]').inputValue()).replaceAll(' ', ''), hex)
    }
    assert.deepEqual(faults, [])
  })
})

/** The base of the site. */
async function siteOf(open) {
  const page = await open('/')
  return page.url()
}

test('a long frame shows all its bytes when asked', driven, async () => {
  await withSite(async ({ open, faults }) => {
    const page = await open(pageWithMost((html) => html.split('class="fc-more').length, 'zh'))
    await alive(page)
    const frame = page.locator('.fc-frame').filter({ has: page.locator('.fc-more') }).first()
    const all = Number(/\d+/.exec(await frame.locator('.fc-more').textContent())[0])
    const before = await frame.locator('.fc-byte').count()
    assert.ok(before < all)
    await frame.locator('.fc-more').click()
    await frame.locator('.fc-more').waitFor({ state: 'detached' })
    assert.equal(await page.locator('.fc-frame').evaluateAll((frames, all) => frames.some((frame) => frame.querySelectorAll('.fc-byte').length === all), all), true)
    assert.deepEqual(faults, [])
  })
})

test('every operation is reachable from the home page and the sidebar', driven, async () => {
  await withSite(async ({ open, faults }) => {
    for (const language of LANGUAGES) {
      const base = language === 'en' ? '/en/' : '/'
      const page = await open(base)
      await alive(page)
      await page.locator('.fc-map').waitFor()
      const items = navigation.groups.flatMap((group) => group.items)
      const links = await page.locator('.fc-map a').evaluateAll((links) => links.map((link) => [new URL(link.href).pathname, link.textContent]))
      assert.deepEqual(links.map(([to]) => to), items.map(({ link }) => `${base}reference/${link}.html`))
      items.forEach((item, index) => assert.ok(links[index][1].includes(item[language]) && links[index][1].includes(item.code ?? '—')))
      assert.deepEqual(await page.locator('.fc-map h3').allTextContents(), navigation.groups.map((group) => group[language]))

      const reference = await open(`${base}reference/index.html`)
      await alive(reference)
      const sidebar = await reference.locator('.VPSidebar a').evaluateAll((links) => links.map((link) => new URL(link.href).pathname))
      assert.deepEqual(items.filter(({ link }) => !sidebar.includes(`${base}reference/${link}.html`)), [])
    }
    assert.deepEqual(faults, [])
  })
})

test('titles have badges, and drawn frames have no table', driven, async () => {
  await withSite(async ({ open }) => {
    const operations = pages().filter((url) => /\/reference\/(commands|reports|streams)\//.test(url))
    assert.deepEqual(operations.filter((url) => !/<p class="fc-badges">(?!<\/p>)[^·]*<\/p>/.test(html(url).replace(/<\/?(?:span|code)\b[^>]*>|<!--.*?-->/g, ''))), [])
    assert.deepEqual(operations.filter((url) => /class="fc-parts"(?:(?!<h[123]).)*<table/s.test(html(url))), [])
    const page = await open(operations[0])
    const bare = await page.locator('.fc-badges .fc-badge').evaluateAll((badges) => badges.filter((badge) => {
      const { borderRadius, backgroundColor, boxShadow } = getComputedStyle(badge)
      return Number.parseFloat(borderRadius) < 8 || (backgroundColor === 'rgba(0, 0, 0, 0)' && boxShadow === 'none')
    }).length)
    assert.equal(bare, 0)
    assert.ok((await page.locator('.fc-badges .fc-badge').count()) > 4)
  })
})
