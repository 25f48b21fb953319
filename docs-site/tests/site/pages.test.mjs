// Every page has no errors, sends no request to another host, is complete without scripts and small enough. Navigation
// between pages works.

import assert from 'node:assert/strict'
import { existsSync, readFileSync, readdirSync } from 'node:fs'
import path from 'node:path'
import { test } from 'node:test'
import { gzipSync } from 'node:zlib'
import { dist, needs } from '../support.mjs'
import { alive, driven, withSite } from './browser.mjs'
import { html, pages } from './site-pages.mjs'

const built = needs(existsSync(path.join(dist, 'index.html')), 'needs the built site (npm run build)')

test('no page has an error or asks another host', driven, async () => {
  await withSite(async ({ base, open, faults }) => {
    const page = await open('/')
    const all = pages()
    for (const url of all) {
      await page.goto(base + url, { waitUntil: 'load' })
      await alive(page)
    }
    console.log(`# ${all.length} pages`)
    assert.deepEqual(faults, [])
  })
})

test('an unknown address has an error page in its language', driven, async () => {
  await withSite(async ({ base, open }) => {
    const page = await open()
    for (const [url, words] of [['/nothing.html', '页面不存在'], ['/en/nothing.html', 'Page not found']]) {
      const answer = await page.goto(base + url)
      assert.equal(answer.status(), 404)
      await page.getByText(words).first().waitFor()
    }
  })
})

test('a link to a moved section leads to its new page', driven, async () => {
  await withSite(async ({ base, open, faults }) => {
    const page = await open()
    for (const [from, to] of [
      ['/guides/promises.html#chaos', '/guides/testing.html#chaos'],
      ['/en/guides/connection.html#data', '/en/guides/data-port.html'],
      ['/en/guides/performance.html#frame-codec', '/en/guides/performance-results.html#frame-codec'],
    ]) {
      await page.goto(base + from, { waitUntil: 'commit' })
      await page.waitForURL(base + to)
    }
    assert.deepEqual(faults, [])
  })
})

test('the language switch stays on the same page', driven, async () => {
  await withSite(async ({ base, open, faults }) => {
    const page = await open('/')
    for (const url of ['/index.html', '/reference/commands/get_robot_sn.html', '/reference/open-questions.html', '/lab/index.html', '/guides/first-call.html', '/spec/commands/cell.html']) {
      await page.goto(base + url)
      await alive(page)
      // On a busy machine, the menu may close before the click.
      const to = async (word, isThere, attempts = 3) => {
        await page.locator('.VPNavBarTranslations button').hover()
        await page.locator('.VPNavBarTranslations').getByText(word, { exact: true }).click()
        try {
          await page.waitForURL((now) => isThere(now.pathname), { timeout: 15_000 })
        } catch (error) {
          if (attempts === 1) throw error
          await page.mouse.move(0, 500)
          await to(word, isThere, attempts - 1)
        }
      }
      const bare = (url) => url.replace(/index\.html$/, '')
      await to('English', (path) => path.startsWith('/en/'))
      assert.equal(bare(new URL(page.url()).pathname), bare('/en' + url))
      await to('简体中文', (path) => !path.startsWith('/en/'))
      assert.equal(bare(new URL(page.url()).pathname), bare(url))
    }
    assert.deepEqual(faults, [])
  })
})

test('headings have the same ids in both languages', built, () => {
  // A list may be sorted by the words of its language.
  const ids = (url) => Array.from(html(url).matchAll(/<h[1-6]\b[^>]*? id="([^"]*)"/g), ([, id]) => id).sort()
  const different = pages()
    .filter((url) => !url.startsWith('/en/'))
    .filter((url) => JSON.stringify(ids(url)) !== JSON.stringify(ids(`/en${url}`)))
  assert.deepEqual(different, [])
})

