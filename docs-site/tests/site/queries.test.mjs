// The index of the built site finds the queries of `queries.json`.

import assert from 'node:assert/strict'
import { existsSync, readdirSync, readFileSync } from 'node:fs'
import path from 'node:path'
import { test } from 'node:test'
import { dist, load, needs } from '../support.mjs'

const queries = JSON.parse(readFileSync(new URL('queries.json', import.meta.url), 'utf8'))
const chunks = path.join(dist, 'assets/chunks')
const built = needs(existsSync(chunks), 'needs the built site (npm run build)')

/** A search like that of the site: VitePress' index with the site's options. */
async function searcher(locale) {
  const { MiniSearch, miniSearch } = await load(`
    export { default as MiniSearch } from 'minisearch'
    export { miniSearch } from './.vitepress/search-terms'
  `)
  const file = readdirSync(chunks).find((name) => name.startsWith(`@localSearchIndex${locale}.`))
  const text = readFileSync(path.join(chunks, file), 'utf8')
  const { default: json } = await import(`data:text/javascript;base64,${Buffer.from(text).toString('base64')}`)
  const index = MiniSearch.loadJSON(json, {
    fields: ['title', 'titles', 'text'],
    searchOptions: miniSearch.searchOptions,
    ...miniSearch.options,
  })
  return (query) => index.search(query)
}

for (const [language, locale, base] of [['zh', 'root', ''], ['en', 'en', '/en']]) {
  test(`words of ${language} lead to their page`, built, async (t) => {
    const search = await searcher(locale)
    const wrong = []
    for (const [query, ...pages] of queries[language]) {
      const there = pages.filter((page) => existsSync(path.join(dist, base, page.split('#')[0].replace(/\/$/, '/index.html'))))
      if (there.length === 0) {
        t.diagnostic(`skipped ${query}: the spec has no ${pages.join(' or ')}`)
        continue
      }
      const found = search(query).slice(0, 3)
      const urls = found.flatMap(({ id }, place) => [id.split('#')[0], ...(place === 0 ? [id] : [])])
      if (!urls.some((url) => there.some((page) => url === base + page))) {
        wrong.push(`${query}: ${found.map(({ id }) => id).join(' ') || 'nothing'}, not ${there.join(' or ')}`)
      }
    }
    assert.deepEqual(wrong, [])
  })

  test(`a hit of ${language} shows the text around it`, built, async () => {
    const search = await searcher(locale)
    const [hit] = search(language === 'zh' ? '校验和' : 'checksum')
    assert.ok(hit.titles.length > 0, 'its heading is the path')
    assert.match(hit.title, language === 'zh' ? /校验和/ : /checksum/)
    assert.ok(hit.title.length < 200, hit.title)
    for (const { title } of search('MD5')) assert.doesNotMatch(title, /[<>]/)
  })
}

test('a free code is found', built, async () => {
  for (const [locale, free, closed] of [['root', /可用/, /不再分配/], ['en', /^Free/, /must not take it/]]) {
    const search = await searcher(locale)
    assert.match(search('0x0A0E')[0].title, free)
    assert.match(search('0x0303')[0].title, closed)
    assert.match(search('0x1234')[0].title, locale === 'en' ? /do not use it/ : /不要分配/)
    // Hits do not show the names that only serve the search.
    assert.doesNotMatch(search('GetRobotSnRequest')[0].title, /\u2063|GetRobotSnRequest/)
  }
})

test('protocol pages rank above spec language pages', built, async () => {
  for (const [locale, queries] of [['root', ['枚举', '默认值', '单位', '号段', '上报']], ['en', ['enum', 'default', 'unit', 'range', 'example', 'report', 'timeout']]]) {
    const search = await searcher(locale)
    for (const query of queries) {
      const [first] = search(query)
      assert.doesNotMatch(first.id, /\/(?:language|errors|cli)\.html/, `${query}: ${first.id}`)
    }
  }
})

test('words that only ask change nothing', built, async () => {
  for (const [locale, plain, asked] of [
    ['root', '序列号', '请问序列号怎么办'],
    ['root', '校验和', '校验和怎么样'],
    ['en', 'serial number', 'where is the serial number'],
    ['en', 'checksum', 'what is the checksum'],
  ]) {
    const search = await searcher(locale)
    const ids = (query) => search(query).map(({ id }) => id)
    assert.deepEqual(ids(asked), ids(plain), asked)
  }
  // A query of only such words still works.
  assert.notEqual((await searcher('en'))('the').length, 0)
})

test('words in neither language have no results', built, async () => {
  for (const locale of ['root', 'en']) assert.deepEqual((await searcher(locale))('zzqqxx'), [])
})
