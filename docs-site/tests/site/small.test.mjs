// A small site with the settings of the real one, below a base: some real pages, and pages of a spec with hostile texts.

import assert from 'node:assert/strict'
import { execFileSync } from 'node:child_process'
import { cpSync, existsSync, mkdirSync, mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from 'node:fs'
import path from 'node:path'
import { after, before, describe, test } from 'node:test'
import { obligatory, root, site } from '../support.mjs'
import { alive, driven, withSite } from './browser.mjs'

const BASE = '/docs/fc/'
/** Pages of the site that have links of each kind. */
const PAGES = ['index', 'lab/index', 'reference/codes', 'reference/index', 'reference/commands/get_robot_sn']

/** Texts that would leave their place in Markdown, HTML, Vue and VitePress. */
const SECRET = 'the content of another file'
const HOSTILE = [
  '<!--@include: ../../../secret.txt-->',
  '`<!-- @include: ../../../secret.txt -->`',
  '</script><script>alert(1)</script>',
  '<img src=x onerror=alert(1)>',
  '{{ 7 * 6 }} {\\{ 7 * 6 }} &#123;&#123; 7 * 6 }} `{{ 7 * 6 }}`',
  '![a](../../../secret.txt)',
  'a | b ] [ {0}',
  'ends in \\',
].join(' ')
/** Invisible characters. The loader may refuse them. */
const INVISIBLE = '\u202e\u0000\u001b[31m\u2028'

const fcproto = (args, options) => {
  const command = ['run', '--quiet', ...(obligatory ? ['--locked'] : []), '--bin', 'fcproto', '--', ...args]
  return execFileSync('cargo', command, { cwd: root, encoding: 'utf8', maxBuffer: 1 << 28, stdio: ['pipe', 'pipe', 'pipe'], ...options })
}

/** A dump with a text appended to each of its texts. */
const spoiled = (value, text) =>
  JSON.parse(JSON.stringify(value, (key, value) => ((key === 'zh' || key === 'en') && typeof value === 'string' ? `${value} ${text}` : value)))

describe('a small site', driven, () => {
  // Inside the site's directory, so that its modules are found.
  const cache = path.join(site, '.vitepress/cache')
  let folder
  let dist
  let generated
  const files = () => readdirSync(dist, { recursive: true, encoding: 'utf8' }).map((file) => file.split(path.sep).join('/'))
  const read = (file) => readFileSync(path.join(dist, file), 'utf8')

  before(() => {
    mkdirSync(cache, { recursive: true })
    folder = mkdtempSync(path.join(cache, 'small-'))
    for (const page of PAGES.flatMap((page) => [page, `en/${page}`])) cpSync(path.join(site, `${page}.md`), path.join(folder, `${page}.md`))
    cpSync(path.join(site, 'public'), path.join(folder, 'public'), { recursive: true })
    writeFileSync(path.join(folder, 'secret.txt'), SECRET)
    writeFileSync(path.join(folder, 'api-links.md'), '# API\n\n[TypeScript](/api/typescript/index.html)\n')

    const dump = JSON.parse(fcproto(['inspect', '--format', 'json', '--root', path.join(root, 'fc-codegen/tests/docs')]))
    generated = path.join(folder, 'generated')
    const generate = (text) => fcproto(['generate', '--from', '-', '--only', 'markdown', '--out', generated], { input: JSON.stringify(spoiled(dump, text)) })
    try {
      generate(`${INVISIBLE} ${HOSTILE}`)
    } catch {
      generate(HOSTILE)
    }
    const [pages] = readdirSync(generated, { recursive: true, encoding: 'utf8' }).filter((file) => file.endsWith('reference/index.md') && !file.includes('en/'))
    const reference = path.dirname(path.join(generated, pages))
    for (const [from, to] of [[reference, 'hostile/reference'], [path.join(reference, '../en/reference'), 'en/hostile/reference']]) {
      cpSync(from, path.join(folder, to), { recursive: true })
    }
    rmSync(generated, { recursive: true })

    mkdirSync(path.join(folder, '.vitepress/theme'), { recursive: true })
    const own = JSON.stringify(path.join(site, '.vitepress'))
    const navigation = path.join(folder, 'hostile/reference/navigation.json')
    writeFileSync(
      path.join(folder, '.vitepress/config.ts'),
      `import site from ${own.slice(0, -1)}/config"
import { html } from ${own.slice(0, -1)}/markdown/html"
import navigation from ${JSON.stringify(navigation)}
site.locales.en.themeConfig.sidebar = navigation.groups.map(({ en, items }) => ({ text: html(en), items: items.map((item) => ({ text: html(item.en), link: '/hostile/reference/' + item.link })) }))
export default { ...site, ignoreDeadLinks: true }
`,
    )
    writeFileSync(path.join(folder, '.vitepress/theme/index.ts'), `export { default } from ${own.slice(0, -1)}/theme/index"\n`)
    dist = path.join(folder, 'dist')
    const vitepress = path.join(site, 'node_modules/vitepress/bin/vitepress.js')
    execFileSync(process.execPath, [vitepress, 'build', folder, '--base', BASE, '--outDir', dist], { cwd: site, stdio: ['ignore', 'pipe', 'pipe'] })
  })
  after(() => folder && rmSync(folder, { recursive: true, force: true }))

  test('no link leaves the base', () => {
    const all = new Set(files().map((file) => `${BASE}${file}`))
    const wrong = []
    for (const file of files().filter((file) => file.endsWith('.html') && !file.includes('hostile'))) {
      for (const [, raw] of read(file).matchAll(/ (?:href|src)="([^"]*)"/g)) {
        const { host, pathname } = new URL(raw.replaceAll('&amp;', '&'), `http://site${BASE}${file}`)
        if (host !== 'site') continue
        if (!pathname.startsWith(BASE)) wrong.push(`${file}: ${raw}`)
        // Other pages and the references of the packages are not part of this site.
        else if (!/\.html$|\/$|\/api\//.test(pathname) && !all.has(pathname)) wrong.push(`${file}: there is no ${raw}`)
      }
    }
    assert.deepEqual([...new Set(wrong)], [])
    assert.match(read('index.html'), /<link rel="icon"[^>]* href="\/docs\/fc\/mark\.svg"/)
    assert.match(read('api-links.html'), /href="\/docs\/fc\/api\/typescript\//)
  })

  test('all parts work below a base', async () => {
    await withSite(
      async ({ open, faults }) => {
        const page = await open(`${BASE}en/reference/commands/get_robot_sn.html`)
        await alive(page)
        await page.locator('[data-do=open-in-lab]').first().click()
        await page.locator('[data-out=overall][data-level=good]').waitFor()
        const home = await open(`${BASE}en/index.html`)
        const links = await home.locator('.fc-map a').evaluateAll((all) => all.map((one) => new URL(one.href).pathname))
        assert.ok(links.length > 0 && links.every((link) => link.startsWith(`${BASE}en/reference/`)))
        assert.deepEqual(faults, [])
        const missing = await open(`${BASE}en/nothing.html`)
        await missing.getByText('Page not found').first().waitFor()
      },
      { dist, base: BASE },
    )
  })

  test('hostile texts are shown, and not obeyed', async () => {
    const hostile = files().filter((file) => /hostile\/.*\.html$/.test(file))
    assert.ok(hostile.length > 20)
    const all = files().filter((file) => /\.(?:html|js|json|css)$/.test(file))
    for (const file of all) {
      const text = read(file)
      assert.ok(!text.includes(SECRET), `${file} has the content of another file`)
      assert.ok(!/[\u0000\u001b\u202e]/.test(text), `${file} has a character that does not show`)
    }
    for (const file of hostile) {
      const text = read(file)
      assert.ok(!/<img[^>]*onerror|<script>alert/.test(text), `${file} has an element of a text`)
    }
    await withSite(
      async ({ base, open, faults }) => {
        const page = await open()
        const asked = []
        page.on('dialog', (dialog) => asked.push(dialog.message()) && dialog.dismiss())
        for (const file of hostile) {
          await page.goto(`${base}${BASE}${file}`, { waitUntil: 'load' })
          await alive(page)
        }
        await page.goto(`${base}${BASE}en/hostile/reference/commands/set_level.html`)
        await alive(page)
        const title = await page.locator('h1').textContent()
        for (const part of ['<!--@include: ../../../secret.txt-->', '</script><script>alert(1)</script>', '<img src=x onerror=alert(1)>', '{{ 7 * 6 }} {{ 7 * 6 }}', 'ends in \\']) {
          assert.ok(title.includes(part), `${part} is not in ${title}`)
        }
        const body = await page.locator('.vp-doc').textContent()
        assert.doesNotMatch(body, /\b42\b/)
        assert.ok((await page.title()).includes('alert(1)'))
        assert.ok((await page.locator('.VPSidebar').textContent()).includes('<img src=x onerror=alert(1)>'))
        assert.deepEqual([asked, faults], [[], []])
      },
      { dist, base: BASE },
    )
  })
})