test('the language switch stays in the same section', driven, async () => {
  await withSite(async ({ open, faults }) => {
    const url = pages().find((url) => /^\/en\/reference\/commands\//.test(url) && html(url).includes('id="open-questions-and-decisions"'))
    const page = await open(`${url}#open-questions-and-decisions`)
    await alive(page)
    await page.locator('.VPNavBarTranslations button').hover()
    await page.locator('.VPNavBarTranslations').getByText('简体中文', { exact: true }).click()
    await page.waitForURL((now) => now.pathname === url.replace('/en', '') && now.hash === '#open-questions-and-decisions')
    await page.locator('h2#open-questions-and-decisions', { hasText: '疑问与决定' }).waitFor()
    assert.deepEqual(faults, [])
  })
})

test('a page that fails offline loads after reconnecting', driven, async () => {
  await withSite(async ({ open }) => {
    const follow = (page, to) =>
      page.evaluate((to) => {
        const link = Object.assign(document.createElement('a'), { href: to, textContent: 'x' })
        document.body.append(link)
        link.click()
      }, to)
    for (const [home, url, words, unknown] of [
      ['/guides/testing.html', '/reference/commands/get_cell_config.html', '没有网络连接', '页面不存在'],
      ['/en/guides/testing.html', '/en/reference/commands/get_cell_config.html', 'No connection', 'Page not found'],
    ]) {
      const page = await open(home)
      await alive(page)
      await follow(page, url.replace('get_cell_config', 'get_cell_confiq'))
      await page.getByText(unknown).first().waitFor()
      await page.context().setOffline(true)
      await follow(page, url)
      await page.locator('[data-out=no-connection]').getByText(words, { exact: true }).waitFor()
      assert.equal(await page.getByText(unknown).count(), 0)
      await page.context().setOffline(false)
      await page.locator('.fc-frame').first().waitFor()
    }
  })
})

test('a part that fails offline is reported', driven, async () => {
  await withSite(async ({ open }) => {
    const page = await open('/en/guides/testing.html')
    await alive(page)
    await page.context().setOffline(true)
    await page.locator('.VPNavBarSearch button').first().click()
    await page.locator('[data-out=no-part]').waitFor()
  })
})

test('the item of the page is in view in the sidebar', driven, async () => {
  await withSite(async ({ open, faults }) => {
    const seen = (page) =>
      page.waitForFunction(() => {
        const item = document.querySelector('.VPSidebarItem.is-link.is-active > .item')
        if (!item) return false
        const { top, bottom } = item.getBoundingClientRect()
        const { left, width } = document.querySelector('.VPSidebar').getBoundingClientRect()
        return top >= 0 && bottom <= innerHeight && (left >= 0 || width === 0 || -left <= width)
      })
    const deep = '/reference/reports/task_progress.html'
    for (const width of [375, 1440]) {
      const page = await open(deep, { viewport: { width, height: 700 } })
      await alive(page)
      if (width < 960) await page.locator('.VPLocalNav .menu').click()
      await seen(page)
      assert.equal(await page.evaluate(() => scrollY), 0, 'the page itself stays')
    }
    assert.deepEqual(faults, [])
  })
})

test('each code has an anchor, and free codes come first', driven, async () => {
  await withSite(async ({ base, open }) => {
    for (const language of ['', '/en']) {
      const text = html(`${language}/reference/codes.html`)
      const ids = Array.from(text.matchAll(/ id="(0x[0-9a-f]{4})"/g), ([, id]) => id)
      assert.equal(new Set(ids).size, ids.length, 'a code has two places')
      assert.ok(['0x0a01', '0x0aff', '0x0b01', '0x0204', '0x0303'].every((id) => ids.includes(id)))
      const places = ['id="free"', 'id="ranges"', 'id="in-use"'].map((id) => text.indexOf(id))
      assert.ok(places.every((at, index) => at > 0 && (index === 0 || at > places[index - 1])), places.join())
      const page = await open()
      await page.goto(`${base}${language}/reference/codes.html#0x0aff`)
      await alive(page)
      const row = page.locator('tr:has(a[id="0x0aff"])')
      await page.waitForFunction(() => {
        const { top, bottom } = document.getElementById('0x0aff').closest('tr').getBoundingClientRect()
        return top >= 0 && bottom <= innerHeight
      })
      assert.match(await row.textContent(), /0x0AFF/)
    }
  })
})

test('the changelog has headings of years', built, () => {
  for (const language of ['', '/en']) {
    const levels = Array.from(html(`${language}/reference/changelog.html`).matchAll(/<h([23]) id="([^"]+)"/g), ([, level, id]) => [level, id])
    const years = levels.filter(([level]) => level === '2').map(([, id]) => id)
    assert.ok(years.length > 1 && years.every((id) => /^\d{4}$|^date-unknown$/.test(id)), years.join())
    assert.deepEqual([...years].sort().reverse(), [...years].sort().reverse())
    let year = ''
    for (const [level, id] of levels) {
      if (level === '2') year = id
      else assert.ok(id.startsWith(`on-${year}`), `${id} below ${year}`)
    }
  }
})

test('each page loads less than 300 kB compressed', driven, async () => {
  await withSite(async ({ base, browser }) => {
    const heaviest = pages()
      .filter((url) => !url.startsWith('/en/'))
      .map((url) => [gzipSync(readFileSync(path.join(dist, url))).length, url])
      .sort(([a], [b]) => b - a)
      .slice(0, 3)
      .map(([, url]) => url)
    for (const url of ['/index.html', '/reference/index.html', '/reference/commands/get_robot_sn.html', '/lab/index.html', ...heaviest]) {
      const context = await browser.newContext()
      const page = await context.newPage()
      const sizes = []
      page.on('requestfinished', (request) => {
        // Files that Chromium prefetches for the next page do not count.
        if (request.headers()['sec-purpose'] === 'prefetch') return
        sizes.push(request.sizes().then(({ responseBodySize }) => responseBodySize))
      })
      await page.goto(base + url, { waitUntil: 'networkidle' })
      // Requests that end with the closed page have no size.
      page.removeAllListeners('requestfinished')
      const total = (await Promise.all(sizes)).reduce((sum, size) => sum + size, 0)
      console.log(`# ${url}: ${Math.round(total / 1000)} kB`)
      assert.ok(total < 300_000, `${url}: ${total} bytes`)
      await context.close()
    }
  })
})

test('no page but the lab loads the protocol as data', built, () => {
  const folder = path.join(dist, 'assets/chunks')
  const own = readdirSync(folder).filter((name) => name.endsWith('.js') && !name.startsWith('@'))
  const holders = own.filter((name) => readFileSync(path.join(folder, name), 'utf8').includes('requestExample'))
  assert.deepEqual(holders.map((name) => name.split('.')[0]), ['FrameLab'])
})

test('open questions are complete without scripts, and the filter works', driven, async () => {
  await withSite(async ({ open, faults }) => {
    const bare = await open('/reference/open-questions.html', { javaScriptEnabled: false })
    const all = await bare.locator('.fc-question').count()
    assert.ok(all > 100)
    assert.equal(await bare.locator('.fc-question:visible').count(), all)
    assert.equal(await bare.locator('.fc-filter:visible').count(), 0)

    const page = await open('/reference/open-questions.html')
    await page.locator('.fc-filter').waitFor({ state: 'visible' })
    const shown = () => page.locator('.fc-question:visible')
    await page.locator('.fc-filter [data-severity=high]').click()
    const high = await page.locator('.fc-question[data-severity=high]').count()
    assert.ok(high > 0 && high < all)
    assert.equal(await shown().count(), high)
    await page.locator('.fc-filter [data-kind=question]').click()
    const both = await page.locator('.fc-question[data-severity=high][data-kinds~=question]').count()
    assert.equal(await shown().count(), both)
    assert.ok((await page.locator('.fc-filter output').textContent()).includes(`${both} / ${all}`))
    assert.deepEqual(faults, [])
  })
})

test('codes are complete without scripts, and the audience filter works', driven, async () => {
  await withSite(async ({ open, faults }) => {
    const row = (page, audience) => page.locator(`tr:has(.fc-limit[data-for~=${audience}])`)
    const bare = await open('/reference/codes.html', { javaScriptEnabled: false })
    assert.equal(await row(bare, 'debugging_app').locator('visible=true').count(), 1)
    assert.equal(await bare.locator('.fc-filter:visible').count(), 0)

    for (const url of ['/reference/codes.html', '/en/reference/codes.html']) {
      const page = await open(url)
      await page.locator('.fc-filter').waitFor({ state: 'visible' })
      const rows = page.locator('table.fc-wide tbody tr:visible')
      const all = await rows.count()
      await page.locator('.fc-filter [data-audience=product_app]').click()
      assert.equal(await rows.count(), all - 1)
      assert.ok(await row(page, 'debugging_app').isHidden())
      assert.match(await page.locator('.fc-filter output').textContent(), /1/)
      await page.locator('.fc-filter [data-audience=debugging_app]').click()
      assert.equal(await rows.count(), all)
    }
    assert.deepEqual(faults, [])
  })
})

test('reduced motion is respected, and the keyboard reaches every frame field', driven, async () => {
  await withSite(async ({ open }) => {
    const page = await open('/reference/commands/get_robot_sn.html', { reducedMotion: 'reduce' })
    await alive(page)
    const seconds = await page.locator('.VPNavBar').first().evaluate((element) => getComputedStyle(element).transitionDuration)
    assert.ok(seconds.split(', ').every((time) => time === '0s'), seconds)
    const field = page.locator('.fc-parts li').nth(2)
    await field.focus()
    await page.waitForFunction(() => document.querySelectorAll('.fc-frame .fc-byte.on').length === 2)
    assert.notEqual(await field.evaluate((element) => getComputedStyle(element).outlineStyle), 'none')
  })
})
